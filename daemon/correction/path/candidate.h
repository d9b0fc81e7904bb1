// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "daemon/base/deadline.h"
#include "daemon/collision/interval.h"
#include "daemon/correction/path/free_space.h"
#include "daemon/motion/spline/bump.h"

namespace camway::correction {

/// One collision to be corrected, and the part of the path that may change for it.
struct Problem {
  /// Part of the current path: interval `leg` between keyframes, and the interval before and after
  /// it where there is one.
  motion::CubicPath path;
  motion::CubicPath original;       ///< the same part of the interpolated path
  std::vector<double> keyframes_s;  ///< keyframes in this part, increasing; corrections keep them
  std::size_t leg = 0;              ///< the collision lies between keyframes `leg` and `leg + 1`
  bool has_path_begin = false;  ///< whether `path` starts at the first keyframe of the whole path
  bool has_path_end = false;    ///< whether `path` ends at the last keyframe of the whole path
  /// The range to correct. The whole of it must be free afterwards, even where no row reaches.
  collision::CollisionInterval interval;
  /// Other collisions in this part. A correction of this problem may leave them, but must not
  /// enlarge them.
  std::vector<collision::CollisionInterval> foreign_collisions;
  /// Times allowed for the knots of bumps; null allows any time.
  std::shared_ptr<const motion::KnotPlaces> places = nullptr;

  [[nodiscard]] double leg_begin_s() const { return keyframes_s[leg]; }
  [[nodiscard]] double leg_end_s() const { return keyframes_s[leg + 1]; }
  /// Returns knots that divide the interval between keyframes into `count` equal steps, each moved
  /// to the time that `places` chooses for it.
  [[nodiscard]] motion::KnotRow knots(int count) const {
    return {leg_begin_s(), leg_end_s(), count, places};
  }
};

/// A corrected path.
struct Candidate {
  motion::CubicPath path;             ///< replaces `Problem::path`
  std::vector<motion::BumpRow> rows;  ///< bumps that were added to `Problem::path`
};

/// Whether any bump of `rows` turns the body.
bool turns(std::span<const motion::BumpRow> rows);

/// Returns a time range in which `path` collides, in [t_begin_s, t_end_s] and outside
/// `problem.foreign_collisions` (`collision::any_collision`); nothing if `path` is proved free
/// there. If the deadline strikes, the part not searched counts as colliding.
std::optional<collision::CollisionInterval> new_collision(const motion::CubicPath& path,
                                                          double t_begin_s, double t_end_s,
                                                          const Problem& problem,
                                                          const FreeSpace& space,
                                                          const base::Deadline& deadline);

/// Returns a short time range of what `candidate` changed in which the body is nearer to the scene
/// than `gap_m` beyond the required clearance, outside of `problem.foreign_collisions`; nothing if
/// there is none. The bounds do not count.
std::optional<collision::CollisionInterval> tight_place(const Candidate& candidate, double gap_m,
                                                        const Problem& problem,
                                                        const FreeSpace& space,
                                                        const base::Deadline& deadline);

/// Adds `rows` to `problem.path`. Returns a candidate if each step between knots has enough times
/// that are exact in the sender's clock (`KnotRow::fits`), all keyframes are still met, and
/// `problem.interval` and everything that `rows` change is proved free, and proved to meet the
/// orientation policy.
std::optional<Candidate> free_candidate(const Problem& problem, std::vector<motion::BumpRow> rows,
                                        const FreeSpace& space, const base::Deadline& deadline);

/// Result of adding bumps to the path of a problem.
struct Attempt {
  std::optional<Candidate> candidate;
  /// Set if there is no candidate:
  /// - the approximate range of a collision;
  /// - the range that violates the orientation policy;
  /// - `problem.interval` if the rows do not fit or a keyframe would move.
  std::optional<collision::CollisionInterval> collision;
};
/// Does what `free_candidate` does. If there is no candidate, also returns the range that prevents
/// it.
Attempt attempt(const Problem& problem, std::vector<motion::BumpRow> rows, const FreeSpace& space,
                const base::Deadline& deadline);

}  // namespace camway::correction
