// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "daemon/geometry/oriented_box.h"
#include "daemon/scene/box_gaps.h"
#include "daemon/scene/scene_index.h"

namespace camway::scene {

/// Asks triangles that the index comes upon for their distance to a body, and keeps the nearest.
/// What is proved to be beyond the nearest so far is not asked.
class BodySearch {
 public:
  enum class Goal {
    kNearest,
    kNear,  ///< once one is found, only what is nearer than `share` of it or `certain_m`
    kAny,
  };

  /// `error_m`: bound of the rounding of any distance asked. Preconditions: the body is not empty
  /// and finite, and outlives this, as `mesh` does.
  BodySearch(std::span<const geometry::Triangle> body, const geometry::Box& body_box,
             const Mesh& mesh, double cutoff_m, double error_m, Goal goal, double certain_m,
             double share);

  [[nodiscard]] const BoxSides& sides() const { return sides_; }
  [[nodiscard]] const ObliqueSides* oblique() const { return &oblique_; }
  /// Boxes further than this from `sides()` hold nothing of interest.
  [[nodiscard]] double squared_reach_m2() const { return squared_reach_m2_; }
  [[nodiscard]] bool is_beyond(double squared_box_m2) const {
    return squared_box_m2 > squared_reach_m2_ * (1.0 + 2.0 * kBoxGapRelativeError);
  }
  [[nodiscard]] bool is_done() const { return is_done_; }
  [[nodiscard]] std::optional<Nearest> result() const;

  /// Puts a triangle on the list of those to be asked, unless it is surely of no interest.
  void consider(std::uint32_t triangle);

  /// Asks those on the list, the most promising first.
  void settle();

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
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

  void shrink_to(double best_m);
  [[nodiscard]] bool cannot_win(double squared_m2, std::uint32_t triangle) const;
  void ask(std::uint32_t index);
  void ask_few(const geometry::Triangle& triangle, std::uint32_t index);
  void ask_groups(const geometry::Triangle& triangle, std::uint32_t index);
  void ask_part(std::size_t part, const geometry::Triangle& triangle, std::uint32_t index);
  void prepare_parts();

  std::span<const geometry::Triangle> body_;
  const Mesh& mesh_;
  BoxSides sides_;
  geometry::OrientedBox box_;
  ObliqueSides oblique_;
  double error_m_;
  Goal goal_;
  double certain_m_;
  double share_;
  bool is_done_ = false;
  double limit_m_ = 0.0;  ///< what is further is of no interest
  double squared_reach_m2_ = 0.0;
  Nearest best_;
  std::optional<Candidates> candidates_;
  std::optional<std::array<geometry::OrientedBox, kMaxOriented>> part_boxes_;
  std::optional<std::array<geometry::Box, kMaxGroups>> group_boxes_;
};

}  // namespace camway::scene
