// SPDX-License-Identifier: MIT
#include "daemon/correction/search/free_pose.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace camway::correction {

namespace {

using geometry::Vec3;

constexpr double kFirstShell = 0.02;  // radii
constexpr double kLeastShell = 1e-6;  // of the farthest, which bounds the number of shells
constexpr double kShellGrowth = 1.2;  // ratio of a shell to the one before
// Ratio of the last shell to the first with a free pose. The direction found there may be off the
// nearest by up to 20 degrees, 1 / cos of which is 1.06; the direction of another free region is
// not limited.
constexpr double kBeyondFirst = 1.25;
constexpr int kShellSide = 2;  // half of a shell's points along an edge of a cube
constexpr std::size_t kMostFreePlaces = 6;
constexpr double kSamePlace = 0.75;  // cosine between directions

constexpr double kFirstSwing_rad = 0.3;  // first angle of variations of a direction
constexpr double kLastSwing_rad = 0.01;
constexpr int kSwings = 8;  // about the direction
constexpr int kMostSwingSteps = 40;

class Search {
 public:
  Search(FreeSpace& space, const motion::Pose& pose, double margin_m, const PoseRule& will_do,
         const base::Deadline& deadline)
      : space_(space), pose_(pose), margin_m_(margin_m), will_do_(will_do), deadline_(deadline) {}

  std::optional<FreePose> run() {
    std::vector<Move> found = on_shells(directions());
    std::ranges::stable_sort(found, {}, &Move::by_m);
    std::vector<Move> places;
    for (const Move& move : found) {
      const bool is_seen = std::ranges::any_of(places, [&](const Move& place) {
        return place.direction_W.dot(move.direction_W) > kSamePlace;
      });
      if (!is_seen && places.size() < kMostFreePlaces) places.push_back(improved(move));
    }
    if (places.empty()) return std::nullopt;
    const Move best = best_of(places);
    return FreePose{moved(best.direction_W, best.by_m), best.by_m};
  }

 private:
  struct Move {
    Vec3 direction_W;  ///< of unit length
    double by_m = 0.0;
  };

  [[nodiscard]] motion::Pose moved(const Vec3& direction_W, double by_m) const {
    return {pose_.position + by_m * direction_W, pose_.orientation};
  }

  bool will_do(const Vec3& direction_W, double by_m) {
    if (deadline_.passed()) return false;
    const motion::Pose there = moved(direction_W, by_m);
    return space_.is_free(there, margin_m_) && will_do_(there);
  }

  /// Directions evenly over a cube, and along the normal of the deepest contact.
  std::vector<Vec3> directions() {
    std::vector<Vec3> directions_W;
    if (const std::optional<collision::Witness> contact = space_.contact(pose_, 0.0)) {
      const Vec3 normal_W = space_.obstacles().normal_W(contact->triangle).stableNormalized();
      directions_W = {normal_W, -normal_W};
    }
    for (int x = -kShellSide; x <= kShellSide; ++x) {
      for (int y = -kShellSide; y <= kShellSide; ++y) {
        for (int z = -kShellSide; z <= kShellSide; ++z) {
          const Vec3 at(x, y, z);
          if (at.cwiseAbs().maxCoeff() == kShellSide) directions_W.push_back(at.normalized());
        }
      }
    }
    return directions_W;
  }

  /// For each direction the first shell on which the body is free, up to `kBeyondFirst` times the
  /// nearest.
  std::vector<Move> on_shells(std::vector<Vec3> directions_W) {
    std::vector<Move> found;
    const double reach_m =
        kFreePoseReach * (space_.ball_radius_m() + space_.query().required_clearance_m());
    double last_m = reach_m;
    double below_m = 0.0;
    const double first_m = std::max(kFirstShell * space_.ball_radius_m(), kLeastShell * reach_m);
    // The shells of a body whose size is a subnormal number do not grow.
    for (double shell_m = first_m; shell_m > below_m && shell_m <= last_m && !deadline_.passed();
         below_m = shell_m, shell_m *= kShellGrowth) {
      std::erase_if(directions_W, [&](const Vec3& direction_W) {
        if (!will_do(direction_W, shell_m)) return false;
        found.push_back({direction_W, least_m(direction_W, below_m, shell_m)});
        last_m = std::min(last_m, kBeyondFirst * shell_m);
        return true;
      });
    }
    return found;
  }

  /// Bisects between a move that fails and one that succeeds.
  double least_m(const Vec3& direction_W, double below_m, double above_m) {
    while (above_m - below_m > kFreePosePrecision * above_m) {
      const double middle_m = 0.5 * (below_m + above_m);
      (will_do(direction_W, middle_m) ? above_m : below_m) = middle_m;
    }
    return above_m;
  }

  /// Pattern search over directions about the best one, at decreasing angles.
  Move improved(Move best) {
    int steps = 0;
    for (double swing_rad = kFirstSwing_rad; swing_rad > kLastSwing_rad;) {
      const std::optional<Move> better = better_near(best, swing_rad);
      if (better) best = *better;
      if (!better || ++steps > kMostSwingSteps) swing_rad *= 0.5;
    }
    return best;
  }

  std::optional<Move> better_near(const Move& best, double swing_rad) {
    const Vec3 u = best.direction_W.unitOrthogonal();
    const Vec3 v = best.direction_W.cross(u);
    const double aimed_m = (1.0 - 0.5 * kFreePosePrecision) * best.by_m;
    for (int k = 0; k < kSwings; ++k) {
      const double angle_rad = 2.0 * std::numbers::pi * k / kSwings;
      const Vec3 aside = std::cos(angle_rad) * u + std::sin(angle_rad) * v;
      const Vec3 direction_W = (best.direction_W + std::tan(swing_rad) * aside).normalized();
      if (will_do(direction_W, aimed_m))
        return Move{direction_W, least_m(direction_W, 0.0, aimed_m)};
    }
    return std::nullopt;
  }

  Move best_of(const std::vector<Move>& places) {
    const double least_m = std::ranges::min(places, {}, &Move::by_m).by_m;
    const Move* best = nullptr;
    double most_room_m = -1.0;
    for (const Move& place : places) {
      if (place.by_m > least_m * (1.0 + kFreePosePrecision)) continue;
      const double radius_m = space_.ball_radius_m();
      const double room_m = space_.gap_m(moved(place.direction_W, place.by_m + radius_m), radius_m);
      if (room_m <= most_room_m) continue;
      best = &place;
      most_room_m = room_m;
    }
    return best != nullptr ? *best : places.front();
  }

  FreeSpace& space_;
  const motion::Pose& pose_;
  const double margin_m_;
  const PoseRule& will_do_;
  const base::Deadline& deadline_;
};

}  // namespace

std::optional<FreePose> nearest_free_pose(FreeSpace& space, const motion::Pose& pose,
                                          double margin_m, const PoseRule& will_do,
                                          const base::Deadline& deadline) {
  // From beyond the bounds the way back is straight, however long.
  const motion::Pose inside = space.within_bounds(pose, (1.0 + kFreePosePrecision) * margin_m);
  const double moved_m = (inside.position - pose.position).norm();
  if (moved_m > 0.0 && space.is_free(inside, margin_m) && will_do(inside))
    return FreePose{inside, moved_m};
  std::optional<FreePose> found = Search(space, inside, margin_m, will_do, deadline).run();
  if (found && moved_m > 0.0) found->moved_m = (found->pose.position - pose.position).norm();
  return found;
}

}  // namespace camway::correction
