// SPDX-License-Identifier: MIT
#include "daemon/correction/narrow/corridor.h"

#include <algorithm>

#include <Eigen/Eigenvalues>

#include "daemon/correction/narrow/centering.h"
#include "daemon/correction/narrow/near_pairs.h"

namespace camway::correction {

namespace {

using geometry::Vec3;
using motion::SignedPose;

// Chosen by measurement; none changes what is proved. Lengths are shares of the ball's radius.
constexpr double kOpenGap = 0.25;  // gap from which the body has room
constexpr double kLongestStepOut = 0.2;
constexpr double kShortestStepOut = 0.005;
constexpr double kLongestWayOut = 12.0;  // length of a way
constexpr double kNearestPairs = 3.0;  // gap of the pairs that lead the way, relative to the least
constexpr double kHabit = 1e-3;        // of the last direction, relative to all pairs
constexpr double kLeastAhead = 0.9;    // cosine between two steps
constexpr double kBeforeHit = 0.95;    // share of a motion that is free
constexpr double kBeyond = 0.75;       // length of a way beyond where the goal is seen first

/// The direction in which the nearest pairs change least; `before_W` where there are none.
Vec3 direction_W(FreeSpace& space, const motion::Pose& pose, double gap_m, const Vec3& before_W) {
  const double horizon_m =
      std::max(kNearestPairs * gap_m, kShortestStepOut * space.ball_radius_m());
  const std::vector<NearPair> pairs = near_pairs(space, pose, horizon_m);
  if (pairs.empty()) return before_W;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const NearPair& pair : pairs) sum += pair.away_W * pair.away_W.transpose();
  // Where several directions change nothing, the last one goes on.
  sum -= kHabit * sum.trace() * before_W * before_W.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(sum);
  const Vec3 least_W = solver.eigenvectors().col(0);
  return least_W.dot(before_W) < 0.0 ? Vec3(-least_W) : least_W;
}

class Walker {
 public:
  Walker(FreeSpace& space, RoomTest room_test, const SignedPose* goal, double margin_m,
         const base::Deadline& deadline)
      : space_(space),
        room_test_(room_test),
        goal_(goal),
        margin_m_(margin_m),
        deadline_(deadline),
        radius_m_(space.ball_radius_m()) {}

  std::optional<Guide> run(const SignedPose& from, Vec3 along_W) {
    Guide guide = {from};
    double step_m = kLongestStepOut * radius_m_;
    double walked_m = 0.0;
    while (!is_open(guide.back())) {
      if (goal_ && is_free(guide.back(), *goal_)) {
        guide.push_back(*goal_);
        break;
      }
      if (deadline_.passed() || walked_m > kLongestWayOut * radius_m_) return std::nullopt;
      const std::optional<SignedPose> next = next_of(guide, along_W, step_m);
      if (!next) return std::nullopt;
      walked_m += (next->position - guide.back().position).norm();
      guide.push_back(*next);
      step_m = std::min(1.5 * step_m, kLongestStepOut * radius_m_);
    }
    return guide;
  }

  /// A straight way along `along_W` to where a straight motion to the goal is free, and some way
  /// beyond. Requires a goal.
  std::optional<Guide> straight(const SignedPose& from, const Vec3& along_W) {
    const auto at = [&](double way_m) {
      return SignedPose{from.position + way_m * along_W, from.orientation};
    };
    const double longest_m = kLongestWayOut * radius_m_;
    const double free_m =
        kBeforeHit * longest_m * space_.first_hit(from, at(longest_m), margin_m_).value_or(1.0);
    const double step_m = kLongestStepOut * radius_m_;
    for (double way_m = 0.0; way_m <= free_m && !deadline_.passed(); way_m += step_m) {
      if (!is_free(at(way_m), *goal_)) continue;
      const SignedPose beyond = at(std::min(way_m + kBeyond * radius_m_, free_m));
      return Guide{from, is_free(beyond, *goal_) ? beyond : at(way_m), *goal_};
    }
    return std::nullopt;
  }

