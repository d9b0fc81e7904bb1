// SPDX-License-Identifier: MIT
#include "daemon/correction/search/tree_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "daemon/motion/path/quaternion.h"

namespace camway::correction {

namespace {

using geometry::Vec3;
using geometry::Vec4;
using motion::SignedPose;

// Chosen by measurement.
constexpr double kStraightShare = 0.25;  // samples whose orientation is between the ends'
constexpr double kBlockedShare = 0.35;   // samples next to where a motion was blocked
constexpr double kBackOff = 0.92;        // share of the way to an obstacle
constexpr double kLeastStep = 0.02;      // share of the ball's radius
constexpr double kLeastDot = 0.2;        // least dot product of the quaternions of one motion
constexpr std::size_t kBlockedKept = 64;
constexpr int kReaches = 4;  // distances of samples from the way, each half the one before
constexpr double kMostHalvings = 3.0;   // of what samples differ from a blocked motion
constexpr double kBesideBlocked = 0.7;  // the largest difference, in radii of the ball and radians

class Tree {
 public:
  explicit Tree(const SignedPose& root) : poses_{root}, parents_{0} {}

  [[nodiscard]] std::size_t nearest(const SignedPose& pose, double radius_m) const {
    const double scale_m2 = 16.0 * radius_m * radius_m;  // a turn is four times the chord on S³
    std::size_t best = 0;
    double least_m2 = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      const double distance_m2 =
          (poses_[i].position - pose.position).squaredNorm() +
          scale_m2 * (poses_[i].orientation - pose.orientation).squaredNorm();
      if (distance_m2 < least_m2) {
        least_m2 = distance_m2;
        best = i;
      }
    }
    return best;
  }

  std::size_t add(const SignedPose& pose, std::size_t parent) {
    poses_.push_back(pose);
    parents_.push_back(parent);
    return poses_.size() - 1;
  }

  [[nodiscard]] const SignedPose& pose(std::size_t index) const { return poses_[index]; }

  /// The poses from `index` to the root.
  [[nodiscard]] Guide branch(std::size_t index) const {
    Guide guide = {poses_[index]};
    while (index != 0) {
      index = parents_[index];
      guide.push_back(poses_[index]);
    }
    return guide;
  }

 private:
  std::vector<SignedPose> poses_;
  std::vector<std::size_t> parents_;
};

class TreeSearch {
 public:
  TreeSearch(FreeSpace& space, const SignedPose& from, const SignedPose& to,
             const TreeOptions& options)
      : space_(space),
        options_(options),
        from_(from),
        to_(to),
        trees_{Tree(from), Tree(to)},
        random_(options.seed) {}

  TreeResult run(const base::Deadline& deadline) {
    std::size_t side = 0;
    if (grow(side, to_).reached) return {{from_, to_}};
    std::int32_t samples = 0;
    for (; samples < options_.max_samples && !deadline.passed(); side = 1 - side) {
      const Growth grown = grow(side, sample(samples));
      ++samples;
      if (!grown.node) continue;
      const SignedPose met = trees_[side].pose(*grown.node);
      const Growth other = grow(1 - side, met);
      if (other.reached) return {path_through(side, *grown.node, *other.node), samples};
    }
    return {{}, samples};
  }

 private:
  struct Growth {
    std::optional<std::size_t> node;
    bool reached = false;
  };

  // Extends the tree from its nearest pose towards `target` as far as the motion is free.
  Growth grow(std::size_t side, const SignedPose& target) {
    Tree& tree = trees_[side];
    const std::size_t nearest = tree.nearest(target, space_.ball_radius_m());
    const SignedPose from = tree.pose(nearest);
    if (from.orientation.dot(target.orientation) < kLeastDot) return {};
    const std::optional<double> hit = space_.first_hit(from, target, options_.margin_m);
    if (!hit) return {tree.add(target, nearest), true};
    const SignedPose stop = motion::between(from, target, kBackOff * *hit);
    remember_blocked(motion::between(from, target, *hit));
    if (space_.distance_m(from, stop) < kLeastStep * space_.ball_radius_m()) return {};
    return {tree.add(stop, nearest), false};
  }

  void remember_blocked(const SignedPose& pose) {
    if (blocked_.size() < kBlockedKept) {
      blocked_.push_back(pose);
    } else {
      blocked_[next_blocked_++ % kBlockedKept] = pose;
    }
  }

  // Uniform in [0, 1). Not std::uniform_real_distribution, which libraries implement differently.
  double uniform() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  double normal() {
    // Irwin-Hall approximation of the normal distribution.
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum;
  }
  Vec3 normal_vector() {
    const double x = normal();
    const double y = normal();
    const double z = normal();
    return {x, y, z};
  }

