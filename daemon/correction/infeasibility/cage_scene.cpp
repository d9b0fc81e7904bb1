// SPDX-License-Identifier: MIT
#include "daemon/correction/infeasibility/cage_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "daemon/geometry/ray_crossing.h"
#include "daemon/geometry/rounding.h"

namespace camway::correction {
namespace {

using geometry::Box;
using geometry::Quat;
using geometry::Triangle;
using geometry::Vec3;

/// A bar is at least this many times as long as it is thick.
constexpr double kLeastSlenderness = 3.0;
/// Least number of bars that can make a face.
constexpr std::size_t kLeastBars = 4;
constexpr std::size_t kMaxTurnedFrames = 2;
constexpr std::size_t kMostTrianglesOfBar = 1000;
/// Directions of bars that differ by less count as equal. [Units: radians]
constexpr double kSameDirection_rad = 1e-4;
/// Candidates for a face: the nearest plane with at least this share of the bars of the fullest
/// plane. Several shares are tried, as a larger cage may be behind the cage, and shelves within it.
constexpr std::array<double, 3> kShares = {0.7, 0.4, 0.2};
/// Bars whose centres differ by less than this share of their thickness lie in one plane.
constexpr double kPlaneShare = 0.1;
/// Two products and a sum for each coordinate, of numbers no larger than the vertex: 3u of twice
/// that; the rest is for the rounding of sums with the margin itself.
constexpr double kTurnRounding = 32.0;

std::optional<double> first_or(const std::optional<double>& a, const std::optional<double>& b) {
  return a ? a : b;
}

struct Turn {
  int axis = 2;
  double angle_rad = 0.0;  ///< 0 <= value < pi / 2: more is the same frame with other names
  std::size_t bars = 0;
};

/// The turns, each once, after which some of the surface's triangles are parallel to two axes.
std::vector<Turn> turns_of(const scene::Mesh& mesh, const std::vector<std::uint32_t>& triangles) {
  std::vector<Turn> result;
  for (const std::uint32_t t : triangles) {
    const Triangle triangle = mesh.triangle(t);
    const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).normalized();
    for (int axis = 0; axis < 3; ++axis) {
      if (!(std::abs(normal[axis]) < kSameDirection_rad)) continue;
      constexpr double kQuarter = 0.5 * std::numbers::pi;
      const double angle = std::atan2(normal[(axis + 2) % 3], normal[(axis + 1) % 3]);
      const double angle_rad = angle - kQuarter * std::floor(angle / kQuarter);
      const auto is_same = [&](const Turn& other) {
        return other.axis == axis && std::abs(other.angle_rad - angle_rad) < kSameDirection_rad;
      };
      const bool is_none =
          angle_rad < kSameDirection_rad || kQuarter - angle_rad < kSameDirection_rad;
      if (is_none || std::any_of(result.begin(), result.end(), is_same)) continue;
      result.push_back({.axis = axis, .angle_rad = angle_rad, .bars = 1});
    }
  }
  return result;
}

/// The turns that the most bars have in common.
std::vector<Turn> common_turns(const CageScene& scene) {
  std::vector<Turn> all;
  for (const Barrier& barrier : scene.barriers()) {
    if (barrier.triangles.size() > kMostTrianglesOfBar) continue;
    const std::vector<Turn> turns = turns_of(scene.mesh(), barrier.triangles);
    all.insert(all.end(), turns.begin(), turns.end());
  }
  std::sort(all.begin(), all.end(), [](const Turn& a, const Turn& b) {
    return a.axis != b.axis ? a.axis < b.axis : a.angle_rad < b.angle_rad;
  });
  std::vector<Turn> common;
  for (const Turn& turn : all) {
    if (common.empty() || common.back().axis != turn.axis ||
        turn.angle_rad - common.back().angle_rad > kSameDirection_rad) {
      common.push_back(turn);
    } else {
      ++common.back().bars;
    }
  }
  std::stable_sort(common.begin(), common.end(),
                   [](const Turn& a, const Turn& b) { return a.bars > b.bars; });
  common.resize(std::min(common.size(), kMaxTurnedFrames));
  return common;
}

}  // namespace

CageScene::CageScene(const scene::Mesh& mesh, const scene::ClosedSurfaces& surfaces,
                     double shortest_chord_m)
    : original_(&mesh) {
  add_barriers(surfaces, shortest_chord_m);
  for (int axis = 0; axis < 3; ++axis) add_flats(axis);
}

