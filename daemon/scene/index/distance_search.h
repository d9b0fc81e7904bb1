// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/scene/index/body_search.h"

namespace camway::scene {

/// Finds the triangle nearest to a body. Skips triangles that are proved to be farther than the
/// nearest one found so far.
class DistanceSearch : public BodySearch {
 public:
  /// `body`, `body_box` and `error_m` as for `BodySearch`; the others as for `SceneIndex::near`.
  DistanceSearch(std::span<const geometry::Triangle> body, const geometry::Box& body_box,
                 double cutoff_m, double error_m, DistanceGoal goal, double certain_m,
                 double share);

  [[nodiscard]] std::optional<Nearest> result() const;

 private:
  void ask_pair(std::size_t part, const geometry::Triangle& triangle, std::uint32_t index) final;

  std::span<const geometry::Triangle> body_;
  DistanceGoal goal_;
  double certain_m_;
  double share_;
  double limit_m_;  ///< triangles farther away are skipped
  Nearest best_;
};

}  // namespace camway::scene
