// SPDX-License-Identifier: MIT
#include "daemon/scene/cache/mesh_check.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "daemon/base/parallel_chunks.h"
#include "daemon/geometry/exact_triangles.h"
#include "daemon/geometry/rounding.h"

namespace camway::scene {
namespace {

using geometry::Box;
using geometry::Vec3;

constexpr std::size_t kPerChunk = 16384;

std::size_t chunks_of(std::size_t count) { return (count + kPerChunk - 1) / kPerChunk; }

bool are_coordinates(const std::vector<Vec3>& vertices, std::size_t chunk) {
  const std::size_t end = std::min(vertices.size(), (chunk + 1) * kPerChunk);
  for (std::size_t i = chunk * kPerChunk; i < end; ++i) {
    // False for NaN.
    if (!(vertices[i].array().abs() < geometry::kLargestCoordinate_m).all()) return false;
  }
  return true;
}

bool has_vertices(const Mesh& mesh, std::size_t triangle) {
  const std::array<std::uint32_t, 3>& numbers = mesh.triangles[triangle];
  return std::max({numbers[0], numbers[1], numbers[2]}) < mesh.vertices.size();
}

bool have_vertices(const Mesh& mesh, std::size_t chunk) {
  const std::size_t end = std::min(mesh.triangles.size(), (chunk + 1) * kPerChunk);
  for (std::size_t i = chunk * kPerChunk; i < end; ++i) {
    if (!has_vertices(mesh, i)) return false;
  }
  return true;
}

/// Extends `box` by the triangles of a chunk. Returns false if one is wrong.
bool add_triangles(const Mesh& mesh, std::size_t chunk, Box& box) {
  const std::size_t end = std::min(mesh.triangles.size(), (chunk + 1) * kPerChunk);
  for (std::size_t i = chunk * kPerChunk; i < end; ++i) {
    if (!has_vertices(mesh, i)) return false;
    const geometry::Triangle triangle = mesh.triangle(i);
    if (geometry::has_no_area_exactly(triangle)) return false;
    for (const Vec3& vertex : triangle) box.extend(vertex);
  }
  return true;
}

/// Whether `check(chunk)` holds for all chunks.
template <class Check>
bool holds_for_all(unsigned threads, std::size_t chunks, const Check& check) {
  std::vector<std::uint8_t> holds(chunks);
  base::for_each_chunk(threads, chunks,
                       [&](unsigned, std::size_t chunk) { holds[chunk] = check(chunk) ? 1 : 0; });
  return std::ranges::all_of(holds, [](std::uint8_t held) { return held != 0; });
}

/// Why these are no vertices of a mesh, or there are too many triangles; or an empty text.
std::string fault_in_vertices(const Mesh& mesh, unsigned threads) {
  constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
  if (mesh.triangles.size() > kMost || mesh.vertices.size() > kMost) {
    return "there are too many triangles";
  }
  const bool has_coordinates =
      holds_for_all(threads, chunks_of(mesh.vertices.size()),
                    [&](std::size_t chunk) { return are_coordinates(mesh.vertices, chunk); });
  return has_coordinates ? "" : "a coordinate is not finite or too large";
}

}  // namespace

std::string fault_in_numbers(const Mesh& mesh, unsigned threads) {
  if (std::string fault = fault_in_vertices(mesh, threads); !fault.empty()) return fault;
  const bool has_all = holds_for_all(threads, chunks_of(mesh.triangles.size()),
                                     [&](std::size_t chunk) { return have_vertices(mesh, chunk); });
  return has_all ? "" : "a vertex of a triangle does not exist";
}

base::Result<Box> checked_bounds(const Mesh& mesh, unsigned threads) {
  if (mesh.triangles.empty()) return base::Failure{"there is no triangle"};
  if (std::string fault = fault_in_vertices(mesh, threads); !fault.empty()) {
    return base::Failure{std::move(fault)};
  }
  std::vector<Box> boxes(chunks_of(mesh.triangles.size()));
  const bool has_triangles = holds_for_all(threads, boxes.size(), [&](std::size_t chunk) {
    return add_triangles(mesh, chunk, boxes[chunk]);
  });
  if (!has_triangles) return base::Failure{"a triangle has no area"};
  Box all;
  for (const Box& box : boxes) all.extend(box);
  return all;
}

}  // namespace camway::scene
