// SPDX-License-Identifier: MIT
#include "daemon/scene/index/box_gaps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "daemon/geometry/triangle_box.h"
#include "daemon/geometry/triangle_distance.h"
#include "tests/geometry/random_triangles.h"

namespace camway::scene {
namespace {

using geometry::Box;
using geometry::OrientedBox;
using geometry::RandomTriangles;
using geometry::Triangle;
using geometry::Vec3;

/// A frame with eight boxes in it, and these boxes before they were quantised to bytes.
struct BoxSample {
  BoxSample(RandomTriangles& random, const Vec3& at, double size_m) {
    // Some boxes are flat in one or two directions.
    const Vec3 extent(size_m * (random.integer(0, 3) == 0 ? 0.0 : random.log_uniform(1e-4, 1.0)),
                      size_m * (random.integer(0, 3) == 0 ? 0.0 : random.log_uniform(1e-4, 1.0)),
                      size_m * random.log_uniform(1e-4, 1.0));
    for (Box& box : boxes) {
      const Vec3 p = at + extent.cwiseProduct(random.in_cube(0.5));
      box = Box(p);
      box.extend(Vec3(at + extent.cwiseProduct(random.in_cube(0.5))));
      if (random.integer(0, 4) == 0) box = Box(p);
      all.extend(box);
    }
    frame = ByteFrame(all);
    for (std::size_t i = 0; i < boxes.size(); ++i) set_box(bytes, i, frame.outside(boxes[i]));
  }

