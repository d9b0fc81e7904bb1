// SPDX-License-Identifier: MIT
#include "tools/answers/check_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tools/camway/replay/log_builder.h"

namespace camway::tools {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(CheckReport, SaysWhereOnTheBodyAContactIs) {
  EXPECT_EQ(at_feature("inside"), "inside the near quadrilateral");
  EXPECT_EQ(at_feature("edge 2"), "at edge 2");
  EXPECT_EQ(at_feature("corner 0"), "at corner 0");
  EXPECT_EQ(at_feature("face 7"), "at face 7");
  EXPECT_EQ(at_feature("surface"), "at the surface");
}

std::vector<std::string> warnings_of(const motion::BodyShape& shape, double tolerance_m,
                                     bool collides) {
  CheckInput input;
  input.body = *motion::Body::make(shape);
  input.request.options.interval_tolerance_m = tolerance_m;
  input.snapshot = scene::make_snapshot("wall", wall_mesh()).snapshot;
  PathSearch search;
  if (collides) search.collisions = {{1.0, 2.0}};
  return check_warnings(input, search);
}

TEST(CheckReport, HintsAtTheToleranceOfASmallBody) {
  const motion::Camera pinhole{1.2, 0.9, 0.001};  // near quadrilateral of 1.4 x 1 mm
  const motion::Camera usual{1.2, 0.9, 0.1};
  EXPECT_THAT(warnings_of(pinhole, 1e-3, true),
              ElementsAre(HasSubstr("lower options.interval_tolerance_m to about 1e-05")));
  EXPECT_THAT(warnings_of(motion::SphereShape{{0, 0, 0}, 0.002}, 1e-3, true),
              ElementsAre(HasSubstr("the body is only 0.004 m large")));
  EXPECT_THAT(warnings_of(pinhole, 1e-3, false), IsEmpty()) << "free is free";
  EXPECT_THAT(warnings_of(pinhole, 1e-5, true), IsEmpty());
  EXPECT_THAT(warnings_of(usual, 1e-3, true), IsEmpty());
}

TEST(CheckReport, ListsWhatWasFoundWhenTimeRanOut) {
  CheckInput input;
  input.body = motion::Body{motion::Camera{1.2, 0.9, 0.1}};
  input.snapshot = scene::make_snapshot("wall", wall_mesh()).snapshot;
  motion::Segment segment{0.0, 8.0, {}, {}};
  segment.position.fill(geometry::Vec3::Zero());
  segment.orientation.fill(geometry::Vec4::UnitX());
  input.path = motion::Path({segment});
  PathSearch search;
  search.searched_until_s = 3.5;
  search.collisions = {{1.0, 2.0}};
  EXPECT_EQ(check_text(input, search),
            "collides from 1.000000 to 2.000000 s with what could not be told apart\n"
            "time ran out: nothing is known from 3.500000 to 8.000000 s\n"
            "keyframes met: not known, neither request nor response says when\n");
  const nlohmann::ordered_json json = check_json(input, search);
  EXPECT_EQ(json["verdict"], "timeout");
  EXPECT_EQ(json["certified"], false);
  EXPECT_EQ(json["searched_until"], 3.5);
  ASSERT_EQ(json["collisions"].size(), 1U);
  EXPECT_EQ(json["collisions"][0]["t_end"], 2.0);
}

}  // namespace
}  // namespace camway::tools
