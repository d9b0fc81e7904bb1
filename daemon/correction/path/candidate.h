// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "daemon/base/deadline.h"
#include "daemon/correction/path/correction.h"
#include "daemon/correction/path/free_space.h"
#include "daemon/correction/path/pocket.h"
#include "daemon/motion/spline/bump.h"

namespace camway::correction {

/// One collision to be corrected, and the part of the path that may change for it.
struct Problem {
  /// The path from the keyframe before the gap to the one after, and one gap more on either side.
  motion::CubicPath path;
  motion::CubicPath original;       ///< the same part of the path as interpolated
  std::vector<double> keyframes_s;  ///< of that part, in order; the path has to keep them
  std::size_t gap = 0;              ///< the collision lies between keyframes `gap` and `gap + 1`
  bool has_path_begin = false;  ///< the whole path begins where `path` does; nothing is before it
  bool has_path_end = false;    ///< and it ends there
  collision::CollisionInterval interval;
  /// Collisions of that part that somebody else has to correct. They need not be mended, and must
  /// not grow.
  std::vector<collision::CollisionInterval> others;
  Effort* effort = nullptr;  ///< where it is counted what is tried; may be null
  /// Where the knots of bumps may be. Null: anywhere.
  std::shared_ptr<const motion::KnotPlaces> places = nullptr;
  /// Where it is told that there is no way out of one end of the gap; may be null.
  std::optional<Pocket>* pocket = nullptr;

  [[nodiscard]] double gap_begin_s() const { return keyframes_s[gap]; }
  [[nodiscard]] double gap_end_s() const { return keyframes_s[gap + 1]; }
  /// Knots in `count` steps over the gap.
  [[nodiscard]] motion::KnotRow knots(int count) const {
    return {gap_begin_s(), gap_end_s(), count, places};
  }
};

/// What a correction came to.
struct Candidate {
  motion::CubicPath path;             ///< in the place of `Problem::path`
  std::vector<motion::BumpRow> rows;  ///< what was added
};

/// Where `path` first collides between the two times, others of `problem` apart; nothing if it is
/// proved free. If the deadline strikes, what was not searched counts as colliding.
std::optional<collision::CollisionInterval> first_new_collision(
    const motion::CubicPath& path, double t_begin_s, double t_end_s, const Problem& problem,
    const FreeSpace& space, const collision::Deadline& deadline);

/// `problem.path` with `rows` added, if times are fine enough for them, it still meets all
/// keyframes, and is proved to meet the rule for orientations and to be free wherever they change
/// it.
struct Attempt {
  std::optional<Candidate> candidate;
  /// Where there is none: the first collision, or where the rule is broken.
  std::optional<collision::CollisionInterval> collision;
  bool breaks_rule = false;
};
Attempt attempt(const Problem& problem, std::vector<motion::BumpRow> rows, const FreeSpace& space,
                const collision::Deadline& deadline);

}  // namespace camway::correction
