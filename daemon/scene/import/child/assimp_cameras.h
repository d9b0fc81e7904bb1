// SPDX-License-Identifier: MIT
#pragma once

#include <assimp/scene.h>

#include <string>
#include <string_view>

namespace camway::scene {

/// Returns the cameras of a scene as text, for `camera_import.h`: a line `camera NAME`, a line
/// `lens FOV_X_RAD ASPECT NEAR` with 0 for what is not known, a line `takes N` with the number of
/// animations that move it, and lines `key TIME X Y Z QW QX QY QZ`, one for each time of a key of
/// what moves the camera, or one in all. A camera looks along -Z with +Y up; positions are in file
/// units, node transforms applied. `format`: name of the reader, which decides what its angle
/// means.
std::string cameras_text(const aiScene& scene, std::string_view format);

}  // namespace camway::scene
