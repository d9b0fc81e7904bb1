// SPDX-License-Identifier: MIT
#include "daemon/scene/body_search.h"

#include <algorithm>

#include "daemon/geometry/triangle_box.h"
#include "daemon/geometry/triangle_distance.h"

namespace camway::scene {

using geometry::Box;
using geometry::OrientedBox;
using geometry::Triangle;

BodySearch::Candidates::Candidates() { met.fill(kNone); }

bool BodySearch::Candidates::was_met(std::uint32_t triangle) {
  std::uint32_t& slot = met[triangle % met.size()];
  if (slot == triangle) return true;
  slot = triangle;
  return false;
}

BodySearch::BodySearch(std::span<const Triangle> body, const Box& body_box, const Mesh& mesh,
                       double cutoff_m, double error_m, Goal goal, double certain_m, double share)
    : body_(body),
      mesh_(mesh),
      sides_(body_box),
      box_(body),
      oblique_(box_),
      error_m_(error_m),
      goal_(goal),
      certain_m_(certain_m),
      share_(share),
      best_{cutoff_m, kNone} {
  shrink_to(cutoff_m);
}

std::optional<Nearest> BodySearch::result() const {
  if (best_.triangle == kNone) return std::nullopt;
  return best_;
}

// A distance asked may be `error_m_` below the true one, and a bound `error_m_` above it.
void BodySearch::shrink_to(double best_m) {
  limit_m_ = best_m;
  const double reach_m = best_m + 2.0 * error_m_;
  squared_reach_m2_ = reach_m * reach_m * (1.0 + 2.0 * OrientedBox::kRelativeError);
}

bool BodySearch::cannot_win(double squared_m2, std::uint32_t triangle) const {
  // Nothing is nearer than a touch, so only a lower index could still win.
  if (best_.distance_m == 0.0 && triangle >= best_.triangle) return true;
  return squared_m2 > squared_reach_m2_;
}

void BodySearch::consider(std::uint32_t triangle) {
  if (!candidates_) candidates_.emplace();
  if (candidates_->was_met(triangle)) return;
  const double squared_m2 = box_.axes_bound_m2(mesh_.triangle(triangle));
  if (cannot_win(squared_m2, triangle)) return;
  if (candidates_->waiting_count == candidates_->waiting.size()) settle();
  candidates_->waiting[candidates_->waiting_count++] = {squared_m2, triangle};
}

void BodySearch::settle() {
  if (!candidates_) return;
  const auto begin = candidates_->waiting.begin();
  const auto end = begin + static_cast<std::ptrdiff_t>(candidates_->waiting_count);
  candidates_->waiting_count = 0;
  std::sort(begin, end, [](const Waiting& a, const Waiting& b) {
    return a.squared_m2 < b.squared_m2 || (a.squared_m2 == b.squared_m2 && a.triangle < b.triangle);
  });
  for (auto next = begin; next != end && !is_done_; ++next) {
    if (!cannot_win(next->squared_m2, next->triangle)) ask(next->triangle);
  }
}

void BodySearch::ask(std::uint32_t index) {
  const Triangle triangle = mesh_.triangle(index);
  if (cannot_win(box_.plane_bound_m2(triangle), index)) return;
  if (body_.size() == 1) {
    ask_part(0, triangle, index);
  } else if (body_.size() <= kMaxOriented) {
    ask_few(triangle, index);
  } else {
    ask_groups(triangle, index);
  }
}

void BodySearch::ask_few(const Triangle& triangle, std::uint32_t index) {
  if (!part_boxes_) {
    part_boxes_.emplace();
    for (std::size_t i = 0; i < body_.size(); ++i) {
      (*part_boxes_)[i] = OrientedBox(body_.subspan(i, 1));
    }
  }
  std::array<Waiting, kMaxOriented> parts;
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < body_.size(); ++i) {
    const double squared_m2 = (*part_boxes_)[i].squared_distance_bound_m2(triangle);
    std::size_t place = count++;
    for (; place > 0 && parts[place - 1].squared_m2 > squared_m2; --place) {
      parts[place] = parts[place - 1];
    }
    parts[place] = {squared_m2, i};
  }
  for (std::size_t i = 0; i < count && !is_done_; ++i) {
    if (!cannot_win(parts[i].squared_m2, index)) ask_part(parts[i].triangle, triangle, index);
  }
}

void BodySearch::ask_groups(const Triangle& triangle, std::uint32_t index) {
  const std::size_t size = std::max(kGroupSize, (body_.size() + kMaxGroups - 1) / kMaxGroups);
  if (!group_boxes_) {
    group_boxes_.emplace();
    for (std::size_t i = 0; i < body_.size(); ++i) {
      (*group_boxes_)[i / size].extend(geometry::bounds(body_[i]));
    }
  }
  const Box box = geometry::bounds(triangle);
  for (std::size_t begin = 0; begin < body_.size(); begin += size) {
    const Box& group = (*group_boxes_)[begin / size];
    if (cannot_win(geometry::squared_box_distance_m2(group, box), index)) continue;
    const std::size_t end = std::min(begin + size, body_.size());
    for (std::size_t i = begin; i < end && !is_done_; ++i) {
      const Box part = geometry::bounds(body_[i]);
      if (cannot_win(geometry::squared_box_distance_m2(part, box), index)) continue;
      ask_part(i, triangle, index);
    }
  }
}

void BodySearch::ask_part(std::size_t part, const Triangle& triangle, std::uint32_t index) {
  const double distance_m = geometry::triangle_distance(body_[part], triangle, limit_m_);
  const bool is_tie = distance_m == best_.distance_m && best_.triangle != kNone;
  if (!(distance_m < best_.distance_m || (is_tie && index < best_.triangle))) return;
  best_ = {distance_m, index};
  shrink_to(goal_ != Goal::kNear      ? distance_m
            : distance_m < certain_m_ ? share_ * distance_m
                                      : std::max(share_ * distance_m, certain_m_));
  is_done_ = goal_ == Goal::kAny || (distance_m == 0.0 && (goal_ == Goal::kNear || index == 0));
}

}  // namespace camway::scene
