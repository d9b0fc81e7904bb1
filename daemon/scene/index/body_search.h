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

/// Puts pairs of a triangle of a body and one of the scene to a question, the most promising first,
/// and spares those that boxes show to be beyond a reach. What is asked, and what the reach
/// becomes, is up to the derived class. The body stands, or is anywhere between two ends.
class BodySearch {
 public:
  BodySearch(const BodySearch&) = delete;
  BodySearch& operator=(const BodySearch&) = delete;

  [[nodiscard]] const BoxSides& sides() const { return sides_; }
  /// Nothing where it would tell no more than `sides()`.
  [[nodiscard]] const ObliqueSides* oblique() const { return is_point_ ? nullptr : &oblique_; }
  /// Boxes further than this from `sides()` hold nothing of interest.
  [[nodiscard]] double squared_reach_m2() const { return squared_reach_m2_; }
  [[nodiscard]] bool is_beyond(double squared_box_m2) const {
    return squared_box_m2 > squared_reach_m2_ * (1.0 + 2.0 * kBoxGapRelativeError);
  }
  [[nodiscard]] bool is_done() const { return is_done_; }

  /// From now on triangles of this part are considered. Precondition: the list is empty, as it is
  /// after `settle`. The part must outlive this.
  void enter(const IndexedPart& part) { part_ = &part; }

  /// Puts a triangle on the list of those to be asked, unless it is surely of no interest.
  /// Precondition: it lies in the part that was entered.
  void consider(std::uint32_t triangle);

  /// Asks those on the list, the most promising first.
  void settle();

 protected:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  /// `hull`: of each part of the body `of_part` triangles, in turn, between which it stays; `box`
  /// is around them. `error_m`: bound of the rounding of distances. Preconditions: the body is not
  /// empty and finite, and outlives this.
  BodySearch(std::span<const geometry::Triangle> hull, std::size_t of_part,
             const geometry::Box& box, double error_m);
  virtual ~BodySearch() = default;

  /// From now on only what is not surely further than `reach_m` is asked.
  void shrink_to(double reach_m);
  void finish() { is_done_ = true; }
  /// A touch of triangle `index` was found: nothing is nearer, so only a lower index is asked.
  void found_touch(std::uint32_t index) { touched_ = index; }

 private:
  static constexpr std::size_t kMaxOriented = 4;  ///< triangles of a body with a box each
  static constexpr std::size_t kGroupSize = 8;    ///< triangles of larger bodies with one box
  static constexpr std::size_t kMaxGroups = 128;

  struct Waiting {
    double squared_m2;  ///< lower bound of its distance
    std::uint32_t triangle;
  };

  /// Made when the first triangle is considered: most queries of a free path meet none.
  struct Candidates {
    Candidates();

    /// Whether `triangle` was surely considered before; remembers it in any case. A triangle is met
    /// in every leaf that it lies in. Forgetting one costs time only.
    bool was_met(std::uint32_t triangle);

    std::array<std::uint32_t, 64> met;
    std::size_t waiting_count = 0;
    std::array<Waiting, 64> waiting;
  };

  /// The question, to part `part` of the body and scene triangle `index`.
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
  void ask(std::uint32_t index);
  void ask_few(const geometry::Triangle& triangle, std::uint32_t index);
  void ask_groups(const geometry::Triangle& triangle, std::uint32_t index);

  std::span<const geometry::Triangle> hull_;
  std::size_t of_part_;
  const IndexedPart* part_ = nullptr;
  BoxSides sides_;
  bool is_point_;  ///< the body, and it stands
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
