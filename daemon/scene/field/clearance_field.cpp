// SPDX-License-Identifier: MIT
#include "daemon/scene/field/clearance_field.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "daemon/geometry/rounding.h"

namespace camway::scene {
namespace {

using geometry::Box;
using geometry::Vec3;

/// Differences, squares, their sum and the root round by less than 5 units of 2^-53.
constexpr double kRoundDown = 1.0 - 8.0 * geometry::kUnitRoundoff;

double distance_at_least_m(const Vec3& point, const Box& box) {
  const Vec3 gap = (box.min() - point).cwiseMax(point - box.max()).cwiseMax(0.0);
  return kRoundDown * gap.norm();
}

/// The bound that the object's own field gives for a point of the world. `error_m` counts twice:
/// for the triangles, rounded on their way into the world, and for the point, rounded on its way
/// back.
double field_at_least_m(const PlacedField& placed, double reach_m, const Vec3& point_W) {
  const double bound_m = placed.field_O->clearance_at_least_m(placed.placement.to_object(point_W));
  const double error_m =
      placed.placement.error_m(reach_m) + placed.placement.error_m(point_W.lpNorm<1>());
  return kRoundDown * bound_m - error_m;
}

}  // namespace

ClearanceField::ClearanceField(std::shared_ptr<const DistanceField> field)
    : single_(std::move(field)), statistics_(single_->statistics()) {}

ClearanceField::ClearanceField(std::span<const PlacedField> objects) {
  assert(!objects.empty() && objects.size() <= kMaxObjects);
  double finest_m = std::numeric_limits<double>::infinity();
  std::uint64_t memory_bytes = 0;
  for (const PlacedField& placed : objects) {
    const Vec3 farthest =
        placed.bounds_O.min().cwiseAbs().cwiseMax(placed.bounds_O.max().cwiseAbs());
    objects_.push_back({placed, farthest.lpNorm<1>()});
    if (!placed.field_O) continue;
    memory_bytes += placed.field_O->statistics().memory_bytes;
    if (placed.field_O->statistics().resolution_m < finest_m) {
      finest_m = placed.field_O->statistics().resolution_m;
      statistics_ = placed.field_O->statistics();
    }
  }
  statistics_.memory_bytes = memory_bytes;
  if (objects.size() == 1 && objects[0].field_O && objects[0].placement.is_identity()) {
    single_ = objects[0].field_O;
  }
}

double ClearanceField::least_m(const Vec3& point_W) const {
  if (!point_W.allFinite()) return 0.0;
  double least_m = std::numeric_limits<double>::infinity();
  for (const Object& object : objects_) {
    const double box_m = distance_at_least_m(point_W, object.placed.bounds_W);
    if (box_m >= least_m) continue;
    const double field_m =
        object.placed.field_O ? field_at_least_m(object.placed, object.reach_m, point_W) : 0.0;
    least_m = std::min(least_m, std::max(box_m, field_m));
    if (!(least_m > 0.0)) return 0.0;
  }
  return least_m;
}

}  // namespace camway::scene