  SignedPose turned(const SignedPose& pose, double angle_rad) {
    const Vec3 axis = normal_vector().normalized();
    if (!axis.allFinite()) return pose;
    const geometry::Quat turn(Eigen::AngleAxisd(angle_rad, axis));
    // Turn about the centre of the body, so that translation and rotation are independent.
    const geometry::Quat old = geometry::from_wxyz(pose.orientation);
    const Vec3 center_W = pose.position + old * space_.center_C();
    const Vec4 q =
        motion::quaternion::multiply(geometry::wxyz(turn), pose.orientation).normalized();
    return {center_W - geometry::from_wxyz(q) * space_.center_C(), q};
  }

  SignedPose sample(int index) {
    if (!blocked_.empty() && uniform() < kBlockedShare) return next_to_blocked();
    const double share = uniform();
    const SignedPose straight = motion::between(from_, to_, share);
    // The reach cycles through fractions, so samples are drawn at several distances from the way.
    const double reach_m = options_.reach_m * std::exp2(-static_cast<double>(index % kReaches));
    Vec3 center_W = along_way_W(share);
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      center_W[axis] += reach_m * (2.0 * uniform() - 1.0);
    const geometry::Quat q = geometry::from_wxyz(straight.orientation);
    const SignedPose pose{center_W - q * space_.center_C(), straight.orientation};
    if (uniform() < kStraightShare) return allowed(pose);
    return allowed(turned(pose, options_.largest_turn_rad * uniform()));
  }

  /// `pose`, turned as far as the orientation policy asks for.
  [[nodiscard]] SignedPose allowed(const SignedPose& pose) const {
    if (!is_limited(space_.policy())) return pose;
    const double share = share_near(space_.center_W(motion::unsigned_pose(pose)));
    return space_.allowed(pose, pose_at_share(options_.interpolated, share));
  }

  /// Share of the way at its point nearest to `center_W`.
  [[nodiscard]] double share_near(const Vec3& center_W) const {
    double least_m2 = std::numeric_limits<double>::infinity();
    double share = 0.0;
    for (std::size_t i = 0; i + 1 < options_.about_W.size(); ++i) {
      const Vec3 step = options_.about_W[i + 1] - options_.about_W[i];
      const Vec3 from = center_W - options_.about_W[i];
      const double length_m2 = step.squaredNorm();
      const double rest = length_m2 > 0.0 ? std::clamp(from.dot(step) / length_m2, 0.0, 1.0) : 0.0;
      const double distance_m2 = (from - rest * step).squaredNorm();
      if (distance_m2 >= least_m2) continue;
      least_m2 = distance_m2;
      share = (static_cast<double>(i) + rest) / static_cast<double>(options_.about_W.size() - 1);
    }
    return share;
  }

  [[nodiscard]] Vec3 along_way_W(double share) const {
    const auto last = static_cast<double>(options_.about_W.size() - 1);
    const auto i = static_cast<std::size_t>(std::min(share * last, last - 1.0));
    const double rest = share * last - static_cast<double>(i);
    return (1.0 - rest) * options_.about_W[i] + rest * options_.about_W[i + 1];
  }

  SignedPose next_to_blocked() {
    const auto which = static_cast<std::size_t>(uniform() * static_cast<double>(blocked_.size()));
    SignedPose pose = blocked_[which];
    const double size = std::exp2(-kMostHalvings * uniform());
    pose.position += kBesideBlocked * size * space_.ball_radius_m() * normal_vector();
    return allowed(turned(pose, kBesideBlocked * size * std::abs(normal())));
  }

  [[nodiscard]] Guide path_through(std::size_t side, std::size_t node, std::size_t other) const {
    Guide first = trees_[side].branch(node);
    Guide second = trees_[1 - side].branch(other);
    std::ranges::reverse(first);
    // Both branches contain the pose where they met.
    first.insert(first.end(), second.begin() + 1, second.end());
    if (side == 1) std::ranges::reverse(first);
    return first;
  }

  FreeSpace& space_;
  const TreeOptions& options_;
  const SignedPose from_;
  const SignedPose to_;
  std::array<Tree, 2> trees_;
  std::mt19937_64 random_;
  std::vector<SignedPose> blocked_;
  std::size_t next_blocked_ = 0;
};

}  // namespace

TreeResult tree_way(FreeSpace& space, const SignedPose& from, const SignedPose& to,
                    const TreeOptions& options, const base::Deadline& deadline) {
  return TreeSearch(space, from, to, options).run(deadline);
}

}  // namespace camway::correction
