// SPDX-License-Identifier: MIT
#include <string>

#include "tests/fuzz/targets.h"
#include "tools/cameras/formats/camera_format.h"
#include "tools/cameras/played_path.h"

namespace camway::testing {
namespace {

/// The first byte selects the format of the others.
bool exercise_camera_file(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return false;
  const auto formats = tools::camera_formats();
  const tools::CameraFormat& format = formats[bytes[0] % formats.size()];
  const tools::CameraFile file{"fuzzed", std::string(as_text(bytes.subspan(1))),
                               [](const std::string&) -> base::Result<std::string> {
                                 return std::string("1 PINHOLE 100 50 50 25 50 25\n");
                               }};
  const auto track = tools::read_camera(format, file, {});
  promise(static_cast<bool>(track) == track.error.empty(), "a track or a reason");
  promise(track || track.error.starts_with("fuzzed"), "the reason names the file");
  if (!track) return false;
  promise(tools::fault_of(*track).empty(), "a track has no fault");
  if (track->keys.size() >= 2 && track->keys.size() < 1000) {
    promise(!tools::played_path(*track).path.empty(), "a track of two keys is played");
  }
  return true;
}

/// A file of each format as Camway writes it.
std::vector<FuzzBytes> camera_seeds() {
  tools::CameraTrack track;
  track.fps = 10.0;
  for (int i = 0; i < 3; ++i) {
    track.keys.push_back(
        {0.1 * i,
         {geometry::Vec3(i, 1.5, -0.25 * i), geometry::Quat(1.0, 0.1 * i, 0.2, 0.0).normalized()},
         std::nullopt});
  }
  std::vector<FuzzBytes> seeds;
  const auto formats = tools::camera_formats();
  for (std::size_t i = 0; i < formats.size(); ++i) {
    if (formats[i].write == nullptr) continue;
    const auto text = formats[i].write(track, {"camera", 1.2, 0.8, 0.1, 100});
    FuzzBytes bytes = fuzz_bytes(*text);
    bytes.insert(bytes.begin(), static_cast<std::uint8_t>(i));
    seeds.push_back(std::move(bytes));
  }
  seeds.push_back({0});
  return seeds;
}

}  // namespace

constinit const FuzzTarget kCameraFileTarget{"camera_file", exercise_camera_file, camera_seeds,
                                             20'000};

}  // namespace camway::testing
