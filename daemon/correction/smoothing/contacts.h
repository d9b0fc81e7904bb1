// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "daemon/correction/path/free_space.h"
#include "daemon/correction/smoothing/smoothing_form.h"

namespace camway::correction {

/// A bound of a step from a pose, to first order: after it a point of the body is still `room_m +
/// direction · step` beyond the plane that keeps it from a triangle of the scene, or inside a side
/// of the bounds.
struct ContactRow {
  StackedPoint direction;
  double room_m = 0.0;
  std::uint32_t triangle = 0;  ///< of the scene, or a side (`collision::Obstacles::is_side`)
  std::size_t vertex = 0;      ///< of the body: three times its triangle, and which of the three
};

/// Adds the rows of what obstacles ask of the body: of a triangle for each triangle of the body
/// the plane across the shortest line between the two, and those vertices that a step of
/// `horizon_m` could bring to it. `point` is where the body is, and free of them.
void add_contact_rows(FreeSpace& space, bool may_turn, const geometry::Vec4& reference,
                      double lever_m, const StackedPoint& point,
                      std::span<const std::uint32_t> obstacles, double horizon_m,
                      std::vector<ContactRow>& rows);

}  // namespace camway::correction
