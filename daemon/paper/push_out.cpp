// SPDX-License-Identifier: MIT
#include "daemon/paper/push_out.h"

#include <algorithm>

#include "daemon/collision/near_quad.h"

namespace camway::paper {

namespace {

using geometry::Vec3;

// Good corners cancel where their vectors sum to less than this share of the camera's radius:
// opposite corners of an exact rectangle sum to rounding noise, a single one to about the radius.
constexpr double kCancelledShare = 1e-6;

// Distance from `from` to the first hit on the way to `to`, or nothing.
std::optional<double> hit_distance_m(const scene::SceneIndex& index, const Vec3& from,
                                     const Vec3& to) {
  const std::optional<scene::SegmentHit> hit = index.closest_hit({from, to});
  if (!hit) return std::nullopt;
  return hit->fraction * (to - from).norm();
}

double corner_depth_m(const scene::SceneIndex& index, const motion::Corners& corners_W,
                      const Vec3& center_W, std::size_t corner) {
  const Vec3& bad_W = corners_W[corner];
  const std::optional<double> next = hit_distance_m(index, bad_W, corners_W[(corner + 1) % 4]);
  const std::optional<double> previous = hit_distance_m(index, bad_W, corners_W[(corner + 3) % 4]);
  if (next || previous) return std::max(next.value_or(0.0), previous.value_or(0.0));
  return hit_distance_m(index, bad_W, center_W).value_or(0.0);
}

}  // namespace

double PushOutRule::largest_depth_m() const {
  return *std::max_element(depth_m.begin(), depth_m.end());
}

PushOutRule push_out_rule(const scene::SceneIndex& index, const motion::Corners& corners_C,
                          const motion::Pose& pose) {
  const motion::Corners corners_W = motion::corners_W(corners_C, pose);
  const Vec3 center_W = 0.25 * (corners_W[0] + corners_W[1] + corners_W[2] + corners_W[3]);
  PushOutRule rule;
  rule.direction_W = Vec3::Zero();
  for (std::size_t i = 0; i < corners_W.size(); ++i) {
    rule.bad[i] = index.closest_hit({center_W, corners_W[i]}).has_value();
    if (rule.bad[i]) {
      rule.depth_m[i] = corner_depth_m(index, corners_W, center_W, i);
    } else {
      rule.direction_W += corners_W[i] - center_W;
    }
  }
  return rule;
}

PushOut push_out(const scene::SceneIndex& index, const motion::Corners& corners_C,
                 const motion::Pose& pose, double margin_m) {
  const double radius_m = motion::body_radius_m(corners_C);
  PushOut result{PushOutOutcome::kCutOff, pose, 0};
  std::optional<Vec3> last_direction_W;
  for (; result.steps <= kMaxPushOutSteps; ++result.steps) {
    const std::optional<double> gap_m =
        collision::clearance_m(index, corners_C, result.pose, margin_m);
    if (!gap_m) {
      result.outcome = PushOutOutcome::kFree;
      return result;
    }
    const PushOutRule rule = push_out_rule(index, corners_C, result.pose);
    const double length_m = rule.direction_W.norm();
    if (length_m > kCancelledShare * radius_m) {
      last_direction_W = rule.direction_W / length_m;
    } else if (*gap_m == 0.0 || !last_direction_W) {
      result.outcome = PushOutOutcome::kNoDirection;
      return result;
    }
    const double step_m = std::max(rule.largest_depth_m(), kLeastStepShare * radius_m);
    result.pose.position += step_m * *last_direction_W;
  }
  return result;
}

}  // namespace camway::paper
