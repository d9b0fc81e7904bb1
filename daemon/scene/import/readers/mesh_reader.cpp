// SPDX-License-Identifier: MIT
#include "daemon/scene/import/readers/mesh_reader.h"

#include <array>
#include <cstdint>
#include <limits>
#include <utility>

#include "daemon/geometry/rounding.h"
#include "daemon/scene/import/readers/mesh_collector.h"
#include "daemon/scene/import/readers/obj_reader.h"
#include "daemon/scene/import/readers/off_reader.h"
#include "daemon/scene/import/readers/ply_reader.h"
#include "daemon/scene/import/readers/stl_reader.h"
#include "daemon/scene/import/readers/tokens.h"
#include "daemon/scene/import/record/own_formats.h"

namespace camway::scene::mesh_readers {
namespace {

/// A decimal becomes the nearest double.
constexpr double kOneRounding = geometry::kUnitRoundoff;

using Reader = base::Result<import_record::Record> (*)(std::string_view);

base::Result<import_record::Record> finished(MeshCollector& mesh, std::string_view format,
                                             double relative_rounding, std::string refusal) {
  if (!refusal.empty()) return base::Failure{std::move(refusal)};
  return mesh.finish(format, relative_rounding);
}

base::Result<import_record::Record> read_obj_file(std::string_view bytes) {
  MeshCollector mesh;
  read_obj(bytes, mesh);
  return finished(mesh, "Wavefront OBJ", kOneRounding, "");
}

base::Result<import_record::Record> read_off_file(std::string_view bytes) {
  MeshCollector mesh;
  std::string refusal = read_off(bytes, mesh);
  return finished(mesh, "OFF", kOneRounding, std::move(refusal));
}

base::Result<import_record::Record> read_ply_file(std::string_view bytes) {
  MeshCollector mesh;
  PlyKind kind;
  std::string refusal = read_ply(bytes, mesh, kind);
  return finished(mesh, kind.format, kind.relative_rounding, std::move(refusal));
}

base::Result<import_record::Record> read_stl_file(std::string_view bytes) {
  MeshCollector mesh;
  std::string refusal = read_stl(bytes, mesh);
  const bool binary = is_binary_stl(bytes);
  return finished(mesh, binary ? "STL, binary" : "STL, text", binary ? 0.0 : kOneRounding,
                  std::move(refusal));
}

Reader reader_for(std::string_view extension) {
  constexpr std::array<Reader, kOwnFormats.size()> kReaders = {read_obj_file, read_off_file,
                                                               read_ply_file, read_stl_file};
  for (std::size_t i = 0; i < kOwnFormats.size(); ++i) {
    if (equals_ignoring_case(extension, kOwnFormats[i])) return kReaders[i];
  }
  return nullptr;
}

}  // namespace

bool is_known_extension(std::string_view extension) { return reader_for(extension) != nullptr; }

base::Result<import_record::Record> read_mesh(std::string_view extension, std::string_view bytes) {
  // Every vertex and every triangle takes a byte at least, so their numbers fit 32 bits.
  if (bytes.size() >= std::numeric_limits<std::uint32_t>::max()) {
    return base::Failure{"is larger than 4 GiB"};
  }
  return reader_for(extension)(bytes);
}

}  // namespace camway::scene::mesh_readers
