// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "daemon/base/deadline.h"
#include "daemon/correction/path/candidate.h"
#include "daemon/motion/path/keyframe.h"
#include "daemon/motion/path/time_origin.h"
#include "daemon/motion/spline/cubic_path.h"

namespace camway::correction {

/// Limits of the corrections of a path.
struct CorrectionLimits {
  int max_inserted_keyframes = 0;  ///< for the whole path [Limit: 0 <= value]
  /// Time that the stages after the corrections take for each piece of the path.
  /// [Limit: 0 <= value] [Units: seconds]
  double rest_s_per_piece = 0.0;
};

/// A part of the path that corrections changed. Other changed parts may end where it begins.
struct ChangedPart {
  double begin_s = 0.0;
  double end_s = 0.0;
  bool turns = false;  ///< whether it turns the body
};

/// A path while it is corrected: takes candidates as long as the keyframes that they insert stay
/// within the limit. Every knot of the path that the interpolated path does not have is an inserted
/// keyframe.
/// Not thread-safe.
class CorrectedPath {
 public:
  /// Refers to `interpolated` and `deadline`, which must outlive it. Requires `interpolated` to
  /// meet `keyframes`. `deadline`: the end of the corrections and of the stages after them.
  CorrectedPath(const motion::CubicPath& interpolated,
                const std::vector<motion::Keyframe>& keyframes, const CorrectionLimits& limits,
                const base::Deadline& deadline);

  [[nodiscard]] const motion::CubicPath& path() const { return path_; }
  /// Returns the path, and ends this object.
  [[nodiscard]] motion::CubicPath release() && { return std::move(path_); }
  [[nodiscard]] const motion::CubicPath& interpolated() const { return interpolated_; }
  /// Times of the given keyframes, increasing.
  [[nodiscard]] const std::vector<double>& keyframes_s() const { return keyframes_s_; }
  /// The end of the corrections. It leaves time for the later stages, and is moved forward where
  /// the path gains pieces.
  [[nodiscard]] const base::Deadline& deadline() const { return deadline_; }

  /// Returns the part of the path that may change for the interval between keyframes `leg` and
  /// `leg + 1`, as a problem without collisions. Knots of bumps coincide with knots of the path or
  /// keep away from them (`KnotPlaces`). `ball_radius_m`: radius of a ball that holds the body.
  [[nodiscard]] Problem part_about(std::size_t leg, const motion::TimeOrigin& origin,
                                   double ball_radius_m) const;

  /// Returns whether `candidate` inserts no more keyframes than the limit allows.
  [[nodiscard]] bool fits(const Candidate& candidate) const;
  /// Replaces a part of the path by `candidate` and returns true; returns false if that would
  /// exceed the limit of inserted keyframes.
  bool take(const Candidate& candidate);

  /// The changed parts, in order of time.
  [[nodiscard]] const std::vector<ChangedPart>& changed_parts() const { return changed_; }
  /// Returns `part` with time on either side, at most `share` of its length, as far as the path is
  /// as interpolated there.
  [[nodiscard]] ChangedPart widened(const ChangedPart& part, double share) const;
  /// Returns the path about a changed part, which may be widened, as a problem in which that part
  /// is as interpolated. Knots of its bumps may be at the knots of the corrected path.
  [[nodiscard]] Problem restored(const ChangedPart& part, const motion::TimeOrigin& origin,
                                 double ball_radius_m) const;
  /// Replaces a changed part by a candidate for the problem that `restored` returned. Returns false
  /// as `take` does.
  bool take_instead(const ChangedPart& part, const Candidate& candidate);

  /// Makes the path as interpolated between two given keyframes, which no changed part may cross.
  void restore(std::size_t first_keyframe, std::size_t last_keyframe);
  /// Takes over the path and the changed parts of `other`, a changed copy of this object.
  void adopt(CorrectedPath&& other);

  /// Counts the keyframes of a candidate that `take` refused.
  void count_refused(const Candidate& candidate);

  /// Returns the time range that `candidate` changes, within the path.
  [[nodiscard]] std::pair<double, double> range_of(const Candidate& candidate) const;

  /// Marks, in a list with one entry for each interval between keyframes, those that overlap the
  /// time range in more than an end.
  void mark_legs(double begin_s, double end_s, std::vector<bool>& legs) const;

  /// Times of the inserted keyframes, increasing.
  [[nodiscard]] std::vector<double> inserted_s() const;
  /// Returns the number of inserted keyframes that all candidates would need; nothing if none was
  /// refused.
  [[nodiscard]] std::optional<std::size_t> needed_keyframes() const;

 private:
  [[nodiscard]] std::size_t count_inserted() const;
  [[nodiscard]] std::size_t count_with(const Candidate& candidate) const;
  void add_changed(ChangedPart part);
  void leave_time_for_the_rest();

  const motion::CubicPath& interpolated_;
  const CorrectionLimits limits_;
  const base::Deadline& whole_deadline_;
  base::Deadline deadline_;
  std::vector<double> keyframes_s_;
  motion::CubicPath path_;
  std::vector<ChangedPart> changed_;  ///< in order of time, apart from one another
  std::size_t refused_keyframes_ = 0;
};

}  // namespace camway::correction
