// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/correction/path/free_space.h"
#include "daemon/correction/search/cell_numbers.h"
#include "daemon/correction/search/lattice_search.h"

namespace camway::correction {

/// A lattice of points in the scene, for a search. Decides where the ball fits and which steps are
/// free, and computes by how much the cost of a step exceeds its length.
/// Not thread-safe.
class Lattice {
 public:
  /// Refers to `space` and `options`, which must outlive it.
  Lattice(const FreeSpace& space, const geometry::Vec3& from_W, const geometry::Vec3& to_W,
          const LatticeOptions& options);

  [[nodiscard]] geometry::Vec3 place_W(CellKey key) const {
    const Cell cell = cell_of(key);
    return from_W_ + options_.spacing_m * geometry::Vec3(cell[0], cell[1], cell[2]);
  }
  [[nodiscard]] const geometry::Vec3& end_W() const { return to_W_; }

  /// Returns `kLatticeGreed` times the length of the shortest way to the end on the lattice without
  /// obstacles: along diagonals of cells as far as they lead nearer, then along diagonals of faces,
  /// then along edges.
  [[nodiscard]] double rest_m(CellKey key) const;

  /// Gap and extra costs at a point.
  struct Surroundings {
    double gap_m;        ///< gap of the ball; 0 within an avoided ball
    double near = 0.0;   ///< relative extra cost of steps near the scene
    double stray = 0.0;  ///< relative extra cost of steps away from the preferred way
  };
  [[nodiscard]] Surroundings about(const geometry::Vec3& place_W) const;

  /// Returns whether the ball passes from one point to the other, at which it has these gaps.
  [[nodiscard]] bool step_is_free(const geometry::Vec3& a_W, double gap_a_m,
                                  const geometry::Vec3& b_W, double gap_b_m) const;
  /// Returns whether the ball passes from a point with that gap to the end, which must be near.
  [[nodiscard]] bool meets_end(const geometry::Vec3& place_W, double gap_m) const;

 private:
  /// A leg of the preferred way.
  struct Leg {
    Leg(const geometry::Vec3& begin_W, const geometry::Vec3& end_W)
        : from_W(begin_W), along_W(end_W - begin_W), square_m2(along_W.squaredNorm()) {}

    [[nodiscard]] double squared_distance_m2(const geometry::Vec3& place_W) const;

    geometry::Vec3 from_W;
    geometry::Vec3 along_W;
    double square_m2;
  };

  [[nodiscard]] double gap_m(const geometry::Vec3& point_W) const;
  /// Lower bound of the gap. `ball_gap_m` may overestimate, and the ball would step through thin
  /// walls.
  [[nodiscard]] double sure_gap_m(double gap_m) const;
  [[nodiscard]] bool is_avoided(const geometry::Vec3& place_W) const;

  const FreeSpace& space_;
  const geometry::Vec3 from_W_;
  const geometry::Vec3 to_W_;
  const LatticeOptions& options_;
  const double comfort_m_;  ///< gap from which a point is not near the scene
  const double horizon_m_;  ///< largest gap that is asked for
  std::vector<Leg> legs_;
  mutable std::optional<std::uint32_t> met_;  ///< what the last blocked step meets: tried first
};

}  // namespace camway::correction
