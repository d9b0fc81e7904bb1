// SPDX-License-Identifier: MIT
#include "daemon/collision/near_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "daemon/scene/field/clearance_field.h"
#include "daemon/scene/index/scene_index.h"
#include "daemon/scene/voxels/voxel_map.h"

namespace camway::collision {
namespace {

using geometry::Triangle;
using geometry::Vec3;
using Node = motion::BodyTree::Node;

/// Upper bound of the rounding of a sum or difference of a few numbers.
constexpr double kSumRoundUp = 1.0 + 4.0 * std::numeric_limits<double>::epsilon();

/// How much farther than necessary a distance is measured: a step may then grow as much.
constexpr double kLookAhead = 2.0;

/// Share of the least distance that may be missed: less is no faster.
constexpr double kShare = 0.8;

}  // namespace

NearParts::NearParts(const Obstacles& obstacles, const motion::Body& body)
    : obstacles_(obstacles), tree_(body.tree()) {
  if (tree_ != nullptr) return;
  numbers_.resize(body.triangles_C().size());
  std::iota(numbers_.begin(), numbers_.end(), 0U);
}

void NearParts::choose(const motion::Stretch& stretch, double within_m) {
  if (tree_ == nullptr) return;
  if (!std::isfinite(within_m)) return choose_all();
  numbers_.clear();
  others_at_least_m_ = std::numeric_limits<double>::infinity();
  others_are_in_solid_ = false;
  waiting_.assign(1, 0);
  while (!waiting_.empty()) {
    const std::uint32_t number = waiting_.back();
    waiting_.pop_back();
    const Node& node = tree_->nodes()[number];
    const Vec3 center_W = stretch.R_WC * node.center_C + stretch.eye_W;
    const double enough_m = (node.radius_m + within_m) * kSumRoundUp;
    const double room_m = room_at_least_m(center_W, enough_m);
    if (room_m > enough_m) {
      others_at_least_m_ = std::min(others_at_least_m_, room_m / kSumRoundUp - node.radius_m);
      others_are_in_solid_ = others_are_in_solid_ ||
                             (obstacles_.solids != nullptr && obstacles_.solids->hold(center_W));
    } else if (node.is_leaf()) {
      const std::span<const std::uint32_t> all = tree_->order();
      numbers_.insert(numbers_.end(), all.begin() + node.begin, all.begin() + node.end);
    } else {
      waiting_.push_back(node.second_child);
      waiting_.push_back(number + 1);
    }
  }
}

void NearParts::choose_all() {
  numbers_.assign(tree_->order().begin(), tree_->order().end());
  others_at_least_m_ = std::numeric_limits<double>::infinity();
  others_are_in_solid_ = false;
}

double NearParts::room_at_least_m(const Vec3& point_W, double enough_m) const {
  const double depth_m = obstacles_.bounds.depth_m(point_W);
  if (!(depth_m > enough_m)) return depth_m;
  if (obstacles_.field != nullptr) {
    const double field_m = obstacles_.field->clearance_at_least_m(point_W);
    if (field_m > enough_m) return std::min(field_m, depth_m);
  }
  const std::array<Triangle, 1> point = {Triangle{point_W, point_W, point_W}};
  const double error_m = obstacles_.index.nearest_error_m(point);
  const double certain_m = enough_m + 2.0 * error_m;
  const double horizon_m = kLookAhead * certain_m;
  const std::optional<scene::Nearest> nearest =
      obstacles_.index.near(point, horizon_m, certain_m, kShare);
  if (!nearest) return std::min(depth_m, horizon_m - error_m);
  // A distance that is not below `certain_m` proves that none is, and is within the share.
  if (nearest->distance_m < certain_m) return std::min(depth_m, nearest->distance_m - error_m);
  return std::min(depth_m, std::max(certain_m, kShare * nearest->distance_m) - error_m);
}

}  // namespace camway::collision
