// SPDX-License-Identifier: MIT
#include "daemon/process/settings/scene_argument.h"

#include <gtest/gtest.h>

namespace camway::process {
namespace {

SceneArgument parsed(std::string_view text) {
  base::Result<SceneArgument> result = parse_scene_argument(text);
  EXPECT_TRUE(result) << result.error;
  return result.value.value_or(SceneArgument{});
}

TEST(SceneArgument, NameAndFile) {
  const SceneArgument scene = parsed("office=scenes/office.obj");
  EXPECT_EQ(scene.name, "office");
  EXPECT_EQ(scene.file, "scenes/office.obj");
  EXPECT_EQ(scene.options.import.scale, 1.0);
  EXPECT_EQ(scene.options.import.up, scene::UpAxis::kAsInFile);
  EXPECT_FALSE(scene.options.occupancy_resolution_m);
}

TEST(SceneArgument, OptionsInAnyOrder) {
  for (const char* text : {"a=b.off,scale=0.0254,up=z-to-y,occupancy=0.1",
                           "a=b.off,occupancy=0.1,up=z-to-y,scale=0.0254"}) {
    const SceneArgument scene = parsed(text);
    EXPECT_EQ(scene.file, "b.off");
    EXPECT_EQ(scene.options.import.scale, 0.0254);
    EXPECT_EQ(scene.options.import.up, scene::UpAxis::kZToY);
    EXPECT_EQ(scene.options.occupancy_resolution_m, 0.1);
  }
  EXPECT_FALSE(parsed("a=b").watch);
  EXPECT_FALSE(parsed("a=b,watch=no").watch);
  EXPECT_TRUE(parsed("a=b,watch=yes,scale=2").watch);
  EXPECT_EQ(parsed("a=b.las,voxel_m=0.02,scale=2").options.import.voxel_m, 0.02);
  EXPECT_FALSE(parsed("a=b.las,occupancy=0.1").options.import.voxel_m);
  EXPECT_EQ(parsed("a=b,up=y-to-z").options.import.up, scene::UpAxis::kYToZ);
  const geometry::Bounds bounds = parsed("a=b,bounds=-3..3.5/0../..,scale=2").options.bounds;
  EXPECT_EQ(bounds.min_W.head<2>(), Eigen::Vector2d(-3, 0));
  EXPECT_EQ(bounds.max_W.x(), 3.5);
  EXPECT_FALSE(bounds.max_W.tail<2>().allFinite());
}

TEST(SceneArgument, FilesMayHoldCommasAndEqualSigns) {
  EXPECT_EQ(parsed("a=x, y/b.obj,scale=2").file, "x, y/b.obj");
  EXPECT_EQ(parsed("a=x=1/b.obj").file, "x=1/b.obj");
}

TEST(SceneArgument, ErrorsQuoteTheTextAndSayWhatIsWrong) {
  const std::vector<std::pair<std::string, std::string>> table{
      {"office.obj", "must be NAME=FILE"},
      {"=office.obj", "the name must be"},
      {"a b=office.obj", "the name must be"},
      {std::string(129, 'n') + "=office.obj", "the name must be"},
      {"a=", "the file is missing"},
      {"a=,scale=2", "the file is missing"},
      {"a=b,scale=0", "scale=0: must be a number above 0"},
      {"a=b,scale=-2", "must be a number above 0"},
      {"a=b,scale=inf", "must be a number above 0"},
      {"a=b,scale=2x", "must be a number above 0"},
      {"a=b,occupancy=", "occupancy=: must be a number above 0"},
      {"a=b,occupancy=1e10", "occupancy=1e10: must be from 1e-9 to 1e9 m"},
      {"a=b,up=x-to-y", "up=x-to-y: must be as-in-file, z-to-y or y-to-z"},
      {"a=b,watch=maybe", "watch=maybe: must be yes or no"},
      {"a=b,bounds=0..1", "bounds '0..1': must be X0..X1/Y0..Y1/Z0..Z1"},
      {"a=b,ocupancy=0.1", "'ocupancy' is no option"},
  };
  for (const auto& [text, reason] : table) {
    const base::Result<SceneArgument> result = parse_scene_argument(text);
    EXPECT_FALSE(result) << text;
    EXPECT_NE(result.error.find("scene '" + text + "': "), std::string::npos) << result.error;
    EXPECT_NE(result.error.find(reason), std::string::npos) << result.error;
  }
}

}  // namespace
}  // namespace camway::process
