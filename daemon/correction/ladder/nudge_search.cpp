// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/nudge_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "daemon/correction/path/guide.h"
#include "daemon/correction/path/orientation_rule.h"
#include "daemon/geometry/segment_triangle.h"
#include "daemon/motion/path/quaternion.h"

namespace camway::correction {

namespace {

using geometry::Quat;
using geometry::Vec3;
using geometry::Vec4;
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
constexpr std::size_t kMostWays = 2;           // nudges that are tried as bumps
constexpr double kWorseWay = 1.7;              // a direction that needs so much more is not tried

/// Adds a unit vector, unless there is one of about the same direction.
void add_new(const Vec3& direction, std::vector<Vec3>& directions) {
  const bool is_known = std::ranges::any_of(
      directions, [&](const Vec3& other) { return direction.dot(other) > kSameDirection; });
  if (!is_known) directions.push_back(direction);
}

}  // namespace

NudgeSearch::NudgeSearch(const Problem& problem,
                         std::span<const collision::CollisionInterval> collisions, NudgeKind kind,
                         FreeSpace& space)
    : problem_(problem),
      kind_(kind),
      space_(space),
      middle_s_(0.5 * (problem.interval.t_begin_s + problem.interval.t_end_s)),
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

void NudgeSearch::add_sample(double time_s, double share) {
  samples_.push_back(
      {signed_pose_at(problem_.path, time_s), problem_.original.pose(time_s), share});
}

SignedPose NudgeSearch::nudged(const Sample& sample, const Vec3& direction_W, double amount) const {
  return space_.allowed(moved_or_turned(sample.pose, direction_W, amount), sample.interpolated);
}

SignedPose NudgeSearch::moved_or_turned(const SignedPose& pose, const Vec3& direction_W,
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

bool NudgeSearch::is_enough(const Vec3& direction_W, double amount, double margin_m) {
  return std::ranges::all_of(samples_, [&](const Sample& sample) {
    const SignedPose pose = nudged(sample, direction_W, sample.share * amount);
    return space_.is_free(motion::unsigned_pose(pose), margin_m);
  });
}

std::optional<double> NudgeSearch::least_amount(const Vec3& direction_W, double limit,
                                                double margin_m) {
  const double first = kind_ == NudgeKind::kMove ? kLeastStepShare * radius_m_ : 0.02;
  double below = 0.0;
  double above = first;
  while (!is_enough(direction_W, above, margin_m)) {
    if (above >= limit) return std::nullopt;
    below = above;
    double next = kGrowth * above;
    if (kind_ == NudgeKind::kTurn) next = std::min(next, above + kLargestTurnStep_rad);
    above = std::min(next, limit);
  }
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (below + above);
    (is_enough(direction_W, middle, margin_m) ? above : below) = middle;
  }
  return above;
}

std::vector<Vec3> NudgeSearch::directions_W() {
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

std::vector<Vec3> NudgeSearch::axes_W(const Quat& orientation) const {
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

Vec3 NudgeSearch::way_W() const {
  const Vec3 way = samples_.back().pose.position - samples_[1].pose.position;
  const double length_m = way.norm();
  return length_m > 0.0 ? Vec3(way / length_m) : Vec3::UnitZ();
}

std::vector<Vec3> NudgeSearch::contact_directions_W() {
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

double NudgeSearch::farthest() const {
  if (kind_ == NudgeKind::kTurn) {
    return std::min(kLargestTurn_rad, kAimedShare * space_.policy().max_turn_rad);
  }
  return std::max(kFarthest * radius_m_, kFarthestShift * space_.closeness().viewing_distance_m);
}

// Along the segment from where the collision begins, which is free, each closed surface is crossed
// an odd number of times if the nudged body is on its other side.
bool NudgeSearch::leads_inside(const Nudge& nudge) const {
  const Vec3 outside_W = space_.center_W(problem_.path.pose(problem_.interval.t_begin_s));
  const Vec3 nudged_W = space_.center_W(motion::unsigned_pose(nudged_middle(nudge)));
  const geometry::LineSegment segment{outside_W, nudged_W};
  geometry::Box box(outside_W);
  box.extend(nudged_W);
  const scene::SceneIndex& index = space_.obstacles().index;
  // Each once, though a triangle may be in several leaves.
  std::vector<std::uint32_t> hits;
  index.for_each_touching(box, [&](std::uint32_t triangle) {
    if (geometry::hit_fraction(segment, index.triangle(triangle))) hits.push_back(triangle);
    return true;
  });
  std::ranges::sort(hits);
  const auto last = std::unique(hits.begin(), hits.end());
  return (last - hits.begin()) % 2 == 1;
}

std::vector<Nudge> NudgeSearch::smallest() {
  const std::vector<Vec3> all_W = directions_W();
  std::vector<Nudge> nudges;
  for (const double share : kMarginShares) {
    double limit = farthest();
    for (const Vec3& direction_W : all_W) {
      ++directions_;
      const std::optional<double> amount = least_amount(direction_W, limit, share * radius_m_);
      if (!amount || leads_inside({direction_W, *amount})) continue;
      nudges.push_back({direction_W, *amount});
      limit = std::min(limit, kWorseWay * *amount);
    }
    if (!nudges.empty()) break;
  }
  std::ranges::stable_sort(nudges, {}, &Nudge::amount);
  if (nudges.size() > kMostWays) nudges.resize(kMostWays);
  return nudges;
}

}  // namespace camway::correction