 private:
  /// The pose after the longest step that is free. Turns `along_W` and shortens `step_m`.
  [[nodiscard]] std::optional<SignedPose> next_of(const Guide& guide, Vec3& along_W,
                                                  double& step_m) {
    const motion::Pose here = motion::unsigned_pose(guide.back());
    Vec3 ahead_W = direction_W(space_, here, gap_m_, along_W);
    // At the end of a narrow place, its contacts no longer lead along it.
    if (guide.size() > 1 && ahead_W.dot(along_W) < kLeastAhead) ahead_W = along_W;
    along_W = ahead_W;
    // Nothing of the scene is near that could say where to go: the bounds alone are.
    if (along_W.isZero(0.0)) return std::nullopt;
    std::optional<SignedPose> next = stepped(guide.back(), step_m * ahead_W);
    for (; !next && step_m > kShortestStepOut * radius_m_; step_m *= 0.5) {
      next = stepped(guide.back(), 0.5 * step_m * ahead_W);
    }
    return next;
  }

  /// Also notes the gap there.
  [[nodiscard]] bool is_open(const SignedPose& at) {
    const motion::Pose pose = motion::unsigned_pose(at);
    gap_m_ = space_.gap_m(pose, kOpenGap * radius_m_);
    return (room_test_ == RoomTest::kGap && gap_m_ >= kOpenGap * radius_m_) ||
           space_.ball_gap_m(space_.center_W(pose), radius_m_, 0.01 * radius_m_) > 0.0;
  }

  /// The pose after a step, centred where the motion there is free.
  [[nodiscard]] std::optional<SignedPose> stepped(const SignedPose& from, const Vec3& by_W) {
    const SignedPose next{from.position + by_W, from.orientation};
    if (!is_free(from, next)) return std::nullopt;
    const Centered there = centered(space_, motion::unsigned_pose(next), kOpenGap * radius_m_,
                                    by_W.normalized(), deadline_);
    const SignedPose central = signed_like(there.pose, from);
    return is_free(from, central) ? central : next;
  }

  [[nodiscard]] bool is_free(const SignedPose& from, const SignedPose& to) {
    return space_.passes(from, to, margin_m_);
  }

  FreeSpace& space_;
  const RoomTest room_test_;
  const SignedPose* const goal_;  ///< a pose to which the way may lead instead; may be null
  const double margin_m_;
  const base::Deadline& deadline_;
  const double radius_m_;
  double gap_m_ = 0.0;
};

}  // namespace

std::optional<Guide> way_out(FreeSpace& space, const SignedPose& from, const Vec3& along_W,
                             RoomTest room_test, double margin_m, const base::Deadline& deadline) {
  return Walker(space, room_test, nullptr, margin_m, deadline).run(from, along_W);
}

std::optional<Guide> way_out(FreeSpace& space, const SignedPose& from, RoomTest room_test,
                             const base::Deadline& deadline) {
  const motion::Pose pose = motion::unsigned_pose(from);
  const double gap_m = space.gap_m(pose, space.ball_radius_m());
  const Vec3 along_W = direction_W(space, pose, gap_m, Vec3::Zero());
  for (const double sign : {1.0, -1.0}) {
    std::optional<Guide> found =
        way_out(space, from, sign * along_W, room_test, kMarginOfGap * gap_m, deadline);
    if (found) return found;
  }
  return std::nullopt;
}

std::optional<Guide> corridor(FreeSpace& space, const SignedPose& middle, const Vec3& along_W,
                              double margin_m, const base::Deadline& deadline,
                              const CorridorGoals* goals) {
  const auto out = [&](const Vec3& to_W, const SignedPose* goal) {
    Walker walker(space, RoomTest::kGap, goal, margin_m, deadline);
    std::optional<Guide> found = goal ? walker.straight(middle, to_W) : std::nullopt;
    return found ? found : walker.run(middle, to_W);
  };
  Vec3 axis_W = along_W;
  if (goals) {
    const motion::Pose pose = motion::unsigned_pose(middle);
    axis_W = direction_W(space, pose, space.gap_m(pose, space.ball_radius_m()), along_W);
  }
  std::optional<Guide> back = out(-axis_W, goals ? &goals->back : nullptr);
  if (!back) return std::nullopt;
  std::optional<Guide> forth = out(axis_W, goals ? &goals->forth : nullptr);
  if (!forth) return std::nullopt;
  std::ranges::reverse(*back);
  back->insert(back->end(), forth->begin() + 1, forth->end());
  return shortened(*back, space, margin_m);
}

}  // namespace camway::correction
