// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "daemon/base/budget.h"
#include "daemon/correction/ladder/collision_list.h"
#include "daemon/correction/ladder/corrected_path.h"
#include "daemon/correction/ladder/detour.h"
#include "daemon/correction/ladder/nudge.h"
#include "daemon/correction/path/candidate.h"
#include "daemon/correction/path/free_space.h"
#include "daemon/motion/path/time_origin.h"

namespace camway::correction {

/// The rungs of the ladder: ways to correct a collision, or a few together. A correction is taken
/// only if all that it changed is proved free, so no correction undoes another.
///
/// The methods take indices of open collisions, mark them as corrected where a correction was
/// taken, and add the effort spent. Every method has a bounded number of steps, which also end at
/// the deadline of the path. Not thread-safe.
class Rungs {
 public:
  /// Refers to all arguments but the last two, which must outlive it. `origin`: origin of all
  /// times. `seed`: random seed of searches for detours. The relaxation of corrections has a number
  /// of steps for each interval between keyframes that has a collision.
  Rungs(FreeSpace& space, CorrectedPath& corrected, CollisionList& collisions,
        const motion::TimeOrigin& origin, std::uint64_t seed);

  /// Moves the camera aside for the group of collisions that begins with `index`, or else for the
  /// first of them. A move that is dear is compared with a way round, which replaces everything
  /// between two keyframes. Returns whether that corrected it.
  bool move_away(std::size_t index);

  /// Returns the cheapest turn that corrects the collision; nothing if none does, or the
  /// orientation policy allows none.
  [[nodiscard]] std::optional<Candidate> turned(std::size_t index);

  /// Takes a correction of the collision that `turned` returned, if there is one.
  void take_turn(std::size_t index, const std::optional<Candidate>& turned);

  /// The cost beyond which a detour is dearer than the turn that `turned` returned: infinite if
  /// there is none. A turn counts more than a detour of the same cost.
  [[nodiscard]] double most_cost_instead_of(std::size_t index,
                                            const std::optional<Candidate>& turned) const;

  struct Replaced {
    bool has_way = false;          ///< whether a detour was found
    std::optional<Pocket> pocket;  ///< as `DetourResult` has it
  };
  /// Replaces everything between the two keyframes about the collision by a detour. One that costs
  /// more than `most_cost` is found, but not taken.
  Replaced replace_leg(std::size_t index, Search search, const ProofsOfNoWay& proofs,
                       double most_cost = std::numeric_limits<double>::infinity());

 private:
  [[nodiscard]] double cost(std::size_t index, const Candidate& candidate) const;
  [[nodiscard]] Problem problem(std::span<const std::size_t> group) const;
  std::optional<Candidate> nudged(std::span<const std::size_t> group, NudgeKind nudge_kind);
  bool take_move(std::span<const std::size_t> group, const std::optional<Candidate>& moved);
  std::optional<Candidate> way_instead_of(const Candidate& moved,
                                          std::span<const std::size_t> group);
  bool accept(std::span<const std::size_t> group, CorrectionKind kind,
              const std::optional<Candidate>& candidate);
  [[nodiscard]] const base::Deadline& deadline() const { return corrected_.deadline(); }

  FreeSpace& space_;
  CorrectedPath& corrected_;
  CollisionList& collisions_;
  const motion::TimeOrigin& origin_;
  const std::uint64_t seed_;
  base::Budget budget_;  ///< steps of relaxation
};

}  // namespace camway::correction
