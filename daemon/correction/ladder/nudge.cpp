// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/nudge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

#include "daemon/correction/ladder/window.h"
#include "daemon/correction/path/closeness.h"
#include "daemon/correction/path/guide.h"
#include "daemon/correction/path/orientation_rule.h"
#include "daemon/correction/smoothing/relaxation.h"
#include "daemon/motion/path/quaternion.h"

namespace camway::correction {

namespace {

using geometry::Quat;
using geometry::Vec3;
using geometry::Vec4;
using motion::CubicPoint;
using motion::Pose;
using motion::SignedPose;

// Chosen by measurement; none changes what is proved.
constexpr int kFan = 8;                   // directions across the way
constexpr double kSameDirection = 0.98;   // cosine
constexpr double kLeastStepShare = 0.06;  // first amount tried, as a share of the radius
constexpr double kGrowth = 2.0;           // from one amount to the next
constexpr double kFarthest = 4.0;         // radii, or ...
constexpr double kFarthestShift = 0.3;    // ... this share of the viewing distance, if that is more
constexpr double kShareAside = 0.8;       // share of the amount that is needed beside the middle
constexpr int kHalvings = 2;              // bisections of the last step
// Margins of a pose, as shares of the radius: the first that some direction can keep.
constexpr std::array<double, 2> kMarginShares = {0.1, 0.02};
constexpr double kLargestTurn_rad = 0.8;
constexpr double kLargestTurnStep_rad = 0.08;  // turned too far, the body is stuck again
constexpr double kMoreEachTime = 1.35;
constexpr int kMostAttempts = 4;
constexpr int kMostWidths = 2;       // spacings of knots, each half of the one before
constexpr int kMostWays = 2;         // directions that are tried as bumps
constexpr double kWorseWay = 2.5;    // a direction that needs so much more is not tried
constexpr double kLeastPeak = 0.1;   // least share of a bump at the collision
constexpr double kTurnHeight = 1.0;  // height of a bump that turns, in turning levers a radian

/// A nudge: direction of the translation, or axis of the turn, and amount.
struct Way {
  Vec3 direction_W;
  double amount = 0.0;  ///< metres or radians
};

/// Adds a unit vector, unless there is one of about the same direction.
void add_new(const Vec3& direction, std::vector<Vec3>& directions) {
  const bool is_known = std::ranges::any_of(
      directions, [&](const Vec3& other) { return direction.dot(other) > kSameDirection; });
  if (!is_known) directions.push_back(direction);
}

class Nudger {
 public:
  Nudger(const Problem& problem, std::span<const collision::CollisionInterval> collisions,
         NudgeKind kind, base::Budget& budget, FreeSpace& space, const base::Deadline& deadline)
      : problem_(problem),
        kind_(kind),
        budget_(budget),
        space_(space),
        deadline_(deadline),
        middle_s_(0.5 * (problem.interval.t_begin_s + problem.interval.t_end_s)),
        length_s_(problem.interval.t_end_s - problem.interval.t_begin_s),
        radius_m_(space.ball_radius_m()) {
    add_sample(middle_s_, 1.0);
    // The ends of a collision are free, so less is needed away from its middle.
    for (const collision::CollisionInterval& collision : collisions) {
      const double middle_s = 0.5 * (collision.t_begin_s + collision.t_end_s);
      const double length_s = collision.t_end_s - collision.t_begin_s;
      if (collisions.size() > 1) add_sample(middle_s, 1.0);
      for (const double place : {-0.3, 0.3}) {
        add_sample(middle_s + place * length_s, kShareAside);
      }
    }
  }

  NudgeResult run() {
    NudgeResult result;
    const std::vector<Way> ways = shortest_ways();
    double least_cost = std::numeric_limits<double>::infinity();
    for (const Way& way : ways) {
      if (deadline_.passed()) break;
      std::optional<Candidate> found = with_way(way);
      if (!found) continue;
      const double cost = closeness_cost(found->path, problem_.original, space_.closeness());
      if (cost < least_cost) {
        least_cost = cost;
        result.candidate = std::move(found);
      }
    }
    result.effort = effort_;
    return result;
  }

 private:
  struct Sample {
    SignedPose pose;
    Pose interpolated;
    double share;
  };

  void add_sample(double time_s, double share) {
    samples_.push_back(
        {signed_pose_at(problem_.path, time_s), problem_.original.pose(time_s), share});
  }

  /// The sample moved or turned by `amount`, as far as the orientation policy allows.
  [[nodiscard]] SignedPose nudged(const Sample& sample, const Vec3& direction_W,
                                  double amount) const {
    return space_.allowed(moved_or_turned(sample.pose, direction_W, amount), sample.interpolated);
  }

