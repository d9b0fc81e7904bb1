// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "daemon/geometry/oriented_box.h"
#include "daemon/scene/index/box_gaps.h"
#include "daemon/scene/index/scene_index.h"

namespace camway::scene {

/// Base class of searches that test pairs of a body triangle and a scene triangle, the most
/// promising first, and skip those whose boxes prove them to be beyond a reach. The derived class
/// defines the test and the reach. The body stands still, or is between two end positions.
class BodySearch {
 public:
  BodySearch(const BodySearch&) = delete;
  BodySearch& operator=(const BodySearch&) = delete;

  [[nodiscard]] const BoxSides& sides() const { return sides_; }
  /// The body's oriented box; null if the body is a point, for which `sides()` tells as much.
  [[nodiscard]] const ObliqueSides* oblique() const { return is_point_ ? nullptr : &oblique_; }
  /// Square of the reach: boxes farther than the reach from `sides()` are skipped.
  [[nodiscard]] double squared_reach_m2() const { return squared_reach_m2_; }
  [[nodiscard]] bool is_beyond(double squared_box_m2) const {
    return squared_box_m2 > squared_reach_m2_ * (1.0 + 2.0 * kBoxGapRelativeError);
  }
  [[nodiscard]] bool is_done() const { return is_done_; }

  /// Sets the part that `consider` refers to, which must outlive this object. Requires that no
  /// triangle waits, as after `settle`.
  void enter(const IndexedPart& part) { part_ = &part; }

  /// Lets `triangle` wait for its test, unless a box proves it irrelevant. Requires that it lies in
  /// the part that was entered.
  void consider(std::uint32_t triangle);

  /// Tests the waiting triangles, the most promising first.
  void settle();

 protected:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  /// `hull` holds `of_part` triangles for each part of the body, part after part: the part itself
  /// or its end positions. `box` bounds all of them; `error_m` bounds the rounding error of
  /// distances. Requires a body that is finite and not empty. It must outlive this object.
  BodySearch(std::span<const geometry::Triangle> hull, std::size_t of_part,
             const geometry::Box& box, double error_m);
  virtual ~BodySearch() = default;

  /// Reduces the reach: from now on only triangles that may be within `reach_m` are tested.
  void shrink_to(double reach_m);
  void finish() { is_done_ = true; }
  /// Records that triangle `index` touches the body: nothing is nearer, so from now on only lower
  /// indices are tested.
  void found_touch(std::uint32_t index) { touched_ = index; }

 private:
  static constexpr std::size_t kMaxOriented = 4;  ///< most parts that get an oriented box each
  static constexpr std::size_t kGroupSize = 8;    ///< parts of larger bodies that share a box
  static constexpr std::size_t kMaxGroups = 128;
  /// Triangles that are sorted together, by measurement: the best of them shrinks the reach before
  /// others of a large leaf are looked at.
  static constexpr std::size_t kMostWaiting = 8;

  struct Waiting {
    double squared_m2;  ///< lower bound of the squared distance
    std::uint32_t triangle;
  };

  /// Made when the first triangle is considered: most queries of a free path never consider one.
  struct Candidates {
    Candidates();

    /// Returns whether `triangle` was surely considered before, and remembers it. (A triangle is
    /// met in every leaf that holds it.) Forgetting one costs time only.
    bool was_met(std::uint32_t triangle);

    std::array<std::uint32_t, 64> met;
    std::size_t waiting_count = 0;
    std::array<Waiting, kMostWaiting> waiting;
  };

  class PartOrder;

  /// Tests part `part` of the body against scene triangle `index`.
  virtual void ask_pair(std::size_t part, const geometry::Triangle& triangle,
                        std::uint32_t index) = 0;

  [[nodiscard]] bool cannot_win(double squared_m2, std::uint32_t triangle) const {
    return squared_m2 > squared_reach_m2_ || triangle >= touched_;
  }
  [[nodiscard]] std::size_t parts() const { return hull_.size() / of_part_; }
  [[nodiscard]] std::span<const geometry::Triangle> hull_of(std::size_t part) const {
    return hull_.subspan(part * of_part_, of_part_);
  }
  [[nodiscard]] geometry::Box bounds_of(std::size_t part) const;
  [[nodiscard]] double bound_m2(const geometry::Triangle& triangle) const;
  void ask(std::uint32_t index);
  void ask_two(const geometry::Triangle& triangle, std::uint32_t index);
  void ask_few(const geometry::Triangle& triangle, std::uint32_t index);
  void ask_parts(const PartOrder& order, const geometry::Triangle& triangle, std::uint32_t index);
  void ask_groups(const geometry::Triangle& triangle, std::uint32_t index);

  std::span<const geometry::Triangle> hull_;
  std::size_t of_part_;
  const IndexedPart* part_ = nullptr;
  BoxSides sides_;
  bool is_point_;  ///< whether the body is a single point that stands still
  geometry::OrientedBox box_;
  ObliqueSides oblique_;
  double error_m_;
  bool is_done_ = false;
  double squared_reach_m2_ = 0.0;
  std::uint32_t touched_ = kNone;
  std::optional<Candidates> candidates_;
  std::optional<std::array<geometry::OrientedBox, kMaxOriented>> part_boxes_;
  std::optional<std::array<geometry::Box, kMaxGroups>> group_boxes_;
};

}  // namespace camway::scene
