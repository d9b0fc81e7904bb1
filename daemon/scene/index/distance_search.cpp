// SPDX-License-Identifier: MIT
#include "daemon/scene/index/distance_search.h"

#include <algorithm>

#include "daemon/geometry/triangle_distance.h"

namespace camway::scene {

using geometry::Triangle;

DistanceSearch::DistanceSearch(std::span<const Triangle> body, const geometry::Box& body_box,
                               double cutoff_m, double error_m, DistanceGoal goal, double certain_m,
                               double share)
    : BodySearch(body, 1, body_box, error_m),
      body_(body),
      goal_(goal),
      certain_m_(certain_m),
      share_(share),
      limit_m_(cutoff_m),
      best_{cutoff_m, kNone} {
  shrink_to(limit_m_);
}

std::optional<Nearest> DistanceSearch::result() const {
  if (best_.triangle == kNone) return std::nullopt;
  return best_;
}

void DistanceSearch::ask_pair(std::size_t part, const Triangle& triangle, std::uint32_t index) {
  const double distance_m = geometry::triangle_distance(body_[part], triangle, limit_m_);
  const bool is_tie = distance_m == best_.distance_m && best_.triangle != kNone;
  if (!(distance_m < best_.distance_m || (is_tie && index < best_.triangle))) return;
  best_ = {distance_m, index};
  limit_m_ = goal_ != DistanceGoal::kNear ? distance_m
             : distance_m < certain_m_    ? share_ * distance_m
                                          : std::max(share_ * distance_m, certain_m_);
  shrink_to(limit_m_);
  if (distance_m == 0.0) found_touch(index);
  const bool touch_will_do = goal_ == DistanceGoal::kNear || index == 0;
  if (goal_ == DistanceGoal::kAny || (distance_m == 0.0 && touch_will_do)) finish();
}

}  // namespace camway::scene