  [[nodiscard]] SignedPose moved_or_turned(const SignedPose& pose, const Vec3& direction_W,
                                           double amount) const {
    if (kind_ == NudgeKind::kMove) {
      return {pose.position + amount * direction_W, pose.orientation};
    }
    const Vec4 turn = geometry::wxyz(Quat(Eigen::AngleAxisd(amount, direction_W)));
    const SignedPose turned{pose.position, motion::quaternion::multiply(turn, pose.orientation)};
    const Vec3 center_W = space_.center_W(motion::unsigned_pose(pose));
    const Quat orientation = geometry::from_wxyz(turned.orientation);
    return {space_.pose_around(center_W, orientation).position, turned.orientation};
  }

  [[nodiscard]] bool is_enough(const Vec3& direction_W, double amount) {
    return std::ranges::all_of(samples_, [&](const Sample& sample) {
      const SignedPose pose = nudged(sample, direction_W, sample.share * amount);
      return space_.is_free(motion::unsigned_pose(pose), margin_m_);
    });
  }

  /// Returns about the least amount in that direction that frees the samples; nothing if none up to
  /// `limit` does.
  std::optional<double> least_amount(const Vec3& direction_W, double limit) {
    const double first = kind_ == NudgeKind::kMove ? kLeastStepShare * radius_m_ : 0.02;
    double below = 0.0;
    double above = first;
    while (!is_enough(direction_W, above)) {
      if (above >= limit) return std::nullopt;
      below = above;
      double next = kGrowth * above;
      if (kind_ == NudgeKind::kTurn) next = std::min(next, above + kLargestTurnStep_rad);
      above = std::min(next, limit);
    }
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (below + above);
      (is_enough(direction_W, middle) ? above : below) = middle;
    }
    return above;
  }

  [[nodiscard]] std::vector<Vec3> directions_W() {
    const Quat orientation = geometry::from_wxyz(samples_[0].pose.orientation);
    if (kind_ == NudgeKind::kTurn) return axes_W(orientation);
    std::vector<Vec3> directions = contact_directions_W();
    const Vec3 along = way_W();
    const Vec3 across = along.unitOrthogonal();
    for (int i = 0; i < kFan; ++i) {
      const double angle_rad = 2.0 * std::numbers::pi * i / kFan;
      add_new(Eigen::AngleAxisd(angle_rad, along) * across, directions);
    }
    return directions;
  }

  /// The axes of the camera, or the axes that keep it level if the policy demands that.
  [[nodiscard]] std::vector<Vec3> axes_W(const Quat& orientation) const {
    std::vector<Vec3> axes = {orientation * Vec3::UnitX(), orientation * Vec3::UnitY(),
                              orientation * Vec3::UnitZ()};
    if (space_.policy().rule == OrientationRule::kLevel) axes = {axes[0], space_.policy().up_W};
    std::vector<Vec3> both_ways;
    for (const Vec3& axis : axes) {
      both_ways.push_back(axis);
      both_ways.push_back(-axis);
    }
    return both_ways;
  }

  /// Direction of the path at the collision.
  [[nodiscard]] Vec3 way_W() const {
    const Vec3 way = samples_.back().pose.position - samples_[1].pose.position;
    const double length_m = way.norm();
    return length_m > 0.0 ? Vec3(way / length_m) : Vec3::UnitZ();
  }

  /// Along the normal of the deepest contact, and away from its point.
  [[nodiscard]] std::vector<Vec3> contact_directions_W() {
    std::vector<Vec3> directions;
    const auto add = [&](const Vec3& direction) {
      const double length = direction.norm();
      if (length > 0.0 && std::isfinite(length)) add_new(direction / length, directions);
    };
    const Pose pose = motion::unsigned_pose(samples_[0].pose);
    if (const std::optional<collision::Witness> contact = space_.contact(pose, 0.0)) {
      const Vec3 normal = space_.obstacles().normal_W(contact->triangle);
      add(normal);
      add(-normal);
      add(space_.center_W(pose) - contact->point_W);
    }
    return directions;
  }

  /// The nudges that free the samples with the largest margin that any can keep, the smallest
  /// first.
  std::vector<Way> shortest_ways() {
    const double largest_turn_rad =
        std::min(kLargestTurn_rad, kAimedShare * space_.policy().max_turn_rad);
    const double farthest_m =
        std::max(kFarthest * radius_m_, kFarthestShift * space_.closeness().viewing_distance_m);
    const double farthest = kind_ == NudgeKind::kMove ? farthest_m : largest_turn_rad;
    const std::vector<Vec3> all_W = directions_W();
    std::vector<Way> ways;
    for (const double share : kMarginShares) {
      margin_m_ = share * radius_m_;
      double limit = farthest;
      for (const Vec3& direction_W : all_W) {
        ++effort_.directions;
        const std::optional<double> amount = least_amount(direction_W, limit);
        if (!amount) continue;
        ways.push_back({direction_W, *amount});
        limit = std::min(limit, kWorseWay * *amount);
      }
      if (!ways.empty()) break;
    }
    std::ranges::stable_sort(ways, {}, &Way::amount);
    if (ways.size() > kMostWays) ways.resize(kMostWays);
    return ways;
  }

