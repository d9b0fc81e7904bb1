// SPDX-License-Identifier: MIT
#include "tools/drawing/floor_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>

#include "daemon/motion/spline/interpolate.h"
#include "tests/support/scenes.h"
#include "tests/tools/drawing/drawn_house.h"
#include "tools/drawing/side_by_side.h"

namespace camway::draw {
namespace {

namespace fs = std::filesystem;
using geometry::Vec3;

double area_of(const SectionLine& line) {
  double twice = 0.0;
  for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
    const PlanPoint& a = line.points[i];
    const PlanPoint& b = line.points[i + 1];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return std::abs(twice) / 2.0;
}

TEST(FloorSection, CutsWallsAndKeepsWhatIsLower) {
  const FloorSection section = cut_floor(small_house(), SceneUp::kY, 1.5);
  EXPECT_EQ(section.floor_m, 0.0);
  ASSERT_EQ(section.cut.size(), 1U) << "the wall alone";
  ASSERT_EQ(section.cut[0].size(), 1U);
  EXPECT_TRUE(section.cut[0][0].closed);
  EXPECT_NEAR(area_of(section.cut[0][0]), 0.2 * 2.5, 1e-12);
  EXPECT_EQ(section.tops.size(), 2U) << "the table's top; its underside is on the floor";
  // A box without the edges of its underside, which borders on the floor and is left out: four
  // edges of the top, four vertical ones that are points on paper, and four at the borders of the
  // bottom.
  EXPECT_EQ(section.outlines.size(), 8U);
}

/// The picture is the same for either axis if the scene is rotated accordingly.
TEST(FloorSection, UpAxisIsOnlyAMatterOfNames) {
  const FloorSection y = cut_floor(small_house(), SceneUp::kY, 1.5);
  const FloorSection z = cut_floor(turned_to_z_up(small_house()), SceneUp::kZ, 1.5);
  EXPECT_EQ(y.floor_m, z.floor_m);
  ASSERT_EQ(z.cut.size(), y.cut.size());
  EXPECT_EQ(area_of(z.cut[0][0]), area_of(y.cut[0][0]));
  EXPECT_EQ(z.outlines.size(), y.outlines.size());
  EXPECT_EQ(to_plan({1, 5, 2}, SceneUp::kY), PlanPoint(1, 2));
  EXPECT_EQ(to_plan({1, -2, 5}, SceneUp::kZ), PlanPoint(1, 2));
}

/// An opening makes two loops of one object, or one with a hole.
TEST(FloorSection, LoopsAreClosedWhereSolidsAre) {
  scene::Mesh mesh = small_house();
  for (const double height_m : {0.35, 0.7, 1.0, 2.79}) {
    for (const std::vector<SectionLine>& object : cut_floor(mesh, SceneUp::kY, height_m).cut) {
      for (const SectionLine& line : object) EXPECT_TRUE(line.closed) << height_m;
    }
  }
  mesh.triangles.pop_back();  // and an open mesh does not pretend
  mesh.objects.back().triangle_count = 11;
  bool open = false;
  for (const std::vector<SectionLine>& object : cut_floor(mesh, SceneUp::kY, 0.35).cut) {
    for (const SectionLine& line : object) open |= !line.closed;
  }
  EXPECT_TRUE(open);
}

motion::Keyframe keyframe(double time_s, const Vec3& position, motion::KeyframeOrigin origin) {
  const geometry::Quat east(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitY()));
  return {time_s, {position, east}, origin};
}

FloorPlan through_the_wall() {
  using enum motion::KeyframeOrigin;
  FloorPlan plan;
  plan.title = "test";
  plan.mesh = small_house();
  plan.corners_C = motion::near_corners_C({1.2, 0.9, 0.2});
  const std::vector<motion::Keyframe> given{keyframe(0, {1, 1.5, 2}, kGiven),
                                            keyframe(2, {5.4, 1.5, 2.4}, kGiven)};
  plan.keyframes = {given[0], keyframe(1, {3.1, 1.5, 3.2}, kInserted), given[1]};
  plan.before = sample(motion::interpolate(given), 300);
  plan.after = sample(motion::interpolate(plan.keyframes), 300);
  plan.collisions = {{0.9, 1.1}};
  return plan;
}

// The room and its column are one object, whose outlines alone would make a solid with a hole.
TEST(FloorSection, AnOutlineAboutAllKeyframesIsARoom) {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-5, 0, -5}, {5, 3, 5});
  testing::add_cuboid(mesh, {0, 0, 0}, {1, 3, 1});
  const FloorSection cut = cut_floor(mesh, SceneUp::kY, 1.5);
  ASSERT_EQ(cut.cut.size(), 1U);
  ASSERT_EQ(cut.cut[0].size(), 2U);
  const auto closed_areas = [&](const std::vector<PlanPoint>& places) {
    FloorSection section = cut;
    open_room_about(places, section);
    std::vector<double> areas_m2;
    for (const SectionLine& line : section.cut[0]) {
      if (line.closed) areas_m2.push_back(std::round(area_of(line)));
    }
    std::ranges::sort(areas_m2);
    return areas_m2;
  };
  EXPECT_EQ(closed_areas({{-2, -2}, {3, 3}}), (std::vector<double>{1}));
  EXPECT_EQ(closed_areas({{-2, -2}, {8, 3}}), (std::vector<double>{1, 100})) << "one is outside";
  EXPECT_EQ(closed_areas({}), (std::vector<double>{1, 100}));
}

