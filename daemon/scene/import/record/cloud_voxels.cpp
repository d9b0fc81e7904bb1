// SPDX-License-Identifier: MIT
#include "daemon/scene/import/record/cloud_voxels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "daemon/scene/voxels/voxel_grid.h"

namespace camway::scene {
namespace {

using geometry::Box;
using geometry::Vec3;

/// OctoMap's keys, without one at each end: what touches a face may be in the voxel beyond.
constexpr std::int32_t kFirstVoxel = VoxelGrid::kMinVoxel + 1;
constexpr std::int32_t kLastVoxel = VoxelGrid::kMaxVoxel - 1;
/// Voxels along an axis that always fit, wherever their first one begins.
constexpr double kMostAlong = kLastVoxel - kFirstVoxel - 2;

/// A voxel has so many units in the last place of the largest coordinate, at least. Then its two
/// faces, each rounded twice, differ.
constexpr double kLeastUlps = 16.0;

/// The sample of which the median distance is taken, and how far along the axis neighbours are
/// looked for, in points. A bound of the time, not of the distance: beyond, it may be too large.
constexpr std::size_t kSample = 1000;
constexpr std::size_t kFarthestNeighbour = 20'000;
/// The voxel for points of which all are at one place.
constexpr double kLoneVoxel_m = 0.01;
/// Voxels touch each other where neighbours are this many median distances apart.
constexpr double kVoxelsPerDistance = 2.0;

Box bounds_of(std::span<const Vec3> points) {
  Box box;
  for (const Vec3& point : points) box.extend(point);
  return box;
}

double largest_coordinate(const Box& box) {
  return box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
}

double least_for_doubles_m(const Box& box) {
  return kLeastUlps * std::numeric_limits<double>::epsilon() * largest_coordinate(box);
}

/// Rounds up to some decimal digits; a number of these digits stays as it is.
double rounded_up(double value, int digits) {
  if (!(value > 0.0)) return 0.0;
  const int after_point = digits - 1 - static_cast<int>(std::floor(std::log10(value)));
  const double power = std::pow(10.0, std::abs(after_point));
  // The quotient may be a rounding above a whole number.
  constexpr double kRounding = 1e-9;
  return after_point >= 0 ? std::ceil(value * power - kRounding) / power
                          : std::ceil(value / power - kRounding) * power;
}

/// The least size of voxels that both keys and doubles allow.
double least_voxel_m(const Box& box) {
  constexpr int kDigits = 3;
  return rounded_up(std::max(box.sizes().maxCoeff() / (kMostAlong - 1.0), least_for_doubles_m(box)),
                    kDigits);
}

std::string fault_of(const Box& box, double voxel_m) {
  Eigen::Index axis = 0;
  const double extent_m = box.sizes().maxCoeff(&axis);
  if (!(extent_m <= kMostAlong * voxel_m)) {
    return fmt::format(
        "its points are {:g} m apart along {} ({:g} to {:g} m), which is more than {} voxels of {} "
        "m: voxel_m must be {} at least",
        extent_m, "xyz"[axis], box.min()[axis], box.max()[axis], kMostAlong, voxel_m,
        least_voxel_m(box));
  }
  if (!(voxel_m >= least_for_doubles_m(box))) {
    return fmt::format(
        "its points are up to {:g} m from the origin, where doubles cannot tell "
        "voxels of {} m apart: voxel_m must be {} at least",
        largest_coordinate(box), voxel_m, least_voxel_m(box));
  }
  return {};
}

/// Faces of voxels along one axis, as a placed map has them.
class Axis {
 public:
  Axis(double voxel_m, double low_m, double high_m) : voxel_m_(voxel_m) {
    if (voxel_of(low_m) >= kFirstVoxel && voxel_of(high_m) <= kLastVoxel) return;
    origin_m_ = voxel_m * std::round((low_m + (high_m - low_m) / 2.0) / voxel_m);
  }

  [[nodiscard]] double origin_m() const { return origin_m_; }

