// SPDX-License-Identifier: MIT
#include "daemon/planning/stages/fixed_place.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "daemon/collision/clearance.h"
#include "daemon/collision/probe.h"
#include "daemon/motion/path/stretch.h"

namespace camway::planning {

namespace {

constexpr double kMeasuredShare = 0.99;  // the true distance is at least this share
// Upper bound of the rounding of a difference, a product and a quotient, which the bound of
// `kClearanceTolerance` does not count.
constexpr double kRoundUp = 1.0 + 8.0 * std::numeric_limits<double>::epsilon();

/// Returns the given keyframe that is nearest to the scene, if that is nearer than `limit_m`.
std::optional<FixedPlace> nearest_given_keyframe(const collision::Query& query,
                                                 const PlanResult& result, double limit_m,
                                                 const base::Deadline& deadline) {
  constexpr std::size_t kStepsPerDeadlineCheck = 256;  // a step is a keyframe
  const collision::Obstacles scene = query.obstacles.without_bounds();
  collision::Probe probe(scene, query.body, /*clearance_m=*/0.0);
  std::optional<FixedPlace> nearest;
  std::size_t given = 0;
  for (const motion::Keyframe& keyframe : result.keyframes) {
    if (keyframe.origin == motion::KeyframeOrigin::kInserted) continue;
    const std::size_t number = given++;
    if (number % kStepsPerDeadlineCheck == 0 && deadline.passed()) return std::nullopt;
    const collision::ProbeResult seen =
        probe.check_refined(motion::standing_at(keyframe.pose), limit_m, kMeasuredShare);
    if (seen.free || !(seen.gap_m < limit_m)) continue;
    limit_m = seen.gap_m;
    nearest = FixedPlace{number, keyframe.time_s, seen.gap_m};
  }
  return nearest;
}

bool is_changed(const motion::Segment& segment, const PlanResult& result) {
  return std::ranges::any_of(result.corrections, [&](const correction::Correction& correction) {
    return correction.kind != correction::CorrectionKind::kNone &&
           segment.t0_s < correction.t_end_s && segment.t1_s > correction.t_begin_s;
  });
}

/// Returns the parts of the path that no correction changed.
std::vector<motion::Path> unchanged_parts(const PlanResult& result) {
  std::vector<motion::Path> parts;
  std::vector<motion::Segment> part;
  const auto end_part = [&] {
    if (!part.empty()) parts.emplace_back(std::exchange(part, {}));
  };
  for (const motion::Segment& segment : result.path.segments()) {
    if (is_changed(segment, result)) {
      end_part();
    } else {
      part.push_back(segment);
    }
  }
  end_part();
  return parts;
}

}  // namespace

std::optional<FixedPlace> limiting_place(const collision::Query& query, const PlanResult& result,
                                         const base::Deadline& deadline) {
  const double least_m = result.certificate.clearance_lower_bound_m;
  if (auto keyframe = nearest_given_keyframe(query, result, least_m / kHardlyMore, deadline)) {
    return keyframe;
  }
  std::optional<FixedPlace> nearest;
  // The path comes at least as near as this. Where a part surely does not, it is not the nearest.
  const double nearest_m = kRoundUp * least_m / (1.0 - collision::kClearanceTolerance);
  for (const motion::Path& part : unchanged_parts(result)) {
    const auto clearance = collision::path_clearance(query.obstacles, part, query.body, deadline);
    if (!clearance) return std::nullopt;
    if (clearance->lower_bound_m > nearest_m) continue;
    if (nearest && clearance->upper_bound_m >= nearest->distance_m) continue;
    nearest = FixedPlace{std::nullopt, clearance->closest_s, clearance->upper_bound_m};
  }
  return nearest;
}

}  // namespace camway::planning
