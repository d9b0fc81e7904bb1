// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "daemon/correction/ladder/corrected_path.h"
#include "daemon/correction/path/candidate.h"
#include "daemon/correction/path/correction.h"

namespace camway::correction {

/// A collision of the interpolated path, with the state of its correction.
struct ListedCollision {
  Correction correction;
  std::size_t leg = 0;  ///< it lies between keyframes `leg` and `leg + 1`
  /// Whether a correction was found that would exceed the limit of inserted keyframes.
  bool is_beyond_limit = false;

  [[nodiscard]] bool is_open() const { return correction.kind == CorrectionKind::kNone; }
};

/// The collisions of a path, divided at its keyframes, in order of time. A value type.
class CollisionList {
 public:
  /// Divides collisions that contain keyframes, as those near to one another form one interval.
  CollisionList(const std::vector<collision::CollisionInterval>& collisions,
                const std::vector<double>& keyframes_s);

  [[nodiscard]] std::size_t size() const { return list_.size(); }
  [[nodiscard]] ListedCollision& operator[](std::size_t index) { return list_[index]; }
  [[nodiscard]] const ListedCollision& operator[](std::size_t index) const { return list_[index]; }

  /// Returns how many collisions are not corrected.
  [[nodiscard]] std::size_t count_open() const;
  /// Returns whether a collision is open for another reason than the limit of keyframes.
  [[nodiscard]] bool any_without_way() const;
  /// Returns the indices of the open collisions in an interval between keyframes.
  [[nodiscard]] std::vector<std::size_t> open_in(std::size_t leg) const;
  /// Returns `index` and the indices of the collisions after it that are too near for a correction
  /// of their own: open, in the same interval between keyframes, and at most `near_s` after the one
  /// before.
  [[nodiscard]] std::vector<std::size_t> open_near(std::size_t index, double near_s) const;
  /// Returns how many intervals between keyframes have a collision.
  [[nodiscard]] std::size_t count_legs() const;

  /// Returns the part of the path that may change for an interval between keyframes, with the open
  /// collisions in it as `Problem::foreign_collisions`. `part`: as `CorrectedPath::part_about`
  /// returns it.
  [[nodiscard]] Problem with_open_collisions(Problem part) const;

  /// Returns, for each interval between keyframes of `corrected`, whether a correction changed it.
  [[nodiscard]] std::vector<bool> corrected_legs(const CorrectedPath& corrected) const;

  /// Extends the corrections that reach into the time from `begin_s` to `end_s` by `range_s`.
  void widen(double begin_s, double end_s, const std::pair<double, double>& range_s);

  /// Sets the range of the corrections within a changed part to `range_s`.
  void set_range(const ChangedPart& part, const std::pair<double, double>& range_s);

  /// Returns the corrections, in order of time.
  [[nodiscard]] std::vector<Correction> corrections() const;

 private:
  std::vector<ListedCollision> list_;
};

/// Sets `moved_m`, `turned_rad` and `shift` of all corrections to what they are on `path`, compared
/// with `interpolated`, by samples and a search beside the largest.
void measure_corrections(const motion::CubicPath& path, const motion::CubicPath& interpolated,
                         const Closeness& closeness, std::vector<Correction>& corrections);

}  // namespace camway::correction