  std::array<Box, kNodeWidth> boxes;
  Box all;
  ByteFrame frame;
  ByteBoxes bytes;
};

/// Returns the bounds between a box, or a body in it, and the boxes of a sample.
BoxGaps gaps_between(const BoxSample& sample, const Box& box, const ObliqueSides* body,
                     double squared_reach_m2) {
  FramedBox framed;
  put_in_frame(sample.frame, BoxSides(box), body, framed);
  BoxGaps gaps;
  box_gaps(framed, sample.bytes, squared_reach_m2, gaps);
  return gaps;
}

struct Place {
  double from_origin_m;
  double size_m;
};
constexpr std::array kPlaces = {Place{0.0, 10.0}, Place{1e6, 10.0},  Place{1.0, 1e-3},
                                Place{1e6, 1e-3}, Place{1e30, 1e28}, Place{1e-30, 1e-32},
                                Place{5.0, 0.0},  Place{1e60, 1e59}};

TEST(ByteFrame, BoxesOfBytesHoldTheBoxesAndLittleMore) {
  RandomTriangles random(531);
  for (const Place& place : kPlaces) {
    for (int i = 0; i < 300; ++i) {
      const BoxSample s(random, place.from_origin_m * random.in_cube(1.0), place.size_m);
      for (std::size_t k = 0; k < s.boxes.size(); ++k) {
        const Box held = s.frame.box_of(get_box(s.bytes, k));
        ASSERT_TRUE(held.contains(s.boxes[k])) << place.from_origin_m << " " << place.size_m;
        for (int axis = 0; axis < 3; ++axis) {
          // A step is at most twice a 254th of the extent; each side moves by one step and by
          // rounding.
          const double step_m =
              s.all.sizes()[axis] * 2.0 / 254.0 + 0x1p-32 * s.all.sizes().maxCoeff() + 0x1p-400;
          const double rounding_m =
              0x1p-49 * s.all.min().cwiseAbs().cwiseMax(s.all.max().cwiseAbs())[axis];
          ASSERT_LE(held.sizes()[axis], s.boxes[k].sizes()[axis] + 2.1 * step_m + rounding_m);
        }
      }
    }
  }
}

TEST(BoxGaps, NeverExceedTheDistanceAndComeCloseToIt) {
  RandomTriangles random(532);
  int compared = 0;
  for (const Place& place : kPlaces) {
    for (int i = 0; i < 500; ++i) {
      const Vec3 at = place.from_origin_m * random.in_cube(1.0);
      const BoxSample s(random, at, place.size_m);
      const double reach_m = (place.size_m + 1e-3) * random.log_uniform(1e-3, 1e6);
      Box box(Vec3(at + reach_m * random.in_cube(1.0)));
      box.extend(Vec3(box.min() + (place.size_m + 1e-3) * random.in_cube(0.3)));
      const double squared_reach_m2 = reach_m * reach_m * random.uniform(0.0, 2.0);
      const BoxGaps gaps = gaps_between(s, box, nullptr, squared_reach_m2);
      for (std::size_t k = 0; k < s.boxes.size(); ++k) {
        const double truth_m2 = geometry::squared_box_distance_m2(s.boxes[k], box);
        const double bound_m2 = static_cast<double>(gaps.squared[k]) * gaps.square_m2;
        ASSERT_LE(bound_m2, truth_m2 * (1.0 + kBoxGapRelativeError + 0x1p-48));
        // A box that is proved to be beyond the reach is.
        const bool is_near = (gaps.near >> k & 1U) != 0;
        ASSERT_TRUE(is_near || truth_m2 > squared_reach_m2);
        ASSERT_TRUE(!is_near || bound_m2 <= squared_reach_m2 * (1.0 + 0x1p-19));
        const double held_m =
            std::sqrt(geometry::squared_box_distance_m2(s.frame.box_of(get_box(s.bytes, k)), box));
        const double step_m = std::sqrt(gaps.square_m2);
        // Beyond 2^60 of the finest steps, which may be 2^-32 of the largest, boxes are not
        // distinguished.
        if (held_m > 0x1p27 * step_m) continue;
        ++compared;
        // Sides are moved outwards by 2^-20 steps, and by 2^-21 of their distance from the frame's
        // origin, which is at most the gap and 255 steps.
        const double moved_m = 0x1p-12 * step_m + 0x1p-48 * place.from_origin_m;
        ASSERT_GE(std::sqrt(bound_m2), held_m * (1.0 - 0x1p-18) - moved_m);
      }
    }
  }
  EXPECT_GT(compared, 10'000);
}

TEST(BoxGaps, CountTouchingAsNoGap) {
  RandomTriangles random(533);
  for (int i = 0; i < 2000; ++i) {
    const BoxSample s(random, random.in_cube(1e3), 1.0);
    for (std::size_t k = 0; k < s.boxes.size(); ++k) {
      // Shares exactly one corner with the box.
      Box corner(s.boxes[k].max());
      corner.extend(Vec3(s.boxes[k].max() + Vec3(1, 1, 1)));
      const BoxGaps gaps = gaps_between(s, corner, nullptr, 0.0);
      ASSERT_EQ(gaps.squared[k], 0.0F);
      ASSERT_NE(gaps.near >> k & 1U, 0U);
    }
  }
}

TEST(BoxGaps, ProveNothingOfWhatIsNotANumber) {
  RandomTriangles random(534);
  const BoxSample s(random, Vec3(1, 2, 3), 1.0);
  const double nan = std::nan("");
  const Box none(Vec3(nan, nan, nan), Vec3(nan, nan, nan));
  EXPECT_EQ(gaps_between(s, none, nullptr, 0.0).near, 0xFFU);
}

TEST(ObliqueGaps, NeverExceedTheDistanceToTheBody) {
  RandomTriangles random(535);
  int improved = 0;
  for (const Place& place : kPlaces) {
    for (int i = 0; i < 500; ++i) {
      const Vec3 at = place.from_origin_m * random.in_cube(1.0);
      const BoxSample s(random, at, place.size_m);
      const double size_m = (place.size_m + 1e-3) * random.log_uniform(1e-3, 1e2);
      const Vec3 p = at + size_m * random.in_cube(3.0);
      const std::array<Triangle, 1> body = {
          Triangle{p, p + size_m * random.in_cube(1.0), p + size_m * random.in_cube(1.0)}};
      const OrientedBox oriented(body);
      const double squared_reach_m2 = size_m * size_m * random.log_uniform(1e-6, 10.0);
      const Box box = geometry::bounds(body[0]);
      const ObliqueSides oblique(oriented);
      const BoxGaps before = gaps_between(s, box, nullptr, squared_reach_m2);
      const BoxGaps gaps = gaps_between(s, box, &oblique, squared_reach_m2);
      ASSERT_EQ(gaps.near & ~before.near, 0U);
      improved += gaps.near != before.near ? 1 : 0;
      for (std::size_t k = 0; k < s.boxes.size(); ++k) {
        // Every point of the box is at least as far as the bound.
        for (int probe = 0; probe < 8; ++probe) {
          const Vec3 q = s.boxes[k].corner(static_cast<Box::CornerType>(probe));
          const Box all = s.all.merged(geometry::bounds(body[0]));
          const double error_m = geometry::triangle_distance_error_m(all.sizes().maxCoeff());
          const double truth_m = geometry::triangle_distance(body[0], {q, q, q}) + 2.0 * error_m;
          ASSERT_LE(static_cast<double>(gaps.squared[k]) * gaps.square_m2,
                    truth_m * truth_m * (1.0 + 2.0 * kBoxGapRelativeError));
          ASSERT_TRUE((gaps.near >> k & 1U) != 0 || truth_m * truth_m > squared_reach_m2);
        }
      }
    }
  }
  EXPECT_GT(improved, 30);
}

}  // namespace
}  // namespace camway::scene
