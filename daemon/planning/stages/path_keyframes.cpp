// SPDX-License-Identifier: MIT
#include "daemon/planning/stages/path_keyframes.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "daemon/motion/spline/path_frame.h"
#include "daemon/planning/request/validate.h"

namespace camway::planning {

namespace {

using motion::CubicPath;
using motion::Keyframe;
using motion::PathFrame;

/// Largest coordinate of a path's control points, and least length of its images at knots.
struct Sizes {
  double coordinate_m = 0.0;
  double image = std::numeric_limits<double>::infinity();
};

Sizes sizes_of(const CubicPath& path) {
  Sizes sizes;
  for (const motion::CubicPiece& piece : path.pieces) {
    for (const geometry::Vec3& point : piece.position)
      sizes.coordinate_m = std::max(sizes.coordinate_m, point.cwiseAbs().maxCoeff());
    sizes.image = std::min({sizes.image, piece.image.front().norm(), piece.image.back().norm()});
  }
  return sizes;
}

/// Whether `keyframes` and `frame` are the contents of a valid request.
bool may_be_asked_for(const std::vector<Keyframe>& keyframes, const PathFrame& frame,
                      const PlanRequest& request, const motion::TimeOrigin& origin) {
  PlanRequest again = request;
  again.keyframes = keyframes;
  for (Keyframe& keyframe : again.keyframes) keyframe.time_s = origin.sent_s(keyframe.time_s);
  again.frame = frame;
  again.has_times = true;
  again.options.default_speed_m_per_s.reset();
  return !validate(again);
}

bool give(const CubicPath& path, const std::vector<Keyframe>& keyframes, const PathFrame& frame) {
  const CubicPath again = motion::interpolate_cubic(keyframes, frame);
  const motion::PathDifference difference = motion::difference_of(path, again);
  const Sizes sizes = sizes_of(path);
  const double rounding_m =
      kReplanRoundings * std::numeric_limits<double>::epsilon() * sizes.coordinate_m;
  // Squaring x doubles its angle, and a rotation turns by twice the angle on S³.
  return difference.position_m <= kMostReplanned_m + rounding_m &&
         4.0 * difference.image <= kMostReplanned_rad * sizes.image;
}

}  // namespace

bool set_keyframes(const CubicPath& path, const PlanRequest& request, const PreparedPlan& prepared,
                   PlanResult& result) {
  std::vector<Keyframe> keyframes = motion::keyframes_of(path, prepared.keyframes);
  const PathFrame frame = motion::frame_of(path);
  if (!give(path, keyframes, frame)) return false;
  if (!may_be_asked_for(keyframes, frame, request, prepared.origin)) return false;
  result.keyframes = std::move(keyframes);
  result.frame = frame;
  return true;
}

void reset_keyframes(const PreparedPlan& prepared, PlanResult& result) {
  result.keyframes = prepared.keyframes;
  result.frame = prepared.frame;
}

void drop_frame(PlanResult& result) {
  result.frame.reset();
  for (Keyframe& keyframe : result.keyframes) keyframe.image.setZero();
}

}  // namespace camway::planning