CageScene::CageScene(const scene::Mesh& mesh, const scene::ClosedSurfaces& surfaces,
                     double shortest_chord_m, int axis, double angle_rad)
    : original_(&mesh),
      axis_(axis),
      angle_rad_(angle_rad),
      cosine_(std::cos(angle_rad)),
      sine_(std::sin(angle_rad)),
      turned_(mesh) {
  double largest_m = 0.0;
  for (Vec3& vertex : turned_.vertices) {
    largest_m = std::max(largest_m, vertex.lpNorm<Eigen::Infinity>());
    vertex = in_frame(vertex);
  }
  margin_m_.setConstant(kTurnRounding * geometry::kUnitRoundoff * largest_m);
  margin_m_[axis] = 0.0;
  add_barriers(surfaces, shortest_chord_m);
  add_flats(axis);
}

void CageScene::add_barriers(const scene::ClosedSurfaces& surfaces, double shortest_chord_m) {
  barrier_of_.assign(mesh().triangles.size(), scene::kNoIndex);
  for (const scene::IndexSet& surface : surfaces.surfaces) {
    Barrier barrier;
    barrier.is_stepped = !is_turned();
    for (const std::uint32_t patch : surface) {
      for (const std::uint32_t t : surfaces.complex.patches[patch]) {
        const Box bounds = geometry::bounds(mesh().triangle(t));
        barrier.triangles.push_back(t);
        barrier_of_[t] = static_cast<std::uint32_t>(barriers_.size());
        barrier.box.extend(bounds);
        barrier.is_stepped = barrier.is_stepped && bounds.sizes().minCoeff() == 0.0;
      }
    }
    Vec3 size = barrier.box.sizes();
    std::sort(size.begin(), size.end());
    barrier.is_bar =
        size[0] > 0.0 && size[1] < shortest_chord_m && size[2] >= kLeastSlenderness * size[0];
    std::sort(barrier.triangles.begin(), barrier.triangles.end());
    barriers_.push_back(std::move(barrier));
  }
}

void CageScene::add_flats(int axis) {
  std::vector<FlatTriangle>& flats = flats_[static_cast<std::size_t>(axis)];
  for (std::uint32_t t = 0; t < mesh().triangles.size(); ++t) {
    const Triangle triangle = mesh().triangle(t);
    const double at = triangle[0][axis];
    if (triangle[1][axis] == at && triangle[2][axis] == at) flats.push_back({at, t});
  }
  std::stable_sort(flats.begin(), flats.end(),
                   [](const FlatTriangle& a, const FlatTriangle& b) { return a.at < b.at; });
}

Quat CageScene::orientation() const {
  return Quat(Eigen::AngleAxisd(angle_rad_, Vec3::Unit(axis_)));
}

Vec3 CageScene::in_frame(const Vec3& point_W) const {
  if (!is_turned()) return point_W;
  const double a = point_W[(axis_ + 1) % 3];
  const double b = point_W[(axis_ + 2) % 3];
  Vec3 result = point_W;
  result[(axis_ + 1) % 3] = cosine_ * a + sine_ * b;
  result[(axis_ + 2) % 3] = cosine_ * b - sine_ * a;
  return result;
}

std::vector<CageScene> cage_scenes(const scene::Mesh& mesh, const scene::ClosedSurfaces& surfaces,
                                   double shortest_chord_m) {
  std::vector<CageScene> result;
  result.emplace_back(mesh, surfaces, shortest_chord_m);
  for (const Turn& turn : common_turns(result.front())) {
    if (turn.bars < kLeastBars) continue;
    result.emplace_back(mesh, surfaces, shortest_chord_m, turn.axis, turn.angle_rad);
  }
  return result;
}

CageBoxes::CageBoxes(const CageScene& scene) : scene_(scene) {
  for (int axis = 0; axis < 3; ++axis) planes_[static_cast<std::size_t>(axis)] = planes(axis);
}

