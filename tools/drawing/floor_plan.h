// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "daemon/collision/interval.h"
#include "daemon/motion/body/camera.h"
#include "daemon/motion/path/path.h"
#include "tools/drawing/barrier.h"
#include "tools/drawing/floor_section.h"
#include "tools/drawing/palette.h"

namespace camway::draw {

/// A pose of a camera motion. A list of them is dense enough to be drawn as a line.
struct PathSample {
  double time_s = 0.0;
  motion::Pose pose;
};
using SampledPath = std::vector<PathSample>;

/// Returns `count` samples, evenly spaced in time, both ends included. Requires count >= 2.
SampledPath sample(const motion::Path& path, std::size_t count);

/// A time range of a path.
struct TimeRange {
  double begin_s = 0.0;
  double end_s = 0.0;
};

/// Names of the two paths of a picture in its legend.
struct PathNames {
  std::string before{names::kBefore};
  std::string after{names::kAfter};
};

/// The content of a picture: the keyframes, the path with its collisions, and the corrected path.
struct FloorPlan {
  std::string title;
  std::string subtitle;
  scene::Mesh mesh;
  SceneUp up = SceneUp::kY;
  motion::Corners corners_C{};  ///< corners of the near quadrilateral
  /// Points of the body whose convex hull is drawn, each thickened by a ball of radius
  /// `body_ball_m`; empty for a camera, whose near quadrilateral is drawn.
  std::vector<geometry::Vec3> body_C = {};
  double body_ball_m = 0.0;
  std::vector<motion::Keyframe> keyframes;               ///< given and inserted keyframes
  SampledPath before;                                    ///< interpolated path; may be empty
  SampledPath after;                                     ///< corrected path; may be empty
  std::vector<collision::CollisionInterval> collisions;  ///< collisions of `before`
  std::vector<collision::CollisionInterval> remaining_collisions;  ///< collisions of `after`
  std::vector<TimeRange> corrected = {};  ///< stretches of `after` that a correction changed
  std::optional<Barrier> barrier = {};    ///< where there is no path
  std::optional<double> cut_height_m;     ///< height of the section; default: each storey's own
  PathNames path_names = {};
};

/// Returns the height for the section: the median height of the keyframes, or that of another
/// keyframe if the median one is too near a floor or ceiling, as on a path that changes storey.
double cut_height_m(const scene::Mesh& mesh, SceneUp up,
                    const std::vector<motion::Keyframe>& keyframes);

/// The files to write. An empty path means no file.
struct PictureFiles {
  std::filesystem::path svg;
  std::filesystem::path png;
};

/// Draws the plan from above, like Figure 7 of Ptacek & Johnstone (2006): for each storey that the
/// path visits, its section, keyframes with their near quadrilaterals, path and corner curves
/// before and after the correction, and collision intervals with the quadrilaterals at their ends;
/// in place of quadrilaterals and corner curves the outlines of a body that is no camera;
/// the section of the barrier, with the keyframes inside and outside of it named;
/// an enlarged detail of each place of collision, three at most; and the heights along the path.
/// Keyframes have the numbers that messages give them: the given ones, from 0. Returns an error
/// that names the file; empty on success.
std::string draw_floor_plan(const FloorPlan& plan, const PictureFiles& files);

/// Returns the same picture as the text of an SVG file; empty if it cannot be drawn.
std::string floor_plan_svg(const FloorPlan& plan);

}  // namespace camway::draw
