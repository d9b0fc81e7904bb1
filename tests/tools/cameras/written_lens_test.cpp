// SPDX-License-Identifier: MIT
#include "tools/cameras/export/written_lens.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "tests/tools/cameras/formats/read_format.h"
#include "tests/tools/cameras/random_track.h"

namespace camway::tools {
namespace {

using testing::Files;
using ::testing::HasSubstr;
using testing::kDegree;
using testing::Random;
using testing::sound;

constexpr std::uint64_t kLensSeed = 20261128;
constexpr double kRelative = 1e-6;

/// A lens and a picture, which need not fit each other.
CameraWriteOptions random_options(Random& random) {
  CameraWriteOptions options;
  options.fov_x_rad = random.uniform(5.0, 170.0) * kDegree;
  options.fov_y_rad = random.uniform(5.0, 170.0) * kDegree;
  options.width_px = options.facts.width_px = random.integer(400, 4000);
  if (random.chance(0.5)) options.facts.height_px = random.integer(400, 4000);
  return options;
}

CameraTrack read_back(const CameraFormat& format, const CameraTrack& track,
                      const CameraWriteOptions& options) {
  const auto text = format.write(track, options);
  if (!text) return {};
  Files others;
  if (format.companion != nullptr) {
    const CompanionFile companion = format.companion(options);
    others[companion.name] = companion.text;
  }
  return sound(format.name, *text, {}, others);
}

TEST(WrittenLens, IsThatOfThePathOrIsSaid) {
  Random random(kLensSeed);
  constexpr int kTrials = 200;
  CameraTrack track = random_track(random, 2, 0.25, 1.0);
  track.fps = 4.0;
  for (const CameraFormat& format : camera_formats()) {
    if (format.write == nullptr) continue;
    SCOPED_TRACE(format.name);
    int silent = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      const CameraWriteOptions options = random_options(random);
      const CameraTrack read = read_back(format, track, options);
      // Blender refuses a pixel that is too long.
      if (read.keys.empty() && format.name == "blender") continue;
      const auto fov_y_rad = widest_fov_y_rad(read);
      auto fov_x_rad = widest_fov_x_rad(read);
      if (!fov_x_rad && fov_y_rad && read.aspect) {
        fov_x_rad = fov_across_rad(*fov_y_rad, *read.aspect);
      }
      const WrittenLens lens = written_lens(read, format, options);
      EXPECT_EQ(lens.fault, "");
      if (fov_x_rad) {
        EXPECT_LE(*fov_x_rad, options.fov_x_rad * (1.0 + kRelative));
      }
      if (fov_y_rad) {
        EXPECT_LE(*fov_y_rad, options.fov_y_rad * (1.0 + kRelative));
      }
      if (!lens.remark.empty()) continue;
      ++silent;
      ASSERT_TRUE(fov_x_rad && fov_y_rad);
      EXPECT_NEAR(*fov_x_rad / options.fov_x_rad, 1.0, kRelative);
      EXPECT_NEAR(*fov_y_rad / options.fov_y_rad, 1.0, kRelative);
    }
    const bool holds_any = format.name != "nerfstudio" && format.name != "chan" &&
                           format.name != "tum" && format.name != "kitti";
    EXPECT_EQ(silent > kTrials / 2, holds_any) << silent;
  }
}

TEST(WrittenLens, OfSquarePixelsIsExactWhereTheyFit) {
  CameraTrack track;
  track.fps = 4.0;
  track.keys = {{0.0, {}, std::nullopt}, {0.25, {}, std::nullopt}};
  CameraWriteOptions options;
  options.fov_y_rad = 1.0;
  options.fov_x_rad = fov_across_rad(1.0, 16.0 / 9.0);
  options.facts.height_px = 1080;
  const CameraFormat& nerfstudio = *camera_format("nerfstudio");
  EXPECT_EQ(written_lens(read_back(nerfstudio, track, options), nerfstudio, options).remark, "");
}

TEST(WrittenLens, IsRefusedWhereItShowsMore) {
  CameraWriteOptions options;
  options.fov_x_rad = 80.0 * kDegree;
  options.fov_y_rad = 60.0 * kDegree;
  CameraTrack read;
  read.fov_y_rad = options.fov_y_rad;
  read.aspect = 16.0 / 9.0;
  EXPECT_THAT(written_lens(read, *camera_format("gltf"), options).fault,
              HasSubstr("would show 91.4"));
}

}  // namespace
}  // namespace camway::tools
