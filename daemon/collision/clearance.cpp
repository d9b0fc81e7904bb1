// SPDX-License-Identifier: MIT
#include "daemon/collision/clearance.h"

#include <algorithm>
#include <vector>

#include "daemon/collision/piece.h"

namespace camway::collision {

namespace {

// Rounding makes a computed bound too large by a few units of it at most: two sums and a product.
constexpr double kRoundDown = 1.0 - 4.0 * 2.220446049250313e-16;

class ClearanceSearch {
 public:
  ClearanceSearch(const scene::SceneIndex& index, const motion::Corners& corners_C,
                  const Deadline& deadline)
      : index_(index),
        corners_C_(corners_C),
        radius_m_(motion::body_radius_m(corners_C)),
        deadline_(deadline) {}

  std::optional<PathClearance> run(const motion::Path& path) {
    for (const motion::Segment& segment : path.segments()) waiting_.push_back({&segment, 0.0, 1.0});
    while (!waiting_.empty()) {
      if (deadline_.passed()) return std::nullopt;
      const Piece piece = waiting_.back();
      waiting_.pop_back();
      if (!settle(piece)) return PathClearance{0.0, upper_m_};
    }
    return PathClearance{std::min(lower_m_, upper_m_), upper_m_};
  }

 private:
  // Looks at a piece; false where no distance above 0 can be proved.
  bool settle(const Piece& piece) {
    const double enough_m = (1.0 - kClearanceGap) * upper_m_;
    const Look seen = look_at(index_, corners_C_, radius_m_, piece, enough_m);
    if (!seen.distance_m) {
      lower_m_ = std::min(lower_m_, enough_m);
      return true;
    }
    upper_m_ = std::min(upper_m_, *seen.distance_m + seen.rounding_m);
    const double everywhere_m =
        kRoundDown * *seen.distance_m - (seen.deviation_m + seen.rounding_m) / kRoundDown;
    if (everywhere_m >= (1.0 - kClearanceGap) * upper_m_) {
      lower_m_ = std::min(lower_m_, everywhere_m);
      return true;
    }
    // Where rounding alone hides the difference, splitting shows nothing more.
    const bool hopeless = seen.deviation_m <= seen.rounding_m || !piece.splittable();
    if (hopeless) lower_m_ = std::min(lower_m_, std::max(everywhere_m, 0.0));
    if (hopeless || *seen.distance_m == 0.0) return everywhere_m > 0.0;
    waiting_.push_back(piece.right());
    waiting_.push_back(piece.left());
    return true;
  }

  const scene::SceneIndex& index_;
  const motion::Corners& corners_C_;
  const double radius_m_;
  const Deadline& deadline_;

  std::vector<Piece> waiting_;
  double lower_m_ = kLargestClearance_m;
  double upper_m_ = kLargestClearance_m;
};

}  // namespace

std::optional<PathClearance> path_clearance(const scene::SceneIndex& index,
                                            const motion::Path& path,
                                            const motion::Corners& corners_C,
                                            const Deadline& deadline) {
  return ClearanceSearch(index, corners_C, deadline).run(path);
}

}  // namespace camway::collision
