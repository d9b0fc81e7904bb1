// SPDX-License-Identifier: MIT
#include <sstream>

#include "daemon/scene/import/import.h"
#include "daemon/scene/import/record/import_record.h"
#include "daemon/scene/import/record/record_layout.h"
#include "daemon/scene/mirror/scene_mirror.h"
#include "daemon/scene/snapshot/shape_mesh.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tests/fuzz/targets.h"
#include "tests/support/temporary_folder.h"

namespace camway::testing {
namespace {

namespace format = scene::import_record;

bool exercise_import_record(std::span<const std::uint8_t> bytes) {
  scene::ImportReport report;
  const scene::ImportRecordResult read =
      scene::read_import_record(std::as_bytes(bytes), {}, report);
  promise(!read.broken || (!read.mesh && !read.map && read.refusal.empty()),
          "of a broken record nothing counts");
  if (!read.mesh) return !read.broken;
  for (const auto& triangle : read.mesh->triangles) {
    for (const std::uint32_t corner : triangle) {
      promise(corner < read.mesh->vertices.size(), "corners are vertices");
    }
  }
  for (const auto& vertex : read.mesh->vertices) {
    promise(vertex.array().isFinite().all(), "coordinates are numbers");
  }
  promise(read.relative_rounding >= 0.0 && read.absolute_rounding >= 0.0, "errors are bounds");
  return true;
}

FuzzBytes bytes_of(format::Record record) {
  format::set_counts(record);
  FuzzBytes bytes;
  const auto append = [&](const void* data, std::size_t size) {
    const auto* const begin = static_cast<const std::uint8_t*>(data);
    bytes.insert(bytes.end(), begin, begin + size);
  };
  const auto append_all = [&](const auto& list) {
    append(list.data(), list.size() * sizeof list[0]);
  };
  append(&record.header, sizeof record.header);
  append_all(record.text);
  append_all(record.notes);
  append_all(record.vertices);
  append_all(record.triangles);
  append_all(record.objects);
  append_all(record.names);
  append_all(record.occupied);
  append_all(record.free);
  return bytes;
}

std::vector<FuzzBytes> import_record_seeds() {
  format::Record mesh;
  mesh.text = "test";
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}};
  mesh.objects = {{1, 3}, {1, 3}};
  mesh.names = "onetwo";
  format::Record map;
  map.text = "OctoMap";
  map.header.map_resolution = 0.1;
  map.occupied = {{{0, 0, 0}, 1}, {{4, 0, 0}, 4}};
  map.free = {{{1, 0, 0}, 1}};
  format::Record refusal;
  refusal.text = "no reader wants it";
  return {bytes_of(mesh), bytes_of(map), bytes_of(refusal), {}};
}

/// The first byte selects a binary map. Uses the import process, because OctoMap's own reader may
/// end it.
bool exercise_map_file(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return false;
  static const TemporaryFolder folder;
  const std::string file =
      folder.write(bytes[0] % 2 == 0 ? "map.bt" : "map.ot", std::string(as_text(bytes.subspan(1))));
  scene::ImportOptions options;
  options.time_limit_s = 5.0;
  const scene::ImportResult read = scene::import_mesh(file, options);
  promise(read.mesh.has_value() == read.error.empty(), "a map or a reason");
  promise(!read.mesh || read.map, "what is read is a map");
  return read.mesh.has_value();
}

std::vector<FuzzBytes> map_file_seeds() {
  scene::SnapshotOptions options;
  options.occupancy_resolution_m = 0.25;
  std::ostringstream binary;
  scene::make_snapshot("box", *scene::box_mesh({1, 1, 1}), options)
      .snapshot->occupancy->write_bt(binary);
  const std::string header = "# Octomap OcTree file\nid OcTree\nsize 1\nres 0.1\ndata\n";
  return {fuzz_bytes('\0' + binary.str()), fuzz_bytes('\1' + header + std::string(5, '\x7f')),
          fuzz_bytes('\0' + header),
          fuzz_bytes(std::string("\1# Octomap OcTree file\nid nothing"))};
}

}  // namespace

constinit const FuzzTarget kImportRecordTarget{"import_record", exercise_import_record,
                                               import_record_seeds, 20'000};
constinit const FuzzTarget kMapFileTarget{"map_file", exercise_map_file, map_file_seeds, 60};

}  // namespace camway::testing
