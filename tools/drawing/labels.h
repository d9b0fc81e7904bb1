// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "tools/drawing/marks.h"

namespace camway::draw {

/// Finds places for labels in a frame, so that no two overlap and none covers a mark.
class LabelPlacer {
 public:
  explicit LabelPlacer(const Frame& frame);

  /// Keeps labels out of a box.
  void block(const PlanBox& box) { taken_.push_back(box); }
  /// Keeps labels out of a square about `at`.
  void block(const PlanPoint& at, double half_px);

  /// Returns the box of a label of `size` beside the mark at `at`, and keeps the next labels out of
  /// it; nothing if no place near the mark is free.
  std::optional<PlanBox> place(const PlanPoint& at, const PlanPoint& size);

 private:
  PlanBox frame_;
  std::vector<PlanBox> taken_;
};

}  // namespace camway::draw
