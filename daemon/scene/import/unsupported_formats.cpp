// SPDX-License-Identifier: MIT
#include "daemon/scene/import/unsupported_formats.h"

#include <algorithm>
#include <array>
#include <string>

namespace camway::scene {
namespace {

struct Unsupported {
  std::string_view extension;
  std::string_view why;
};

constexpr std::string_view kUsd = "USD is not supported: export glTF from the same program";
constexpr std::string_view kSplat =
    "Gaussian splats are no surface: export their voxels (.voxel.json) or their collision mesh "
    "(.collision.glb)";

constexpr std::array<Unsupported, 13> kUnsupported = {{
    {".usd", kUsd},
    {".usda", kUsd},
    {".usdc", kUsd},
    {".usdz", kUsd},
    {".laz",
     "compressed LAS is not supported: make .las of it, with laszip, las2las or CloudCompare"},
    {".e57", "E57 is not supported: save the points as .las, .pcd or .xyz, as CloudCompare does"},
    {".splat", kSplat},
    {".spz", kSplat},
    {".sog", kSplat},
    {".x3dv", "X3D in the classic encoding is not supported: write it as VRML 97 or .x3d"},
    {".max", "3ds Max scenes are read by 3ds Max alone: export FBX or glTF"},
    {".ma", "Maya scenes are read by Maya alone: export FBX or glTF"},
    {".mb", "Maya scenes are read by Maya alone: export FBX or glTF"},
}};

}  // namespace

std::string_view why_unsupported(std::string_view extension) {
  std::string lower(extension);
  std::ranges::transform(lower, lower.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  const auto found = std::ranges::find(kUnsupported, lower, &Unsupported::extension);
  return found == kUnsupported.end() ? std::string_view() : found->why;
}

}  // namespace camway::scene
