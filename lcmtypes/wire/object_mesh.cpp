// SPDX-License-Identifier: MIT
#include "lcmtypes/wire/object_mesh.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <string_view>

namespace camway::wire {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are sent as they are in memory");

constexpr std::string_view kMark = "camwayM1";

template <class Number>
void put(const Number* numbers, std::size_t count, std::vector<std::uint8_t>& bytes) {
  const auto* const first = reinterpret_cast<const std::uint8_t*>(numbers);
  bytes.insert(bytes.end(), first, first + count * sizeof(Number));
}

/// Reads numbers from the front of bytes. After the first that is missing, all fail.
class MeshBytes {
 public:
  explicit MeshBytes(std::span<const std::uint8_t> left) : left_(left) {}

  template <class Number>
  bool take(Number* numbers, std::size_t count) {
    if (count > left_.size() / sizeof(Number)) return false;
    if (count > 0) std::memcpy(numbers, left_.data(), count * sizeof(Number));
    left_ = left_.subspan(count * sizeof(Number));
    return true;
  }
  /// Makes room for elements only if their bytes are there.
  template <class Element>
  bool take(std::vector<Element>& list, std::uint64_t count) {
    if (count > left_.size() / sizeof(Element)) return false;
    list.resize(static_cast<std::size_t>(count));
    return take(list.data(), list.size());
  }
  [[nodiscard]] std::size_t left() const { return left_.size(); }

 private:
  std::span<const std::uint8_t> left_;
};

bool take_part(MeshBytes& bytes, ObjectMesh::Part& part) {
  std::uint32_t length = 0;
  if (!bytes.take(&part.triangles, 1) || !bytes.take(&length, 1) || length > bytes.left())
    return false;
  part.name.resize(length);
  return bytes.take(part.name.data(), length);
}

bool is_sound(const ObjectMesh& mesh) {
  if (!std::isfinite(mesh.surface_error_m) || mesh.surface_error_m < 0.0) return false;
  for (const auto& vertex : mesh.vertices_m) {
    for (const double coordinate : vertex) {
      if (!std::isfinite(coordinate)) return false;
    }
  }
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t index : triangle) {
      if (index >= mesh.vertices_m.size()) return false;
    }
  }
  std::uint64_t covered = 0;
  for (const ObjectMesh::Part& part : mesh.parts) covered += part.triangles;
  return covered == mesh.triangles.size();
}

}  // namespace

std::vector<std::uint8_t> encode_mesh(const ObjectMesh& mesh) {
  std::vector<std::uint8_t> bytes(kMark.begin(), kMark.end());
  const std::array<std::uint64_t, 4> head = {mesh.has_inside ? 1U : 0U, mesh.vertices_m.size(),
                                             mesh.triangles.size(), mesh.parts.size()};
  put(head.data(), head.size(), bytes);
  put(&mesh.surface_error_m, 1, bytes);
  put(mesh.vertices_m.data(), mesh.vertices_m.size(), bytes);
  put(mesh.triangles.data(), mesh.triangles.size(), bytes);
  for (const ObjectMesh::Part& part : mesh.parts) {
    const std::array<std::uint32_t, 2> numbers = {part.triangles,
                                                  static_cast<std::uint32_t>(part.name.size())};
    put(numbers.data(), numbers.size(), bytes);
    put(part.name.data(), part.name.size(), bytes);
  }
  return bytes;
}

std::optional<ObjectMesh> decode_mesh(std::span<const std::uint8_t> encoded) {
  if (encoded.size() < kMark.size() ||
      std::memcmp(encoded.data(), kMark.data(), kMark.size()) != 0) {
    return std::nullopt;
  }
  MeshBytes bytes(encoded.subspan(kMark.size()));
  ObjectMesh mesh;
  std::array<std::uint64_t, 4> head{};
  if (!bytes.take(head.data(), head.size()) || head[0] > 1) return std::nullopt;
  mesh.has_inside = head[0] == 1;
  if (!bytes.take(&mesh.surface_error_m, 1) || !bytes.take(mesh.vertices_m, head[1]) ||
      !bytes.take(mesh.triangles, head[2])) {
    return std::nullopt;
  }
  constexpr std::size_t kLeastBytesOfPart = 8;
  if (head[3] > bytes.left() / kLeastBytesOfPart) return std::nullopt;
  mesh.parts.resize(static_cast<std::size_t>(head[3]));
  for (ObjectMesh::Part& part : mesh.parts) {
    if (!take_part(bytes, part)) return std::nullopt;
  }
  if (bytes.left() != 0 || !is_sound(mesh)) return std::nullopt;
  return mesh;
}

}  // namespace camway::wire
