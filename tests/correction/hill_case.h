// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <numbers>

#include "daemon/collision/clearance.h"
#include "daemon/correction/path/candidate.h"
#include "daemon/correction/path/viewing_distance.h"
#include "tests/correction/ladder_case.h"
#include "tests/support/gap_problems.h"

namespace camway::correction {

inline constexpr int kHillKnots = 40;

/// A block on the straight path between two keyframes, and hills over it on many knots.
struct HillCase {
  explicit HillCase(testing::Draw& draw) {
    const double half_m = draw.uniform(2.0, 3.0);
    const double top_m = draw.uniform(0.1, 0.4);
    scene::Mesh mesh;
    testing::add_cuboid(mesh, {-9, -9, -0.2}, {9, top_m, 0.2});
    ladder = case_with(mesh, {at(0, {0, 0, half_m}), at(draw.uniform(3, 8), {0, 0, -half_m})});
    straight = ladder.path();
    height_m = top_m + draw.uniform(0.1, 0.5);
  }

  [[nodiscard]] FreeSpace space(double clearance_m = 0.0) const {
    collision::Query query = ladder.query();
    const FreeSpace plain(query, OrientationPolicy{});
    query.options.clearance_m = clearance_m;
    return FreeSpace(query, OrientationPolicy{}, closeness_of(straight, plain, 3.0));
  }

  /// The hill with wrinkles, which make it longer and rougher, and up to `wrinkle_m` lower.
  [[nodiscard]] Candidate hill(testing::Draw& draw, double wrinkle_m) const {
    const Problem problem = testing::problem_of_leg(ladder.keyframes, 0);
    Offsets offsets{problem.knots(kHillKnots), 1, {}};
    for (int k = 1; k < kHillKnots; ++k) {
      const double share = std::sin(std::numbers::pi * k / kHillKnots);
      const double up_m = height_m - draw.uniform(0.0, wrinkle_m);
      const double aside_m = draw.uniform(-3.0, 3.0) * wrinkle_m;
      offsets.at.push_back({{share * aside_m, share * up_m, 0}, geometry::Vec4::Zero()});
    }
    return free_candidate(problem, {bumps_for(offsets, Ends::kFixed)}, space(),
                          base::Deadline::never())
        .value();
  }

  [[nodiscard]] collision::PathClearance clearance(const motion::CubicPath& path) const {
    return collision::path_clearance(ladder.query().obstacles, path.path(), ladder.body,
                                     base::Deadline::never())
        .value();
  }

  LadderCase ladder;
  motion::CubicPath straight;
  double height_m = 0.0;  ///< of the hill
};

}  // namespace camway::correction
