// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "tools/drawing/floor_plan.h"

namespace camway::draw {

/// A scene without a path.
struct ScenePlan {
  std::string title;
  scene::Mesh mesh;
  SceneUp up = SceneUp::kY;
  std::string remark;  ///< end of the subtitle
};

/// Draws a plan of each storey of a scene with axes and a grid, to choose keyframes from; of a
/// scene without storeys, one at half its height. Returns an error that names the file; empty on
/// success.
std::string draw_scene_plan(const ScenePlan& plan, const PictureFiles& files);

}  // namespace camway::draw
