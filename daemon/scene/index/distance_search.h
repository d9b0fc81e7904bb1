// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/scene/index/body_search.h"

namespace camway::scene {

/// Keeps the triangle nearest to a body. What is proved to be beyond the nearest so far is not
/// asked.
class DistanceSearch : public BodySearch {
 public:
  /// Arguments as those of `BodySearch`.
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
  double limit_m_;  ///< what is further is of no interest
  Nearest best_;
};

}  // namespace camway::scene
