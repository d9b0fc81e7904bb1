// SPDX-License-Identifier: MIT
#include "daemon/scene/index/body_search.h"

#include <algorithm>

#include "daemon/geometry/triangle_box.h"

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

BodySearch::BodySearch(std::span<const Triangle> hull, std::size_t of_part, const Box& box,
                       double error_m)
    : hull_(hull),
      of_part_(of_part),
      sides_(box),
      is_point_(box.min() == box.max()),
      box_(hull),
      oblique_(box_),
      error_m_(error_m) {}

// A computed distance may be `error_m_` below the true one, and a bound `error_m_` above it.
void BodySearch::shrink_to(double reach_m) {
  const double surely_m = reach_m + 2.0 * error_m_;
  squared_reach_m2_ = surely_m * surely_m * (1.0 + 2.0 * OrientedBox::kRelativeError);
}

Box BodySearch::bounds_of(std::size_t part) const {
  Box box;
  for (const Triangle& triangle : hull_of(part)) box.extend(geometry::bounds(triangle));
  return box;
}

void BodySearch::consider(std::uint32_t triangle) {
  if (!candidates_) candidates_.emplace();
  if (candidates_->was_met(triangle)) return;
  const double squared_m2 = bound_m2(part_->triangle(triangle));
  if (cannot_win(squared_m2, triangle)) return;
  if (candidates_->waiting_count == candidates_->waiting.size()) settle();
  candidates_->waiting[candidates_->waiting_count++] = {squared_m2, triangle};
}

// Around a point all axes are alike, and those of the world cost least.
double BodySearch::bound_m2(const Triangle& triangle) const {
  if (!is_point_) return box_.axes_bound_m2(triangle);
  return geometry::squared_box_distance_m2(Box(hull_.front().front()), geometry::bounds(triangle));
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
  const Triangle triangle = part_->triangle(index);
  // Two parts are usually the halves of a quadrilateral.
  if (parts() == 2 && part_boxes_) return ask_two(triangle, index);
  if (cannot_win(box_.plane_bound_m2(triangle), index)) return;
  if (parts() == 1) {
    ask_pair(0, triangle, index);
  } else if (parts() == 2) {
    part_boxes_ = {box_.around(hull_of(0)), box_.around(hull_of(1))};
    ask_two(triangle, index);
  } else if (parts() <= kMaxOriented) {
    ask_few(triangle, index);
  } else {
    ask_groups(triangle, index);
  }
}

/// Parts that a triangle may touch, the most promising first.
class BodySearch::PartOrder {
 public:
  void add(double squared_m2, std::uint32_t part) {
    std::size_t place = count_++;
    for (; place > 0 && order_[place - 1].squared_m2 > squared_m2; --place) {
      order_[place] = order_[place - 1];
    }
    order_[place] = {squared_m2, part};
  }
  [[nodiscard]] std::span<const Waiting> parts() const { return {order_.data(), count_}; }

 private:
  std::array<Waiting, kMaxOriented> order_;
  std::size_t count_ = 0;
};

void BodySearch::ask_two(const Triangle& triangle, std::uint32_t index) {
  if (index >= touched_) return;
  OrientedBox::TwoBounds bounds;
  const std::span<const OrientedBox, 2> boxes(part_boxes_->data(), 2);
  if (!box_.bound_two(boxes, triangle, squared_reach_m2_, bounds)) return;
  PartOrder order;
  for (std::uint32_t i = 0; i < 2; ++i) {
    const double along_axes_m2 = bounds.axes_m2[i];
    if (!cannot_win(along_axes_m2, index))
      order.add(std::max(along_axes_m2, bounds.plane_m2[i]), i);
  }
  ask_parts(order, triangle, index);
}

void BodySearch::ask_few(const Triangle& triangle, std::uint32_t index) {
  if (!part_boxes_) {
    part_boxes_.emplace();
    for (std::size_t i = 0; i < parts(); ++i) (*part_boxes_)[i] = OrientedBox(hull_of(i));
  }
  PartOrder order;
  for (std::uint32_t i = 0; i < parts(); ++i) {
    const OrientedBox& box = (*part_boxes_)[i];
    const double along_axes_m2 = box.axes_bound_m2(triangle);
    if (cannot_win(along_axes_m2, index)) continue;
    order.add(std::max(along_axes_m2, box.plane_bound_m2(triangle)), i);
  }
  ask_parts(order, triangle, index);
}

void BodySearch::ask_parts(const PartOrder& order, const Triangle& triangle, std::uint32_t index) {
  for (const Waiting& part : order.parts()) {
    if (is_done_) return;
    if (!cannot_win(part.squared_m2, index)) ask_pair(part.triangle, triangle, index);
  }
}

void BodySearch::ask_groups(const Triangle& triangle, std::uint32_t index) {
  const std::size_t size = std::max(kGroupSize, (parts() + kMaxGroups - 1) / kMaxGroups);
  if (!group_boxes_) {
    group_boxes_.emplace();
    for (std::size_t i = 0; i < parts(); ++i) {
      (*group_boxes_)[i / size].extend(bounds_of(i));
    }
  }
  const Box box = geometry::bounds(triangle);
  for (std::size_t begin = 0; begin < parts(); begin += size) {
    const Box& group = (*group_boxes_)[begin / size];
    if (cannot_win(geometry::squared_box_distance_m2(group, box), index)) continue;
    const std::size_t end = std::min(begin + size, parts());
    for (std::size_t i = begin; i < end && !is_done_; ++i) {
      const Box part = bounds_of(i);
      if (cannot_win(geometry::squared_box_distance_m2(part, box), index)) continue;
      ask_pair(i, triangle, index);
    }
  }
}

}  // namespace camway::scene
