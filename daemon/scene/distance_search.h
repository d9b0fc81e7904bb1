// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/scene/body_search.h"

namespace camway::scene {

/// Keeps the triangle nearest to a body. What is proved to be beyond the nearest so far is not
/// asked.
class DistanceSearch : public BodySearch {
 public:
  enum class Goal {
    kNearest,
    kNear,  ///< once one is found, only what is nearer than `share` of it or `certain_m`
    kAny,
  };

  /// Arguments as those of `BodySearch`.
  DistanceSearch(std::span<const geometry::Triangle> body, const geometry::Box& body_box,
                 const Mesh& mesh, double cutoff_m, double error_m, Goal goal, double certain_m,
                 double share);

  [[nodiscard]] std::optional<Nearest> result() const;

 private:
  void ask_pair(std::size_t part, const geometry::Triangle& triangle, std::uint32_t index) final;

  std::span<const geometry::Triangle> body_;
  Goal goal_;
  double certain_m_;
  double share_;
  double limit_m_;  ///< what is further is of no interest
  Nearest best_;
};

}  // namespace camway::scene
