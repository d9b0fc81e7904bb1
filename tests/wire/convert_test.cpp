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

/// Structs that have optional members where messages have flags, and a struct where they have
/// several members.
struct Limits {
  std::array<std::optional<double>, 3> min_m{};
  std::array<std::optional<double>, 3> max_m{};
};
struct Witness {
  double time_s = 0.0;
  std::string object;
  std::int32_t triangle = 0;
  std::string feature;
  double depth_m = 0.0;
  std::array<double, 3> point_m{};
};
struct Interval {
  double t_begin_s = 0.0;
  double t_end_s = 0.0;
  std::optional<Witness> witness;
};

TEST(WireTypes, AFlagSaysWhetherAnOptionalMemberIsSet) {
  bounds_t wire{};
  Io{}(Limits{{std::nullopt, 0.0, 2.0}, {}}, wire);
  EXPECT_EQ(wire.has_min[0] + wire.has_max[0], 0);
  EXPECT_EQ(wire.has_min[1] + wire.has_min[2], 2);
  EXPECT_EQ(wire.min_m[2], 2.0);
  wire.max_m[0] = 5.0;
  Limits back;
  Io{}(wire, back);
  EXPECT_EQ(back.min_m[1], 0.0);
  EXPECT_FALSE(back.min_m[0] || back.max_m[0]);
}

TEST(WireTypes, MembersOfOnePrefixAreAStruct) {
  collision_interval_t wire{};
  Io{}(Interval{1.0, 2.0, std::nullopt}, wire);
  EXPECT_EQ(wire.has_witness, 0);
  Io{}(Interval{1.0, 2.0, Witness{1.5, "chair", 7, "edge 2", 0.25, {3, 4, 5}}}, wire);
  EXPECT_EQ(wire.has_witness, 1);
  EXPECT_EQ(wire.witness_point_m[2], 5.0);
  Interval back;
  Io{}(wire, back);
  ASSERT_TRUE(back.witness);
  EXPECT_EQ(back.witness->object, "chair");
  wire.has_witness = 0;
  Interval without;
  Io{}(wire, without);
  EXPECT_FALSE(without.witness);
}

TEST(WireTypes, AMemberThatCountsNotIsFound) {
  plan_request_t request{};
  std::vector<std::optional<std::string>> found;
  const auto note = [&](const auto& member, const auto& flag) {
    found.push_back(path_of(&member, sizeof member, request));
    found.push_back(path_of(&flag, sizeof flag, request));
  };
  request.bounds.has_max[1] = 1;
  request.bounds.max_m[1] = 4.0;
  visit_unmarked(request, note);
  EXPECT_TRUE(found.empty());
  request.bounds.max_m[2] = 4.0;
  request.frame.begin.velocity_m_per_s[0] = 1.0;
  visit_unmarked(request, note);
  EXPECT_EQ(found, (std::vector<std::optional<std::string>>{"frame", "has_frame", "bounds.max_m[2]",
                                                            "bounds.has_max[2]"}));
}

TEST(WireTypes, EveryPartOfAMessageHasAPath) {
  plan_request_t request{};
  request.keyframes.resize(3);
  request.body.points_m = {{1, 2, 3}, {4, 5, 6}};
  const auto path = [&](const auto& part) { return path_of(&part, sizeof part, request); };
  EXPECT_EQ(path(request.seed), "seed");
  EXPECT_EQ(path(request.orientation), "orientation");
  EXPECT_EQ(path(request.orientation.policy), "orientation.policy");
  EXPECT_EQ(path(request.keyframes[2].position_m[1]), "keyframes[2].position_m[1]");
  EXPECT_EQ(path(request.body.points_m[1]), "body.points_m[1]");
  EXPECT_EQ(path(request.body.points_m[1][2]), "body.points_m[1][2]");
  EXPECT_EQ(path(request), "");
  EXPECT_EQ(path(double{}), std::nullopt);
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
