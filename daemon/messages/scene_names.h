// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "lcmtypes/wire/layout.h"

namespace camway::messages {

/// Returns whether `name` satisfies `kSceneNameRule`.
bool is_scene_name(std::string_view name);
inline constexpr char kSceneNameRule[] =
    "must be of letters, digits, '_', '-' and '.', at most 128";
static_assert(wire::kMaxSceneNameBytes == 128);

/// Requirement of `scene::VoxelGrid::valid_resolution`, in metres.
inline constexpr char kResolutionRule[] = "must be from 1e-9 to 1e9 m";

}  // namespace camway::messages
