// SPDX-License-Identifier: MIT
#include "tests/bench/tiled_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "tests/support/random.h"

namespace camway::bench {

namespace {

using geometry::Vec3;
using scene::Mesh;

void append(Mesh& to, const Mesh& from, const Vec3& offset) {
  const std::uint32_t first = static_cast<std::uint32_t>(to.vertices.size());
  for (const Vec3& vertex : from.vertices) to.vertices.emplace_back(vertex + offset);
  for (const auto& t : from.triangles) {
    to.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
}

void add_triangle(Mesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c) {
  const std::uint32_t first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
  mesh.triangles.push_back({first, first + 1, first + 2});
}

// Returns cells in square rings about the centre: cell 0 is the centre, then 8 around it, then 16,
// ...
std::vector<std::array<int, 2>> spiral(std::size_t count) {
  std::vector<std::array<int, 2>> cells;
  for (int ring = 0; cells.size() < count; ++ring) {
    for (int i = -ring; i <= ring; ++i) {
      for (int j = -ring; j <= ring; ++j) {
        if (std::max(std::abs(i), std::abs(j)) == ring) cells.push_back({i, j});
      }
    }
  }
  cells.resize(count);
  return cells;
}

std::shared_ptr<const Mesh> finished(Mesh mesh) {
  mesh.objects = {{"all", 0, static_cast<std::uint32_t>(mesh.triangles.size())}};
  return std::make_shared<const Mesh>(std::move(mesh));
}

}  // namespace

std::shared_ptr<const Mesh> tiled(const Mesh& mesh, std::size_t least) {
  // A gap of a wall's width between tiles, so that the outer walls of adjacent tiles do not
  // coincide.
  constexpr double kGap_m = 0.1;
  const Vec3 size_m = mesh.bounds().sizes() + Vec3::Constant(kGap_m);
  std::array<Eigen::Index, 3> axes{0, 1, 2};
  std::sort(axes.begin(), axes.end(), [&](auto a, auto b) { return size_m[a] > size_m[b]; });
  Mesh all;
  const std::size_t copies = (least + mesh.triangles.size() - 1) / mesh.triangles.size();
  all.vertices.reserve(copies * mesh.vertices.size());
  all.triangles.reserve(copies * mesh.triangles.size());
  for (const auto& [i, j] : spiral(std::max<std::size_t>(1, copies))) {
    Vec3 offset = Vec3::Zero();
    offset[axes[0]] = i * size_m[axes[0]];
    offset[axes[1]] = j * size_m[axes[1]];
    append(all, mesh, offset);
  }
  return finished(std::move(all));
}

std::shared_ptr<const Mesh> refined(const Mesh& mesh, std::size_t least) {
  Mesh fine = mesh;
  while (fine.triangles.size() < least) {
    Mesh finer;
    finer.vertices.reserve(12 * fine.triangles.size());
    finer.triangles.reserve(4 * fine.triangles.size());
    for (std::size_t i = 0; i < fine.triangles.size(); ++i) {
      const geometry::Triangle t = fine.triangle(i);
      const Vec3 ab = 0.5 * (t[0] + t[1]);
      const Vec3 bc = 0.5 * (t[1] + t[2]);
      const Vec3 ca = 0.5 * (t[2] + t[0]);
      add_triangle(finer, t[0], ab, ca);
      add_triangle(finer, ab, t[1], bc);
      add_triangle(finer, ca, bc, t[2]);
      add_triangle(finer, ab, bc, ca);
    }
    fine = std::move(finer);
  }
  return finished(std::move(fine));
}

std::shared_ptr<const Mesh> cropped(const Mesh& mesh, const Vec3& center, std::size_t most) {
  std::vector<std::size_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<double> distance(order.size());
  for (const std::size_t i : order) {
    const geometry::Triangle t = mesh.triangle(i);
    distance[i] = ((t[0] + t[1] + t[2]) / 3.0 - center).norm();
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return distance[a] < distance[b]; });
  Mesh part;
  for (std::size_t i = 0; i < std::min(most, order.size()); ++i) {
    const geometry::Triangle t = mesh.triangle(order[i]);
    add_triangle(part, t[0], t[1], t[2]);
  }
  return finished(std::move(part));
}

std::shared_ptr<const Mesh> dust(std::size_t count, std::uint64_t seed) {
  testing::Random random(seed);
  std::uniform_real_distribution<double> place(-10.0, 10.0);
  std::uniform_real_distribution<double> size(-0.05, 0.05);
  const auto near = [&](const Vec3& center) {
    const double x = size(random);
    const double y = size(random);
    return Vec3(center + Vec3(x, y, size(random)));
  };
  Mesh mesh;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = place(random);
    const double y = place(random);
    const Vec3 center(x, y, place(random));
    const Vec3 a = near(center);
    const Vec3 b = near(center);
    add_triangle(mesh, a, b, near(center));
  }
  return finished(std::move(mesh));
}

std::shared_ptr<const Mesh> terrain(std::size_t least) {
  constexpr double kSize_m = 100.0;
  const std::uint32_t cells =
      static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(least) / 2.0)));
  Mesh mesh;
  for (std::uint32_t j = 0; j <= cells; ++j) {
    for (std::uint32_t i = 0; i <= cells; ++i) {
      const double x = kSize_m * (static_cast<double>(i) / cells - 0.5);
      const double z = kSize_m * (static_cast<double>(j) / cells - 0.5);
      const double y = 3.0 * std::sin(0.21 * x) * std::cos(0.17 * z) + 0.5 * std::sin(1.3 * x + z);
      mesh.vertices.emplace_back(x, y, z);
    }
  }
  for (std::uint32_t j = 0; j < cells; ++j) {
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t a = j * (cells + 1) + i;
      const std::uint32_t b = a + cells + 1;
      mesh.triangles.push_back({a, b, a + 1});
      mesh.triangles.push_back({a + 1, b, b + 1});
    }
  }
  return finished(std::move(mesh));
}

}  // namespace camway::bench
