// SPDX-License-Identifier: MIT
#include "tests/scene/cache/prepared_samples.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstring>
#include <stdexcept>

#include "daemon/base/digest.h"
#include "daemon/base/file_descriptor.h"
#include "daemon/scene/cache/cache_file.h"
#include "tests/support/scenes.h"

namespace camway::testing {
namespace {

namespace layout = scene::cache_layout;

base::FileDescriptor memory_file() {
  base::FileDescriptor file(memfd_create("camway-cache-test", MFD_CLOEXEC));
  if (!file.is_open()) throw std::runtime_error("there is no file in memory");
  return file;
}

base::Digest::Bytes digest_of(std::span<const std::uint8_t> bytes) {
  base::Digest digest;
  digest.add(bytes.data(), bytes.size());
  return digest.bytes();
}

}  // namespace

scene::PreparedScene prepared_of(const scene::Snapshot& snapshot) {
  const scene::SceneObject& object = *snapshot.objects.front();
  const scene::ObjectSource& source = *object.source;
  const scene::PlacedPart& part = *object.parts.front();
  return {part.indexed, source.report, source.field_O, source.why_no_field, part.digest};
}

scene::PreparedScene small_prepared(bool has_field) {
  scene::Mesh mesh;
  constexpr int kCuboids = 6;
  for (int i = 0; i < kCuboids; ++i) {
    const Vec3 corner(3.0 * i, 2.0 * (i % 2), 5.0 * (i % 3));
    add_cuboid(mesh, corner, corner + Vec3(1, 2, 1.5));
  }
  mesh.objects = {{"table", 0, 12}, {"shelf", 12, 12 * (kCuboids - 1)}};
  scene::SnapshotOptions options;
  options.index.threshold = 2;  // so that the tree has several levels
  if (!has_field) options.field.reset();
  return prepared_of(*scene::make_snapshot("room", std::move(mesh), options).snapshot);
}

std::vector<std::uint8_t> file_of(const scene::PreparedScene& prepared) {
  const base::FileDescriptor file = memory_file();
  if (!scene::write_prepared(file.get(), kSampleKey, "room.ply", prepared)) {
    throw std::runtime_error("a file in memory cannot be written");
  }
  std::vector<std::uint8_t> bytes(scene::prepared_bytes("room.ply", prepared));
  const ssize_t size = pread(file.get(), bytes.data(), bytes.size(), 0);
  if (size != static_cast<ssize_t>(bytes.size())) throw std::runtime_error("the file is short");
  return bytes;
}

base::Result<scene::PreparedScene> read_bytes(std::span<const std::uint8_t> bytes) {
  const base::FileDescriptor file = memory_file();
  const ssize_t size = write(file.get(), bytes.data(), bytes.size());
  if (size != static_cast<ssize_t>(bytes.size())) throw std::runtime_error("memory is full");
  return scene::read_prepared(file.get(), kSampleKey, {});
}

void reseal(std::span<std::uint8_t> bytes) {
  layout::Header header;
  if (bytes.size() < sizeof header) return;
  std::memcpy(&header, bytes.data(), sizeof header);
  for (layout::Section& section : header.sections) {
    if (section.offset > bytes.size() || section.bytes > bytes.size() - section.offset) continue;
    section.digest = digest_of(bytes.subspan(section.offset, section.bytes));
  }
  header.digest = {};
  std::memcpy(bytes.data(), &header, sizeof header);
  header.digest = digest_of(bytes.first(sizeof header));
  std::memcpy(bytes.data(), &header, sizeof header);
}

}  // namespace camway::testing
