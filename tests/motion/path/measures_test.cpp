// SPDX-License-Identifier: MIT
#include "daemon/motion/path/measures.h"

#include <numbers>

#include "tests/motion/random_motion.h"

namespace camway::motion {
namespace {

using test::Vec3;
using testing::Random;

Path straight(double length_m, double duration_s) {
  const std::vector<Keyframe> keyframes = {
      {0.0, {Vec3::Zero(), geometry::Quat::Identity()}},
      {duration_s, {Vec3(length_m, 0, 0), geometry::Quat::Identity()}}};
  return interpolate(keyframes);
}

TEST(Measures, OfAStraightLineAreThoseOfTheLine) {
  const Path path = straight(3.0, 2.0);
  const PathMeasures measures = measure(path, path);
  EXPECT_NEAR(measures.length_m, 3.0, 1e-12);
  EXPECT_NEAR(measures.largest_speed_m_per_s, 1.5, 1e-12);
  EXPECT_NEAR(measures.bending_energy_m2_per_s3, 0.0, 1e-20);
  EXPECT_EQ(measures.largest_deviation_m, 0.0);
  EXPECT_EQ(measures.largest_turn_rate_rad_per_s, 0.0);
}

// A cubic with acceleration a·(1 - t) + b·t over one second has the integral (a² + ab + b²)/3 of
// its square.
TEST(Measures, BendingEnergyIsTheIntegral) {
  Random random(821);
  for (int round = 0; round < 50; ++round) {
    std::vector<Keyframe> keyframes;
    for (int i = 0; i < 5; ++i)
      keyframes.push_back({1.3 * i, {random.normal_vector(2.0), random.rotation()}});
    const Path path = interpolate(keyframes);
    double sum = 0.0;
    constexpr int kSteps = 4000;
    for (const Segment& segment : path.segments()) {
      for (int i = 0; i < kSteps; ++i) {
        sum += derivatives_at(segment, (i + 0.5) / kSteps).acceleration_m_per_s2.squaredNorm() *
               (segment.t1_s - segment.t0_s) / kSteps;
      }
    }
    const PathMeasures measures = measure(path, path);
    EXPECT_NEAR(measures.bending_energy_m2_per_s3 / sum, 1.0, 1e-5);
  }
}

TEST(Measures, TurnRateIsThatOfTheRotation) {
  std::vector<Keyframe> keyframes;
  for (int i = 0; i < 6; ++i)
    keyframes.push_back({0.5 * i, {Vec3::Zero(), test::turned(Vec3::UnitY(), 0.2 * i)}});
  const Path path = interpolate(keyframes);
  EXPECT_NEAR(measure(path, path).largest_turn_rate_rad_per_s, 0.4, 1e-3);
}

TEST(Measures, DeviationIsAtEqualShareOfTheTime) {
  const PathMeasures measures = measure(straight(3.0, 4.0), straight(2.0, 1.0));
  EXPECT_NEAR(measures.largest_deviation_m, 1.0, 1e-12);
}

}  // namespace
}  // namespace camway::motion
