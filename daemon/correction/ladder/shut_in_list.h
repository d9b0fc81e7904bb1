// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "daemon/correction/path/pocket.h"
#include "daemon/correction/search/shut_in.h"

namespace camway::correction {

/// The keyframes from which searches for detours found no way out. Such a result is no proof, but
/// it decides which other intervals between keyframes need no search, and the answer reports it.
///
/// Interval `leg` lies between the keyframes `leg` and `leg + 1`.
class ShutInList {
 public:
  /// Adds the pocket that a search of an interval found about one of its ends. If the pocket is not
  /// complete, it replaces the one that an earlier search of the same interval found.
  void add(std::size_t leg, const Pocket& pocket);

  /// Marks an interval as searched for ways that need turning, which is costly.
  void mark_searched(std::size_t leg);

  /// Returns whether a complete pocket about one end of the interval does not hold the other end.
  /// `begin_W` and `end_W` are the centres of the body at the two keyframes.
  [[nodiscard]] bool is_shut_off(std::size_t leg, const geometry::Vec3& begin_W,
                                 const geometry::Vec3& end_W) const;

  /// Returns whether a costly search of the interval is of no use: a cheap search of it ended in a
  /// narrow place at one keyframe, and a costly search of an interval at the same keyframe found no
  /// way out either. So the answer will be partial, whatever a further search finds.
  [[nodiscard]] bool is_worthless(std::size_t leg) const;

  /// Returns one entry for each keyframe: those with complete pockets in the order of discovery,
  /// then those of the intervals for which `is_open` returns true.
  [[nodiscard]] std::vector<ShutIn> all(const std::function<bool(std::size_t leg)>& is_open) const;

 private:
  /// A keyframe from which a search ended at its limit without a way out.
  struct NotLeft {
    std::size_t leg = 0;  ///< the interval that was searched
    ShutIn shut_in;
    bool is_narrow = false;
    bool is_searched = false;  ///< whether ways that need turning were searched, too
  };

  std::vector<ShutIn> complete_;  ///< keyframes whose pocket is complete
  std::vector<NotLeft> not_left_;
};

}  // namespace camway::correction
