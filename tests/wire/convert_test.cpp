// SPDX-License-Identifier: MIT
#include "lcmtypes/wire/convert.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace camway::wire {
namespace {

struct Io {
  template <class From, class To>
  void operator()(const From& from, To& to) const {
    convert(*this, from, to);
  }
};

/// A struct with the members of segment_t.
struct Segment {
  double t0_s = 0.0;
  double t1_s = 0.0;
  std::array<std::array<double, 3>, 4> position_m{};
  std::array<std::array<double, 4>, 7> orientation_wxyz{};
  bool operator==(const Segment&) const = default;
};

TEST(WireTypes, StructsOfEqualNamesSurviveTheWayThereAndBack) {
  std::vector<Segment> segments(2);
  double next = 1.0;
  for (Segment& segment : segments) {
    segment.t0_s = next++;
    segment.t1_s = next++;
    for (auto& point : segment.position_m) point.fill(next++);
    for (auto& quaternion : segment.orientation_wxyz) quaternion.fill(next++);
  }
  std::vector<segment_t> wire;
  Io{}(segments, wire);
  ASSERT_EQ(wire.size(), 2U);
  EXPECT_EQ(wire[1].position_m[3][2], segments[1].position_m[3][2]);
  std::vector<Segment> back;
  Io{}(wire, back);
  EXPECT_EQ(back, segments);
}

TEST(WireTypes, ListsAreAppendedTo) {
  std::vector<std::vector<std::int32_t>> wire = {{1, 2, 3}};
  Io{}(std::vector<std::array<std::uint32_t, 3>>{{4, 5, 6}}, wire);
  EXPECT_EQ(wire, (std::vector<std::vector<std::int32_t>>{{1, 2, 3}, {4, 5, 6}}));
}

TEST(WireTypes, AnEmptyOptionalIsNotWritten) {
  double wire = 0.0;
  Io{}(std::optional<double>(), wire);
  EXPECT_EQ(wire, 0.0);
  Io{}(std::optional<double>(2.5), wire);
  EXPECT_EQ(wire, 2.5);
  std::optional<Segment> segment;
  Io{}(segment_t{}, segment);
  EXPECT_TRUE(segment);
}

TEST(WireTypes, AMessageIsBlankAsLongAsNothingIsSet) {
  plan_request_t request{};
  EXPECT_TRUE(is_blank(request));
  request.max_shrink = -0.0;
  EXPECT_TRUE(is_blank(request));
  request.frame.end.image_rate_per_s[3] = std::nan("");
  EXPECT_FALSE(is_blank(request.frame));
  EXPECT_FALSE(is_blank(request));
  body_t body{};
  body.points_m = {{0, 0, 0}};
  EXPECT_FALSE(is_blank(body));
  EXPECT_FALSE(is_blank(std::string("a")));
}

}  // namespace
}  // namespace camway::wire
