// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "daemon/collision/near_quad.h"
#include "daemon/correction/path/closeness.h"
#include "daemon/correction/smoothing/relaxation.h"
#include "daemon/correction/smoothing/smoothing_form.h"
#include "tests/support/gap_problems.h"
#include "tests/support/scenes.h"

namespace camway::correction {

inline constexpr int kEnoughSteps = 100;  // steps

inline motion::Keyframe at(double time_s, const geometry::Vec3& position,
                           const geometry::Quat& orientation = geometry::Quat::Identity()) {
  return {time_s, {position, orientation}};
}

/// A scene, a camera and an interval between keyframes in it.
struct RelaxationCase {
  scene::Mesh mesh;
  scene::SceneIndex index;
  motion::Body body{testing::small_camera()};
  collision::DetectOptions detect;
  OrientationPolicy policy;
  Problem problem;

  void build() { index = scene::SceneIndex::build(mesh); }
  [[nodiscard]] FreeSpace space() const {
    return FreeSpace({collision::Obstacles(index), body, detect}, policy);
  }
  /// Returns the value of the objective.
  [[nodiscard]] double value(const Offsets& offsets, Ends ends, Objective objective) const {
    const Closeness closeness = space().closeness();
    if (objective == Objective::kClosest) {
      const motion::BumpRow row = bumps_for(offsets, ends);
      return closeness_cost(motion::with_bumps(problem.path, std::vector{row}), problem.original,
                            closeness);
    }
    const double lever_m = 4.0 * space().ball_radius_m();
    const FreeCoefficients free(problem, offsets.knots, ends);
    const StackedPoints variables = free.variables_of(offsets, lever_m);
    return SmoothingForm(problem, free, objective, lever_m, closeness, variables)
        .bounded_value(variables);
  }
};

/// Returns the least distance of the near quadrilateral over equidistant times, by all triangles.
inline double least_gap_m(const RelaxationCase& c, const motion::CubicPath& path, double begin_s,
                          double end_s, int samples) {
  const motion::Corners corners_C = motion::near_corners_C(testing::small_camera());
  constexpr double kFar_m = 10.0;
  double least_m = kFar_m;
  for (int i = 0; i <= samples; ++i) {
    const double time_s = std::lerp(begin_s, end_s, static_cast<double>(i) / samples);
    least_m = std::min(
        least_m,
        collision::clearance_m(c.index, corners_C, path.pose(time_s), kFar_m).value_or(kFar_m));
  }
  return least_m;
}

inline std::optional<Relaxed> correction_with(const RelaxationCase& c, const Offsets& offsets,
                                              Ends ends) {
  FreeSpace space = c.space();
  Attempt tried = attempt(c.problem, {bumps_for(offsets, ends)}, space, base::Deadline::never());
  if (!tried.candidate) return std::nullopt;
  return Relaxed{offsets, std::move(*tried.candidate)};
}

inline Relaxed relaxed_fully(const RelaxationCase& c, const Relaxed& free, Ends ends,
                             Objective objective, int steps = kEnoughSteps) {
  FreeSpace space = c.space();
  const Improvement improvement{objective};
  base::Budget budget(steps);
  return relaxed(c.problem, free, ends, improvement, budget, space, base::Deadline::never());
}

/// Returns equal inner coefficients.
inline Offsets lifted(const Problem& problem, int count, const geometry::Vec3& by) {
  Offsets offsets{{problem.leg_begin_s(), problem.leg_end_s(), count}, 1, {}};
  for (int k = 1; k < count; ++k) offsets.at.push_back({by, geometry::Vec4::Zero()});
  return offsets;
}

}  // namespace camway::correction
