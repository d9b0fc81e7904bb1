// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/scene/index/body_search.h"

namespace camway::scene {

/// How many times as long a way may be that begins with `room_m`, if that changes by `change_m` on
/// this one, and bend takes `bend_m` of it: an estimate.
double way_ahead(double room_m, double change_m, double bend_m);
/// A way that strays more than this share of its reach from a straight one tells nothing of a
/// shorter one but that it is shorter.
inline constexpr double kStraightWay = 0.3;

/// Asks what is near the way of a body whether the body keeps away from it; see
/// `SceneIndex::passage`.
class PassageSearch : public BodySearch {
 public:
  /// Arguments as those of `BodySearch`; `ends_box` is around both ends.
  PassageSearch(const MovingBody& body, const geometry::Box& ends_box, double error_m);

  [[nodiscard]] Passage passage() const;

 private:
  /// So many near triangles are passed one by one; with more in sight, shorter ways are cheaper.
  static constexpr int kMostPassed = 32;

  void ask_pair(std::size_t part, const geometry::Triangle& triangle, std::uint32_t index) final;
  /// Whether the way is proved to be clear of `triangle`, across `direction`.
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