// Planes by increasing coordinate.
std::vector<CageBoxes::Plane> CageBoxes::planes(int axis) const {
  std::vector<std::array<double, 2>> middles;
  for (const Barrier& bar : scene_.barriers()) {
    if (!bar.is_bar) continue;
    // The axis is along the bar: the bar is in no plane of a face.
    if (bar.box.sizes()[axis] > 2.0 * bar.thickness_m()) continue;
    middles.push_back({bar.box.center()[axis], bar.thickness_m()});
  }
  std::sort(middles.begin(), middles.end());
  std::vector<Plane> result;
  for (const auto& [middle, thickness_m] : middles) {
    if (result.empty() || middle - result.back().at > kPlaneShare * thickness_m) {
      result.push_back({.at = middle, .bars = 0});
    }
    ++result.back().bars;
  }
  return result;
}

CageBoxes::Sides CageBoxes::nearest_planes(const Vec3& center, double share) const {
  Sides sides;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t k = static_cast<std::size_t>(axis);
    std::array<std::size_t, 2> most = {0, 0};
    for (const Plane& plane : planes_[k]) {
      std::size_t& side = most[plane.at < center[axis] ? 0 : 1];
      side = std::max(side, plane.bars);
    }
    const auto enough = [&](const Plane& plane, std::size_t side) {
      return static_cast<double>(plane.bars) >= share * static_cast<double>(most[side]);
    };
    for (const Plane& plane : planes_[k]) {  // the last one below stays
      if (plane.at < center[axis] && enough(plane, 0)) sides[k][0] = plane.at;
      if (plane.at > center[axis] && enough(plane, 1) && !sides[k][1]) sides[k][1] = plane.at;
    }
  }
  return sides;
}

// The nearest flat triangles straight along the axes from the centre; not those of bars.
CageBoxes::Sides CageBoxes::nearest_flats(const Vec3& center) const {
  Sides sides;
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<FlatTriangle>& flats = scene_.flats(axis);
    const auto turned = [&](const Vec3& v, double at) {
      return Vec3(at, v[(axis + 1) % 3], v[(axis + 2) % 3]);
    };
    const auto is_hit = [&](const FlatTriangle& flat) {
      const Triangle t = scene_.mesh().triangle(flat.triangle);
      const std::uint32_t barrier = scene_.barrier_of(flat.triangle);
      return (barrier == scene::kNoIndex || !scene_.barriers()[barrier].is_bar) &&
             geometry::passes_through(geometry::ray_hit(
                 turned(center, 0.0), {turned(t[0], 1.0), turned(t[1], 1.0), turned(t[2], 1.0)}));
    };
    const auto above =
        std::upper_bound(flats.begin(), flats.end(), center[axis],
                         [](double at, const FlatTriangle& flat) { return at < flat.at; });
    auto& [lower, upper] = sides[static_cast<std::size_t>(axis)];
    const auto up = std::find_if(above, flats.end(), is_hit);
    if (up != flats.end()) upper = up->at;
    const auto down = std::find_if(std::make_reverse_iterator(above), flats.rend(), is_hit);
    if (down != flats.rend()) lower = down->at;
  }
  return sides;
}

std::vector<Box> CageBoxes::around(const Vec3& center) const {
  std::vector<Box> result;
  const Sides flats = nearest_flats(center);
  const auto add = [&](const auto& choose) {
    Box box(center);
    for (int axis = 0; axis < 3; ++axis) {
      for (const int side : {0, 1}) {
        const std::optional<double> at = choose(axis, side);
        if (!at) return;
        (side == 0 ? box.min() : box.max())[axis] = *at;
      }
    }
    const auto is_same = [&](const Box& other) {
      return other.min() == box.min() && other.max() == box.max();
    };
    if (std::none_of(result.begin(), result.end(), is_same)) result.push_back(box);
  };
  for (const double share : kShares) {
    const Sides planes = nearest_planes(center, share);
    const auto of = [](const Sides& sides, int axis, int side) {
      return sides[static_cast<std::size_t>(axis)][static_cast<std::size_t>(side)];
    };
    add([&](int axis, int side) {
      return first_or(of(planes, axis, side), of(flats, axis, side));
    });
    add([&](int axis, int side) {
      const std::optional<double> plane = of(planes, axis, side);
      const std::optional<double> flat = of(flats, axis, side);
      if (!plane || !flat) return first_or(plane, flat);
      return std::optional(side == 0 ? std::max(*plane, *flat) : std::min(*plane, *flat));
    });
    add([&](int axis, int side) {
      return first_or(of(flats, axis, side), of(planes, axis, side));
    });
  }
  return result;
}

}  // namespace camway::correction
