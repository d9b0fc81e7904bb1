// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <optional>

#include "tests/correction/relaxation_case.h"

namespace camway::correction {
namespace {

using base::Deadline;

constexpr std::uint64_t kSqueezedSeed = 7001;
constexpr double kCameraWide_m = 0.2;  // near quadrilateral of `small_camera()`
constexpr int kRuns = 24;
constexpr int kSteps = 12;  // of a part that makes room

/// A path along z through a wall with an upright slit beside it, and a correction that leads high
/// through the slit, which is 2 to 15 % wider than the camera.
struct Slit {
  RelaxationCase c;
  std::optional<Relaxed> high;
};

Slit random_slit(testing::Draw& draw) {
  Slit slit;
  while (!slit.high) {
    RelaxationCase& c = slit.c;
    c = RelaxationCase();
    const double width_m = kCameraWide_m * draw.uniform(1.02, 1.15);
    const double left_m = draw.uniform(0.1, 0.6);
    const double half_m = draw.uniform(0.05, 0.3);
    testing::add_cuboid(c.mesh, {-30, -30, -half_m}, {left_m, 30, half_m});
    testing::add_cuboid(c.mesh, {left_m + width_m, -30, -half_m}, {30, 30, half_m});
    c.build();
    c.problem = testing::problem_along_z();
    const geometry::Vec3 aside_m(left_m + 0.5 * width_m, draw.uniform(0.5, 1.5), 0.0);
    slit.high = correction_with(c, lifted(c.problem, 12, aside_m), Ends::kFixed);
  }
  return slit;
}

// Nothing holds the path up, but the camera has millimetres on either side.
TEST(Squeezed, PathsGetDownInASlit) {
  testing::Draw draw(kSqueezedSeed);
  double sum = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const Slit slit = random_slit(draw);
    FreeSpace space = slit.c.space();
    base::Budget budget(kSteps);
    const Relaxed low =
        relaxed(slit.c.problem, *slit.high, Ends::kFixed, {}, budget, space, Deadline::never());
    const auto cost = [&](const Relaxed& of) {
      return slit.c.value(of.offsets, Ends::kFixed, Objective::kClosest);
    };
    sum += std::log(cost(low) / cost(*slit.high));
  }
  // 0.15; with the usual sweeps alone, 0.24.
  EXPECT_LT(std::exp(sum / kRuns), 0.19);
}

}  // namespace
}  // namespace camway::correction
