// SPDX-License-Identifier: MIT
#include "daemon/motion/spline/quaternion_spline.h"

#include <numbers>

#include "tests/motion/random_motion.h"

namespace camway::motion {
namespace {

using geometry::Quat;
using test::kEpsilon;
using test::Vec3;
using test::Vec4;
using testing::Random;

constexpr double kDegree_rad = std::numbers::pi / 180.0;

struct OrientationPiece {
  double t0_s;
  double t1_s;
  std::size_t keyframe;
  std::array<Vec4, 7> orientation;
};

std::vector<OrientationPiece> spline_through(const std::vector<Quat>& rotations) {
  std::vector<double> times_s;
  std::vector<Vec4> orientations;
  for (const Quat& rotation : rotations) {
    times_s.push_back(static_cast<double>(times_s.size()));
    orientations.push_back(geometry::wxyz(rotation));
  }
  const ImageSpline spline = quaternion_spline(times_s, orientations);
  std::vector<OrientationPiece> pieces;
  for (const ImagePiece& piece : spline.pieces) {
    pieces.push_back({piece.t0_s, piece.t1_s, piece.keyframe,
                      orientation_of(spline.reference, piece.control_points)});
  }
  return pieces;
}

Quat orientation_at(const std::vector<OrientationPiece>& pieces, double time_s) {
  std::size_t i = 0;
  while (i + 1 < pieces.size() && pieces[i].t1_s <= time_s) ++i;
  Segment segment;
  segment.t0_s = pieces[i].t0_s;
  segment.t1_s = pieces[i].t1_s;
  segment.position.fill(Vec3::Zero());
  segment.orientation = pieces[i].orientation;
  return pose_at(segment, segment_parameter(segment, time_s)).orientation;
}

TEST(QuaternionSpline, PiecesCoverEveryPairInOrder) {
  Random random(91);
  std::vector<Quat> rotations;
  for (int i = 0; i < 40; ++i) rotations.push_back(random.rotation());
  const std::vector<OrientationPiece> pieces = spline_through(rotations);
  EXPECT_EQ(pieces.front().t0_s, 0.0);
  EXPECT_EQ(pieces.back().t1_s, 39.0);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    EXPECT_GE(pieces[i].t0_s, static_cast<double>(pieces[i].keyframe));
    EXPECT_LE(pieces[i].t1_s, static_cast<double>(pieces[i].keyframe + 1));
    EXPECT_LT(pieces[i].t0_s, pieces[i].t1_s);
    if (i > 0) {
      EXPECT_EQ(pieces[i].t0_s, pieces[i - 1].t1_s);
    }
  }
}

TEST(QuaternionSpline, NoKnotsAreFurtherApartThanTheLimit) {
  Random random(92);
  std::vector<Quat> rotations;
  for (int i = 0; i < 60; ++i) rotations.push_back(random.rotation());
  for (const OrientationPiece& piece : spline_through(rotations)) {
    // Half the angle of the rotation is the angle on S³.
    const double apart_rad = 0.5 * test::rotation_angle_rad(piece.orientation[0].normalized(),
                                                            piece.orientation[6].normalized());
    EXPECT_LE(apart_rad, kLargestKnotAngle_rad + 8.0 * kEpsilon);
  }
}

TEST(QuaternionSpline, NearNeighboursGetNoExtraKnots) {
  std::vector<Quat> rotations;
  for (int i = 0; i < 5; ++i) rotations.push_back(test::turned(Vec3(1, 2, 3), 1.0 * i));
  EXPECT_EQ(spline_through(rotations).size(), 4U);
}

TEST(QuaternionSpline, AConstantOrientationIsConstant) {
  const Quat rotation = test::turned(Vec3(1, 2, 3), 0.7);
  for (const OrientationPiece& piece : spline_through({rotation, rotation, rotation})) {
    for (const Vec4& coefficient : piece.orientation)
      EXPECT_LT((coefficient - geometry::wxyz(rotation)).norm(), 8.0 * kEpsilon);
  }
}

// Between keyframes less than 60° apart on S³ the motion stays within a fraction of the step from
// the shortest rotation.
TEST(QuaternionSpline, StaysNearTheShortestTurns) {
  Random random(93);
  for (int repeat = 0; repeat < 50; ++repeat) {
    std::vector<Quat> rotations = {random.rotation()};
    for (int i = 1; i < 10; ++i)
      rotations.push_back(rotations.back() *
                          test::turned(random.normal_vector(1.0), random.uniform(0.2, 2.0)));
    const std::vector<OrientationPiece> pieces = spline_through(rotations);
    for (std::size_t i = 0; i + 1 < rotations.size(); ++i) {
      const double step_rad = test::rotation_angle_rad(rotations[i], rotations[i + 1]);
      for (int k = 0; k <= 20; ++k) {
        const Quat q = orientation_at(pieces, static_cast<double>(i) + k / 20.0);
        const double detour_rad = test::rotation_angle_rad(rotations[i], q) +
                                  test::rotation_angle_rad(q, rotations[i + 1]) - step_rad;
        EXPECT_LT(detour_rad, 2.5) << "a swing the long way round would be near 2 pi";
      }
    }
  }
}

// The tilt of rotations that only nearly keep their axis is as the header states.
TEST(QuaternionSpline, TiltOfTenTurnsAboutNearlyOneAxisIsAsDocumented) {
  Random random(94);
  constexpr double kNoise = 1e-7;
  for (const auto& [step_deg, tilt_deg] : {std::pair{10.0, 0.0003}, std::pair{30.0, 0.015},
                                           std::pair{60.0, 0.23}, std::pair{90.0, 1.1}}) {
    std::vector<Quat> rotations;
    for (double angle_deg = 0.0; angle_deg <= 3600.0; angle_deg += step_deg)
      rotations.push_back((test::turned(Vec3::UnitY(), angle_deg * kDegree_rad) *
                           Quat(1.0, kNoise * random.normal(), 0.0, kNoise * random.normal()))
                              .normalized());
    const std::vector<OrientationPiece> pieces = spline_through(rotations);
    double largest_rad = 0.0;
    for (int i = 0; i <= 10'000; ++i) {
      const Vec3 up = orientation_at(pieces, pieces.back().t1_s * i / 10'000.0) * Vec3::UnitY();
      largest_rad = std::max(largest_rad, std::atan2(std::hypot(up.x(), up.z()), up.y()));
    }
    EXPECT_LT(largest_rad, tilt_deg * kDegree_rad) << step_deg;
    EXPECT_GT(largest_rad, 0.5 * tilt_deg * kDegree_rad)
        << step_deg << ": the header is out of date";
  }
}

TEST(AlignedOrientations, NeighboursTakeTheShorterWay) {
  Random random(95);
  std::vector<Vec4> given;
  for (int i = 0; i < 500; ++i)
    given.push_back(random.uniform(0.5, 2.0) * geometry::wxyz(random.rotation()));
  const std::vector<Vec4> aligned = aligned_orientations(given);
  for (std::size_t i = 0; i < aligned.size(); ++i) {
    EXPECT_NEAR(aligned[i].norm(), 1.0, 4.0 * kEpsilon);
    EXPECT_NEAR(std::abs(aligned[i].dot(given[i])), given[i].norm(), 8.0 * kEpsilon);
    if (i > 0) {
      EXPECT_GE(aligned[i].dot(aligned[i - 1]), -kHalfTurnRounding);
    }
  }
}

TEST(AlignedOrientations, HalfTurnsHaveTheSameSenseInEveryFrame) {
  Random random(96);
  const Quat start = random.rotation();
  for (const auto& [axis, sense] :
       {std::pair{Vec3(0, 1, 0), 1.0}, std::pair{Vec3(0, -1, 0), -1.0},
        std::pair{Vec3(1, 0, 0), 1.0}, std::pair{Vec3(0, 0, -1), -1.0},
        std::pair{Vec3(-1, 1, 1), -1.0}, std::pair{Vec3(0.1, 1, 0), 1.0},
        std::pair{Vec3(-0.1, 1, 0), 1.0}}) {
    for (int repeat = 0; repeat < 20; ++repeat) {
      const Quat frame = random.rotation();
      Quat from = frame * start;
      Quat to = frame * start * test::turned(axis, std::numbers::pi);
      if (random.chance(0.5)) from.coeffs() *= -1.0;
      if (random.chance(0.5)) to.coeffs() *= -1.0;
      const std::vector<Vec4> aligned =
          aligned_orientations(std::vector<Vec4>{geometry::wxyz(from), geometry::wxyz(to)});
      const Vec4 turn = quaternion::multiply(quaternion::conjugate(aligned[0]), aligned[1]);
      EXPECT_NEAR(turn.tail<3>().dot(axis.normalized()), sense, 32.0 * kEpsilon)
          << axis.transpose();
    }
  }
}

}  // namespace
}  // namespace camway::motion