  std::optional<Candidate> with_way(const Way& way) {
    const double lever_m =
        kind_ == NudgeKind::kMove ? 1.0 : kTurnHeight * space_.closeness().turn_lever_m;
    double spacing_s = space_.closeness().best_spacing_s(way.amount * lever_m);
    for (int i = 0; i < kMostWidths; ++i, spacing_s *= 0.5) {
      if (std::optional<Candidate> found = with_width(way, spacing_s)) return found;
    }
    return std::nullopt;
  }

  std::optional<Candidate> with_width(const Way& way, double spacing_s) {
    collision::CollisionInterval about = problem_.interval;
    double amount = way.amount;
    for (int i = 0; i < kMostAttempts; ++i) {
      const motion::KnotRow knots =
          window_about(problem_, about.t_begin_s, about.t_end_s, spacing_s);
      if (!knots.fits()) return std::nullopt;
      const std::optional<Offsets> offsets = row_of(FreeCoefficients(problem_, knots, Ends::kFixed),
                                                    offset_of(way.direction_W, amount), about);
      if (!offsets) return std::nullopt;
      Attempt tried = attempt(problem_, {bumps_for(*offsets, Ends::kFixed)}, space_, deadline_);
      ++effort_.paths;
      if (tried.candidate) return improved(*offsets, std::move(*tried.candidate));
      const collision::CollisionInterval& left = *tried.collision;
      if (left.t_begin_s < about.t_end_s && left.t_end_s > about.t_begin_s) {
        amount *= kMoreEachTime;
        continue;
      }
      // The bump meets something beside the collision: lead the path round both.
      const bool is_near =
          left.t_end_s > about.t_begin_s - spacing_s && left.t_begin_s < about.t_end_s + spacing_s;
      if (!is_near) return std::nullopt;
      about.t_begin_s = std::min(about.t_begin_s, left.t_begin_s);
      about.t_end_s = std::max(about.t_end_s, left.t_end_s);
    }
    return std::nullopt;
  }

  Candidate improved(const Offsets& offsets, Candidate candidate) {
    const Improvement improvement{.may_turn = kind_ == NudgeKind::kTurn};
    Relaxed better = relaxed(problem_, {offsets, std::move(candidate)}, Ends::kFixed, improvement,
                             budget_, space_, deadline_);
    effort_.paths += better.paths;
    return std::move(better.candidate);
  }

  /// The offset by which the nudge changes the path at the middle of the collision.
  [[nodiscard]] CubicPoint offset_of(const Vec3& direction_W, double amount) const {
    const SignedPose wanted = nudged(samples_[0], direction_W, amount);
    const CubicPoint old = problem_.path.at(middle_s_);
    CubicPoint offset{wanted.position - old.position, Vec4::Zero()};
    if (wanted.orientation != samples_[0].pose.orientation) {
      const Vec4 image = motion::image_of(problem_.path.reference, wanted.orientation, old.image);
      offset.image = image * old.image.norm() - old.image;
    }
    return offset;
  }

  /// The row whose value is about `offset` in the time of the collision; nothing if it cannot be.
  [[nodiscard]] std::optional<Offsets> row_of(const FreeCoefficients& free,
                                              const CubicPoint& offset,
                                              const collision::CollisionInterval& about) const {
    // Least squares at the collision; the small term decides where bumps do not reach it.
    constexpr double kSmall = 1e-3;
    Eigen::MatrixXd squares = Eigen::MatrixXd::Identity(free.size(), free.size()) * kSmall;
    Eigen::VectorXd wanted = Eigen::VectorXd::Zero(free.size());
    for (const double place : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const Terms terms = free.at(std::lerp(about.t_begin_s, about.t_end_s, place));
      for (const Term& a : terms) {
        wanted[a.variable] += a.share;
        for (const Term& b : terms) squares(a.variable, b.variable) += a.share * b.share;
      }
    }
    Eigen::VectorXd shares = squares.ldlt().solve(wanted);
    double peak = 0.0;
    for (const Term& term : free.at(middle_s_)) peak += term.share * shares[term.variable];
    if (!(peak > kLeastPeak)) return std::nullopt;
    shares /= peak;
    const StackedPoints variables = shares * stacked(offset, 1.0).transpose();
    return free.offsets_of(variables, 1.0);
  }

  const Problem& problem_;
  const NudgeKind kind_;
  base::Budget& budget_;
  FreeSpace& space_;
  const base::Deadline& deadline_;
  const double middle_s_;
  const double length_s_;
  const double radius_m_;
  double margin_m_ = 0.0;
  std::vector<Sample> samples_;
  Effort effort_;
};

}  // namespace

NudgeResult nudge(const Problem& problem, std::span<const collision::CollisionInterval> collisions,
                  NudgeKind kind, base::Budget& budget, FreeSpace& space,
                  const base::Deadline& deadline) {
  return Nudger(problem, collisions, kind, budget, space, deadline).run();
}

}  // namespace camway::correction
