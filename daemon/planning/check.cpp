// SPDX-License-Identifier: MIT
#include "daemon/planning/check.h"

#include <fmt/format.h>

#include <algorithm>

#include "daemon/collision/clearance.h"
#include "daemon/motion/corner_rounding.h"

namespace camway::planning {

namespace {

// Whoever made the path may have rounded its control points a few times more than we round a pose:
// to the digits of a text file, for example.
constexpr double kJoinRoundings = 1000.0;

}  // namespace

PathCheck check_path(const scene::SceneIndex& index, const motion::Path& path,
                     const motion::Corners& corners_C, const collision::DetectOptions& options,
                     const collision::Deadline& deadline,
                     const collision::Deadline& clearance_deadline) {
  PathCheck check;
  const auto found = collision::detect_collisions(index, path, corners_C, path.begin_s(),
                                                  path.end_s(), options, deadline);
  if (!found) return check;
  check.complete = true;
  check.collisions = *found;
  if (!found->empty()) return check;
  check.certificate.certified = true;
  const auto clearance = collision::path_clearance(index, path, corners_C, clearance_deadline);
  if (clearance) check.certificate.clearance_lower_bound_m = clearance->lower_bound_m;
  return check;
}

std::optional<std::string> find_jump(const motion::Path& path, const motion::Corners& corners_C) {
  const double radius_m = motion::body_radius_m(corners_C);
  const std::span<const motion::Segment> segments = path.segments();
  for (std::size_t i = 1; i < segments.size(); ++i) {
    const motion::Corners before_W = motion::corners_W(corners_C, pose_at(segments[i - 1], 1.0));
    const motion::Corners after_W = motion::corners_W(corners_C, pose_at(segments[i], 0.0));
    double jump_m = 0.0;
    for (std::size_t k = 0; k < before_W.size(); ++k) {
      jump_m = std::max(jump_m, (after_W[k] - before_W[k]).norm());
    }
    const double rounding_m = motion::corner_rounding_m(segments[i - 1], 1.0, radius_m) +
                              motion::corner_rounding_m(segments[i], 0.0, radius_m);
    if (jump_m <= kJoinRoundings * rounding_m) continue;
    return fmt::format("segments[{}]: begins {:.3g} m away from where segments[{}] ends", i, jump_m,
                       i - 1);
  }
  return std::nullopt;
}

}  // namespace camway::planning
