// SPDX-License-Identifier: MIT
#include "daemon/scene/import/camera_import.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "tests/support/collada_camera.h"
#include "tests/support/temporary_folder.h"

namespace camway::scene {
namespace {

using camway::testing::collada_camera;
using camway::testing::TemporaryFolder;
using geometry::Vec3;
using ::testing::HasSubstr;

TEST(CameraImport, ReadsCamerasThatHangFromNodes) {
  const TemporaryFolder folder;
  const auto cameras = import_cameras(folder.write("a.dae", collada_camera("eye/transform")));
  ASSERT_TRUE(cameras) << cameras.error;
  ASSERT_EQ(cameras->size(), 1U);
  const SceneFileCamera& camera = cameras->front();
  EXPECT_EQ(camera.name, "eye");
  EXPECT_NEAR(*camera.fov_x_rad, std::numbers::pi / 3.0, 1e-6);
  EXPECT_NEAR(*camera.aspect, 1.5, 1e-6);
  ASSERT_EQ(camera.keys.size(), 2U);
  EXPECT_NEAR(camera.keys[1].time_s, 2.0, 1e-6);
  EXPECT_LT((camera.keys[0].position_m - Vec3(0, 5, -1)).norm(), 1e-6);
  EXPECT_LT((camera.keys[1].position_m - Vec3(0, 5, -2)).norm(), 1e-6);
  EXPECT_LT((camera.keys[0].orientation * -Vec3::UnitZ() + Vec3::UnitZ()).norm(), 1e-6);
  EXPECT_LT((camera.keys[1].orientation * -Vec3::UnitZ() + Vec3::UnitX()).norm(), 1e-6);
  EXPECT_LT((camera.keys[1].orientation * Vec3::UnitY() - Vec3::UnitY()).norm(), 1e-6);
}

// assimp would keep one axis of the motion, and lose the others without a word.
TEST(CameraImport, RefusesChannelsOfSingleAxes) {
  const TemporaryFolder folder;
  for (const char* const target : {"eye/location.X", "eye/transform(3)(0)"}) {
    EXPECT_THAT(import_cameras(folder.write("a.dae", collada_camera(target))).error,
                HasSubstr("a.dae: cannot be read: its animation has channels for single axes"));
  }
}

TEST(CameraImport, SaysWhatIsMissing) {
  const TemporaryFolder folder;
  std::string nameless = collada_camera("eye/transform");
  nameless.replace(nameless.find(" name=\"lens\""), 12, "");
  const auto cameras = import_cameras(folder.write("a.dae", nameless));
  ASSERT_TRUE(cameras) << cameras.error;
  EXPECT_EQ(cameras->front().fov_x_rad, std::nullopt) << "assimp reads no camera without a name";
  EXPECT_EQ(cameras->front().aspect, std::nullopt);
  EXPECT_THAT(
      import_cameras(folder.write("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")).error,
      HasSubstr("has no camera"));
  EXPECT_THAT(import_cameras("nowhere.fbx").error, HasSubstr("there is no such file"));
  EXPECT_THAT(import_cameras(folder.write("a.usd", "x")).error, HasSubstr("USD is not supported"));
}

TEST(CameraImport, TrustsNothingThatTheProcessSays) {
  const std::string good = "camera one two\nlens 1 0 0.5\ntakes 2\nkey 0 1 2 3 1 0 0 0\n";
  const auto cameras = cameras_from(good, 0.5);
  ASSERT_TRUE(cameras) << cameras.error;
  EXPECT_EQ(cameras->front().name, "one two");
  EXPECT_EQ(cameras->front().aspect, std::nullopt);
  EXPECT_EQ(*cameras->front().near_m, 0.25);
  EXPECT_EQ(cameras->front().takes, 2);
  EXPECT_EQ(cameras->front().keys[0].position_m, Vec3(0.5, 1, 1.5));
  for (const char* const bad :
       {"key 0 1 2 3 1 0 0 0\n", "camera a\nkey 0 1 2\n", "camera a\nkey 0 1 2 nan 1 0 0 0\n",
        "camera a\ntakes -1\n", "camera a\ntakes 1e300\n", "camera a\nlens 1 2 3 4\n",
        "camera a\nwhat\n", "camera a\nkey 0 1 2 3 1 0 0 0 9\n"}) {
    EXPECT_THAT(cameras_from(bad, 1.0).error, HasSubstr("its cameras are wrong in line")) << bad;
  }
}

}  // namespace
}  // namespace camway::scene
