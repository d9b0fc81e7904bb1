// SPDX-License-Identifier: MIT
#include "tests/motion/spline/awkward_keyframes.h"

#include <numbers>

#include "tests/motion/random_motion.h"

namespace camway::motion::test {
namespace {

std::vector<Keyframe> spiral(double turns, double step_rad, double noise, Random& random) {
  std::vector<Pose> poses;
  const double end_rad = 2.0 * std::numbers::pi * turns;
  for (double angle_rad = 0.0; angle_rad < end_rad; angle_rad += step_rad) {
    const Quat off_axis =
        Quat(1.0, noise * random.normal(), noise * random.normal(), noise * random.normal())
            .normalized();
    poses.push_back({Vec3(std::cos(angle_rad), 0.1 * angle_rad, std::sin(angle_rad)),
                     turned(Vec3::UnitY(), angle_rad) * turned(Vec3::UnitX(), -0.4) * off_axis});
  }
  return with_times(poses);
}

std::vector<Keyframe> nearly_opposite(Random& random) {
  std::vector<Pose> poses = {{Vec3::Zero(), random.rotation()}};
  for (int i = 1; i < 12; ++i) {
    const double angle_rad = std::numbers::pi - random.log_uniform(1e-9, 1e-2);
    poses.push_back({random.normal_vector(2.0),
                     poses.back().orientation * turned(random.normal_vector(1.0), angle_rad)});
  }
  return with_times(poses);
}

std::vector<Keyframe> half_turns() {
  std::vector<Pose> poses;
  for (int i = 0; i < 8; ++i)
    poses.push_back({Vec3(i, 0, 0), turned(Vec3::UnitY(), i * std::numbers::pi)});
  poses.push_back({Vec3(8, 0, 0), turned(Vec3::UnitX(), 0.3)});
  return with_times(poses);
}

std::vector<Keyframe> clusters(Random& random) {
  std::vector<Pose> poses;
  for (int i = 0; i < 6; ++i) {
    const Pose centre{random.normal_vector(3.0),
                      turned(random.normal_vector(1.0), random.uniform(0.0, 1.0))};
    for (int k = 0; k < 3; ++k)
      poses.push_back({centre.position + random.normal_vector(1e-6),
                       centre.orientation * turned(random.normal_vector(1.0), 1e-6)});
  }
  return with_times(poses);
}

std::vector<Keyframe> repeated(Random& random) {
  std::vector<Pose> poses;
  for (const Pose& pose : random_poses(random, 6))
    poses.insert(poses.end(), static_cast<std::size_t>(random.integer(1, 3)), pose);
  return with_times(poses);
}

std::vector<Keyframe> on_the_spot(Random& random) {
  std::vector<Pose> poses;
  for (int i = 0; i < 7; ++i) poses.push_back({Vec3(1.0, 2.0, 3.0), random.rotation()});
  return with_times(poses);
}

std::vector<Keyframe> irregular_times(Random& random) {
  std::vector<Keyframe> keyframes = with_times(random_poses(random, 30));
  double time_s = -17.0;
  for (Keyframe& keyframe : keyframes) keyframe.time_s = time_s += random.log_uniform(0.05, 5.0);
  return keyframes;
}

std::vector<Keyframe> wall_clock_times(Random& random) {
  std::vector<Keyframe> keyframes = with_times(random_poses(random, 12));
  for (Keyframe& keyframe : keyframes) keyframe.time_s += 1.7e9;
  return keyframes;
}

std::vector<Keyframe> far_away(Random& random) {
  std::vector<Pose> poses = random_poses(random, 12);
  for (Pose& pose : poses) pose.position += Vec3(1e6, -1e6, 1e6);
  return with_times(poses);
}

std::vector<Keyframe> at_rest() {
  return with_times(std::vector<Pose>(5, Pose{Vec3(1, 2, 3), turned(Vec3(1, 1, 0), 1.0)}));
}

std::vector<Keyframe> full_turn() {
  std::vector<Pose> poses;
  for (int i = 0; i <= 8; ++i)
    poses.push_back({Vec3(0.1 * i, 0, 0), turned(Vec3(1, 2, 2), i * std::numbers::pi / 4.0)});
  return with_times(poses);
}

}  // namespace

std::vector<AwkwardKeyframes> awkward_keyframes() {
  Random random(kAwkwardSeed);
  const double degree_rad = std::numbers::pi / 180.0;
  return {
      {"Two", with_times(random_poses(random, 2))},
      {"Three", with_times(random_poses(random, 3))},
      {"Five", with_times(random_poses(random, 5))},
      {"ThousandRandom", with_times(random_poses(random, 1000))},
      {"TenTurns", spiral(10.0, 20.0 * degree_rad, 0.0, random)},
      {"TenTurnsCoarse", spiral(10.0, 100.0 * degree_rad, 0.0, random)},
      {"TenTurnsNearlyOneAxis", spiral(10.0, 35.0 * degree_rad, 1e-7, random)},
      {"TenTurnsUnsteady", spiral(10.0, 50.0 * degree_rad, 0.05, random)},
      {"FullTurn", full_turn()},
      {"NearlyOpposite", nearly_opposite(random)},
      {"HalfTurns", half_turns(), true},
      {"Clusters", clusters(random)},
      {"Repeated", repeated(random)},
      {"OnTheSpot", on_the_spot(random)},
      {"AtRest", at_rest()},
      {"IrregularTimes", irregular_times(random)},
      {"WallClockTimes", wall_clock_times(random)},
      {"FarAway", far_away(random)},
  };
}

}  // namespace camway::motion::test
