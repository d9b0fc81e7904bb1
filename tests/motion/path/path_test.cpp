// SPDX-License-Identifier: MIT
#include "daemon/motion/path/path.h"

#include "tests/motion/random_motion.h"

namespace camway::motion {
namespace {

using testing::Random;

Path path_of(Random& random, int segments) {
  std::vector<Segment> parts;
  for (int i = 0; i < segments; ++i) {
    Segment segment = test::random_segment(random, 0.3);
    segment.t0_s = i == 0 ? -2.5 : parts.back().t1_s;
    segment.t1_s = segment.t0_s + random.uniform(0.1, 2.0);
    parts.push_back(segment);
  }
  return Path(parts);
}

TEST(Path, IsEmptyByDefault) { EXPECT_TRUE(Path().empty()); }

TEST(Path, FindsTheSegmentOfEveryTime) {
  Random random(21);
  const Path path = path_of(random, 17);
  const std::span<const Segment> segments = path.segments();
  EXPECT_EQ(path.begin_s(), -2.5);
  EXPECT_EQ(path.end_s(), segments.back().t1_s);
  EXPECT_EQ(path.segment_index(-1e9), 0U);
  EXPECT_EQ(path.segment_index(1e9), 16U);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    EXPECT_EQ(path.segment_index(segments[i].t0_s), i) << "a join belongs to the later segment";
    EXPECT_EQ(path.segment_index(segment_time_s(segments[i], 0.5)), i);
  }
  EXPECT_EQ(path.segment_index(path.end_s()), 16U);
}

TEST(Path, PoseIsThatOfTheSegmentAndIsClamped) {
  Random random(22);
  const Path path = path_of(random, 5);
  for (const Segment& segment : path.segments()) {
    const double time_s = segment_time_s(segment, 0.3);
    const Pose expected = pose_at(segment, segment_parameter(segment, time_s));
    EXPECT_EQ(path.pose(time_s).position, expected.position);
    EXPECT_EQ(path.pose(time_s).orientation.coeffs(), expected.orientation.coeffs());
  }
  EXPECT_EQ(path.pose(path.begin_s() - 7.0).position, path.segments().front().position[0]);
  EXPECT_EQ(path.pose(path.end_s() + 7.0).position, path.segments().back().position[3]);
}

}  // namespace
}  // namespace camway::motion