  /// The voxel whose closed interval contains the coordinate. Requires one within the bounds, or a
  /// number that is beyond the keys in any case.
  [[nodiscard]] double voxel_of(double at_m) const {
    double voxel = std::floor((at_m - origin_m_) / voxel_m_);
    if (std::abs(voxel) > 2.0 * VoxelGrid::kRoot.size) return voxel;
    while (face_m(voxel) > at_m) voxel -= 1.0;
    while (face_m(voxel + 1.0) <= at_m) voxel += 1.0;
    return voxel;
  }

 private:
  [[nodiscard]] double face_m(double voxel) const {
    const double from_origin_m = voxel * voxel_m_;
    return from_origin_m + origin_m_;
  }

  double voxel_m_;
  double origin_m_ = 0.0;
};

/// The distance from a point to the nearest one at another place; infinity if there is none within
/// reach. Requires points that are sorted along `axis`.
double distance_to_nearest(const std::vector<Vec3>& sorted, std::size_t i, Eigen::Index axis) {
  double nearest = std::numeric_limits<double>::infinity();
  const auto is_beyond = [&](const Vec3& other) {
    if (std::abs(other[axis] - sorted[i][axis]) >= nearest) return true;
    const double distance = (other - sorted[i]).stableNorm();
    if (distance > 0.0) nearest = std::min(nearest, distance);
    return false;
  };
  const std::size_t before = i - std::min(i, kFarthestNeighbour);
  const std::size_t after = std::min(sorted.size(), i + 1 + kFarthestNeighbour);
  for (std::size_t k = i; k > before && !is_beyond(sorted[k - 1]); --k) {
  }
  for (std::size_t k = i + 1; k < after && !is_beyond(sorted[k]); ++k) {
  }
  return nearest;
}

/// The median of the distances of a sample; nothing if all points are at one place.
std::optional<double> median_distance(std::span<const Vec3> points, Eigen::Index axis) {
  std::vector<Vec3> sorted(points.begin(), points.end());
  std::ranges::sort(sorted, [axis](const Vec3& a, const Vec3& b) {
    const auto key = [axis](const Vec3& p) {
      return std::array{p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]};
    };
    return key(a) < key(b);
  });
  std::vector<double> distances;
  const std::size_t count = std::min(kSample, sorted.size());
  for (std::size_t i = 0; i < count; ++i) {
    const double distance = distance_to_nearest(sorted, i * sorted.size() / count, axis);
    if (std::isfinite(distance)) distances.push_back(distance);
  }
  if (distances.empty()) return std::nullopt;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::ranges::nth_element(distances, middle);
  return *middle;
}

}  // namespace

base::Result<CloudVoxels> voxels_of_cloud(std::span<const Vec3> points_m, double voxel_m) {
  CloudVoxels cloud;
  if (points_m.empty()) return cloud;
  const Box box = bounds_of(points_m);
  if (std::string fault = fault_of(box, voxel_m); !fault.empty()) return base::Failure{fault};
  const std::array<Axis, 3> axes = {Axis(voxel_m, box.min().x(), box.max().x()),
                                    Axis(voxel_m, box.min().y(), box.max().y()),
                                    Axis(voxel_m, box.min().z(), box.max().z())};
  VoxelMarker marker(cloud.voxels);
  for (const Vec3& point : points_m) {
    Voxel voxel{};
    for (std::size_t k = 0; k < 3; ++k) {
      voxel[k] = static_cast<std::int32_t>(axes[k].voxel_of(point[static_cast<Eigen::Index>(k)]));
    }
    marker.insert(voxel);
  }
  cloud.origin_m = {axes[0].origin_m(), axes[1].origin_m(), axes[2].origin_m()};
  return cloud;
}

double usual_voxel_m(std::span<const Vec3> points_m) {
  if (points_m.empty()) return kLoneVoxel_m;
  const Box box = bounds_of(points_m);
  Eigen::Index widest = 0;
  box.sizes().maxCoeff(&widest);
  const std::optional<double> distance_m = median_distance(points_m, widest);
  constexpr int kDigits = 2;
  const double wanted_m =
      distance_m ? rounded_up(kVoxelsPerDistance * *distance_m, kDigits) : kLoneVoxel_m;
  return std::clamp(std::max(wanted_m, least_voxel_m(box)), VoxelGrid::kMinResolutionM,
                    VoxelGrid::kMaxResolutionM);
}

}  // namespace camway::scene