TEST(FloorSection, WallsWithAThicknessStaySolid) {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-5, 0, -5}, {5, 3, 5});
  testing::add_cuboid(mesh, {-4.8, 0.2, -4.8}, {4.8, 2.8, 4.8});
  FloorSection section = cut_floor(mesh, SceneUp::kY, 1.5);
  open_room_about(std::vector<PlanPoint>{{0, 0}, {1, 1}}, section);
  for (const SectionLine& line : section.cut.at(0)) EXPECT_TRUE(line.closed);
}

TEST(FloorPlan, HeightIsTheKeyframesAndAvoidsFloors) {
  using enum motion::KeyframeOrigin;
  const scene::Mesh house = small_house();
  const auto cut = [&](const std::vector<double>& heights) {
    std::vector<motion::Keyframe> keyframes;
    for (const double h : heights) keyframes.push_back(keyframe(0, {1, h, 1}, kGiven));
    return cut_height_m(house, SceneUp::kY, keyframes);
  };
  EXPECT_EQ(cut({1.4, 1.6, 1.7}), 1.6);
  EXPECT_EQ(cut({1.5, 2.9, 4.6}), 1.5) << "2.9 is inside the slab";
  EXPECT_EQ(cut({}), 0.0);
}

std::string contents(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value = value << 8U | static_cast<unsigned char>(bytes.at(at + i));
  return value;
}

TEST(FloorPlan, WritesBothFiles) {
  const PictureFiles files{fs::path(::testing::TempDir()) / "floor_plan_test.svg",
                           fs::path(::testing::TempDir()) / "floor_plan_test.png"};
  ASSERT_EQ(draw_floor_plan(through_the_wall(), files), "");
  const std::string png = contents(files.png);
  ASSERT_GT(png.size(), 1000U);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(big_endian(png, 16), 2000U) << "two pixels for each of the picture";
  EXPECT_GT(big_endian(png, 20), 500U);
  const std::string svg = contents(files.svg);
  EXPECT_THAT(svg, ::testing::HasSubstr("<svg"));
  EXPECT_THAT(svg, ::testing::HasSubstr("</svg>"));
}

/// Returns the number of strokes in the collision colour in the SVG.
std::size_t collision_strokes(const FloorPlan& plan) {
  const fs::path file = fs::path(::testing::TempDir()) / "floor_plan_count.svg";
  EXPECT_EQ(draw_floor_plan(plan, {file, {}}), "");
  const std::string svg = contents(file);
  std::size_t count = 0;
  for (std::size_t at = 0;
       (at = svg.find("rgb(83.529412%,36.862745%,0%)", at)) != std::string::npos; ++at)
    ++count;
  return count;
}

/// Each interval adds a bold line, two quadrilaterals and a mark.
TEST(FloorPlan, ShowsEveryCollision) {
  FloorPlan plan = through_the_wall();
  plan.collisions.clear();
  const std::size_t legend = collision_strokes(plan);
  EXPECT_GT(legend, 0U);
  plan.collisions = {{0.9, 1.1}};
  const std::size_t one = collision_strokes(plan);
  plan.collisions = {{0.9, 1.1}, {1.2, 1.21}};
  const std::size_t two = collision_strokes(plan);
  EXPECT_GE(one, legend + 4);
  EXPECT_GE(two, one + 4);
}

TEST(FloorPlan, SurvivesAlmostNothing) {
  const PictureFiles files{fs::path(::testing::TempDir()) / "floor_plan_empty.svg", {}};
  EXPECT_EQ(draw_floor_plan({}, files), "");
  FloorPlan only_keyframe;
  only_keyframe.keyframes = {keyframe(0, {0, 0, 0}, motion::KeyframeOrigin::kGiven)};
  only_keyframe.collisions = {{0.0, 1.0}};  // without a path to show them on
  EXPECT_EQ(draw_floor_plan(only_keyframe, files), "");
}

/// Collisions are drawn on the left, and without a path there is nothing to draw.
TEST(FloorPlan, TwoPlansSideBySide) {
  const PictureFiles files{fs::path(::testing::TempDir()) / "floor_plan_two.svg",
                           fs::path(::testing::TempDir()) / "floor_plan_two.png"};
  ASSERT_EQ(draw_side_by_side(through_the_wall(), files), "");
  EXPECT_EQ(big_endian(contents(files.png), 16), 1840U);
  EXPECT_THAT(contents(files.svg), ::testing::HasSubstr("rgb(83.529412%,36.862745%,0%)"));
  EXPECT_EQ(draw_side_by_side({}, files), "");
}

TEST(FloorPlan, FailureNamesTheFile) {
  EXPECT_THAT(draw_floor_plan(through_the_wall(), {"/nonexistent/plan.svg", {}}),
              ::testing::HasSubstr("/nonexistent/plan.svg"));
  EXPECT_THAT(draw_floor_plan(through_the_wall(), {{}, "/nonexistent/plan.png"}),
              ::testing::HasSubstr("/nonexistent/plan.png"));
}

TEST(FloorPlan, SamplesIncludeBothEnds) {
  const std::vector<motion::Keyframe> keyframes{
      keyframe(1, {0, 0, 0}, motion::KeyframeOrigin::kGiven),
      keyframe(3, {1, 0, 0}, motion::KeyframeOrigin::kGiven)};
  const SampledPath samples = sample(motion::interpolate(keyframes), 5);
  ASSERT_EQ(samples.size(), 5U);
  EXPECT_EQ(samples.front().time_s, 1.0);
  EXPECT_EQ(samples.back().time_s, 3.0);
  EXPECT_EQ(samples.back().pose.position, Vec3(1, 0, 0));
}

}  // namespace
}  // namespace camway::draw
