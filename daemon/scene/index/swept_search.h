// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/scene/index/body_search.h"

namespace camway::scene {

/// Estimates how many times as long as this motion another one may be that begins with `room_m` to
/// spare. Over this motion that room changes by `change_m`, and the bend takes `bend_m` of it.
double way_ahead(double room_m, double change_m, double bend_m);
/// Largest ratio of bend to reach at which a motion counts as nearly straight. A motion that bends
/// more allows no estimate for a shorter one.
inline constexpr double kStraightWay = 0.3;

/// The search of `SceneIndex::passage`: whether a moving body keeps its distance from the scene.
class PassageSearch : public BodySearch {
 public:
  /// `body` must outlive this object. `ends_box` bounds its ends; `error_m` as for `BodySearch`.
  PassageSearch(const MovingBody& body, const geometry::Box& ends_box, double error_m);

  [[nodiscard]] Passage passage() const;

 private:
  /// Most near triangles that are proved clear one by one; with more in reach, shorter motions are
  /// cheaper.
  static constexpr int kMostPassed = 32;

  void ask_pair(std::size_t part, const geometry::Triangle& triangle, std::uint32_t index) final;
  /// Whether a slab across `direction` proves that the motion is clear of `triangle`.
  bool passes(std::span<const geometry::Triangle> ends, const geometry::Triangle& triangle,
              const geometry::Vec3& direction);
  void stop_before(std::span<const geometry::Triangle> ends, const geometry::Triangle& triangle);

  const MovingBody& body_;
  int passed_ = 0;
  bool is_clear_ = true;
  Nearest nearest_;
  double ahead_ = std::numeric_limits<double>::infinity();
};

}  // namespace camway::scene
