// SPDX-License-Identifier: MIT
#include "daemon/correction/search/shorter_way.h"

namespace camway::correction {

namespace {

// Chosen by measurement; none changes what is proved.
constexpr double kLong = 1.8;              // cost of a way, relative to the distance of its ends
constexpr double kShorter = 0.8;           // cost of another way, relative to the first
constexpr double kFiner = 0.5;             // of its lattices
constexpr std::size_t kMostPoints = 1500;  // of the first search: a finer lattice would run out
constexpr std::size_t kPointsAsFirst = 4;  // of its search, relative to the first

}  // namespace

std::optional<BallMotion> shorter_way(const BallMotion& ball, const LatticeResult& first) {
  const bool is_long = first.cost_m > kLong * (ball.to_W - ball.from_W).norm();
  if (!is_long || first.points > kMostPoints) return std::nullopt;
  BallMotion shorter = ball;
  shorter.max_cost_m = kShorter * first.cost_m;
  shorter.max_points = kPointsAsFirst * first.points;
  shorter.coarseness = kFiner * ball.coarseness;
  return shorter;
}

}  // namespace camway::correction
