// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "daemon/collision/interval.h"
#include "daemon/motion/body/camera.h"
#include "daemon/motion/path/path.h"
#include "tools/drawing/floor_section.h"

namespace camway::draw {

/// A camera motion as a list of poses, dense enough to be drawn as a line.
struct PathSample {
  double time_s = 0.0;
  motion::Pose pose;
};
using SampledPath = std::vector<PathSample>;

/// `count` samples, evenly spaced in time, both ends included. Precondition: count >= 2.
SampledPath sample(const motion::Path& path, std::size_t count);

/// What one picture tells: where the camera was asked to be, where its path ran into the scene, and
/// how it was corrected.
struct FloorPlan {
  std::string title;
  std::string subtitle;
  scene::Mesh mesh;
  SceneUp up = SceneUp::kY;
  motion::Corners corners_C{};                           ///< near quadrilateral
  std::vector<motion::Keyframe> keyframes;               ///< given and inserted
  SampledPath before;                                    ///< interpolated path; may be empty
  SampledPath after;                                     ///< corrected path; may be empty
  std::vector<collision::CollisionInterval> collisions;  ///< of `before`
  std::vector<collision::CollisionInterval> remaining_collisions;  ///< of `after`
  std::optional<double> cut_height_m;  ///< default: `cut_height_m` of the keyframes
  double width_px = 1600.0;            ///< the legend needs 1500 [Limit: value >= 1500]
};

/// The height at which a plan tells most: that of the keyframe in the middle of all heights, unless
/// it lies too near a floor or ceiling (a path that changes storey) and another one does better.
double cut_height_m(const scene::Mesh& mesh, SceneUp up,
                    const std::vector<motion::Keyframe>& keyframes);

/// Where to write; an empty path is left out.
struct PictureFiles {
  std::filesystem::path svg;
  std::filesystem::path png;
};

/// Draws the plan like Figure 7 of Ptacek & Johnstone (2006), from above: section of the storey,
/// keyframes with their near quadrilaterals, path and corner curves before and after the
/// correction, collision intervals with the quadrilaterals at their ends, and an enlarged detail
/// for each place of collision (three at most). Colours after Okabe & Ito (2008), told apart by the
/// colour-blind. Returns an error text that names the file, empty on success.
std::string draw_floor_plan(const FloorPlan& plan, const PictureFiles& files);

}  // namespace camway::draw
