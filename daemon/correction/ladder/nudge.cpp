// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/nudge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "daemon/correction/path/guide.h"
#include "daemon/correction/path/orientation_rule.h"
#include "daemon/motion/path/quaternion.h"

namespace camway::correction {

namespace {

using geometry::Quat;
using geometry::Vec3;
using geometry::Vec4;
using motion::BumpRow;
using motion::CubicPoint;
using motion::KnotRow;
using motion::Pose;
using motion::SignedPose;

// Chosen by measurement; none changes what is proved.
constexpr int kFan = 8;                   // directions across the way
constexpr double kLeastStepShare = 0.06;  // first amount tried, as a share of the radius
constexpr double kGrowth = 2.0;           // from one amount to the next
constexpr double kFarthest = 4.0;         // radii
constexpr int kHalvings = 2;              // bisections of the last step
constexpr double kMarginShare = 0.02;     // margin of a pose, as a share of the radius
constexpr double kLargestTurn_rad = 0.8;
constexpr double kLargestTurnStep_rad = 0.08;  // turned too far, the body is stuck again
constexpr double kMoreEachTime = 1.35;
constexpr int kMostRaises = 3;
constexpr double kNarrowest = 0.6;  // spacing of the knots, as a share of the collision
constexpr int kMostWidths = 2;
constexpr double kLeastPeak = 0.1;  // least peak of a bump after its cancellation at keyframes

/// A nudge: direction of the translation, or axis of the turn, and amount.
struct Way {
  Vec3 direction_W;
  double amount = 0.0;  ///< metres or radians
};

class Nudger {
 public:
  Nudger(const Problem& problem, NudgeKind kind, FreeSpace& space, const base::Deadline& deadline)
      : problem_(problem),
        kind_(kind),
        space_(space),
        deadline_(deadline),
        middle_s_(0.5 * (problem.interval.t_begin_s + problem.interval.t_end_s)),
        length_s_(problem.interval.t_end_s - problem.interval.t_begin_s),
        radius_m_(space.ball_radius_m()),
        margin_m_(kMarginShare * radius_m_) {
    // The ends of a collision are free, so less is needed away from its middle.
    for (const auto& [place, share] : {std::pair{0.0, 1.0}, {-0.3, 0.8}, {0.3, 0.8}}) {
      const double time_s = middle_s_ + place * length_s_;
      samples_.push_back(
          {signed_pose_at(problem.path, time_s), problem.original.pose(time_s), share});
    }
  }

  NudgeResult run() {
    NudgeResult result;
    if (const std::optional<Way> way = shortest_way()) result.candidate = with_way(*way);
    result.effort = effort_;
    return result;
  }

 private:
  struct Sample {
    SignedPose pose;
    Pose interpolated;
    double share;
  };

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
      directions.push_back(Eigen::AngleAxisd(angle_rad, along) * across);
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
    const Vec3 way = samples_[2].pose.position - samples_[1].pose.position;
    const double length_m = way.norm();
    return length_m > 0.0 ? Vec3(way / length_m) : Vec3::UnitZ();
  }

  /// Along the normal of the deepest contact, and away from its point.
  [[nodiscard]] std::vector<Vec3> contact_directions_W() {
    std::vector<Vec3> directions;
    const auto add = [&](const Vec3& direction) {
      const double length = direction.norm();
      if (length > 0.0 && std::isfinite(length)) directions.push_back(direction / length);
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

  /// The smallest nudge that frees the samples.
  std::optional<Way> shortest_way() {
    const double largest_turn_rad =
        std::min(kLargestTurn_rad, kAimedShare * space_.policy().max_turn_rad);
    const double farthest = kind_ == NudgeKind::kMove ? kFarthest * radius_m_ : largest_turn_rad;
    std::optional<Way> best;
    for (const Vec3& direction_W : directions_W()) {
      ++effort_.directions;
      const std::optional<double> amount =
          least_amount(direction_W, best ? best->amount : farthest);
      if (amount && (!best || *amount < best->amount)) best = Way{direction_W, *amount};
    }
    return best;
  }

  std::optional<Candidate> with_way(const Way& way) {
    double spacing_s = widest_spacing_s();
    for (int i = 0; i < kMostWidths; ++i, spacing_s *= 0.5) {
      if (std::optional<Candidate> found = with_width(way, spacing_s)) return found;
      if (spacing_s < kNarrowest * length_s_) break;
    }
    return std::nullopt;
  }

  /// Keeps the bump between the keyframes or, if the collision is next to one of them, at least
  /// wide enough for the collision.
  [[nodiscard]] double widest_spacing_s() const {
    const double room_s =
        std::min(middle_s_ - problem_.leg_begin_s(), problem_.leg_end_s() - middle_s_);
    return std::max(0.5 * room_s, 1.2 * kNarrowest * length_s_);
  }

  std::optional<Candidate> with_width(const Way& way, double spacing_s) {
    double amount = way.amount;
    for (int i = 0; i < kMostRaises; ++i, amount *= kMoreEachTime) {
      Attempt tried =
          attempt(problem_, bump(way.direction_W, amount, spacing_s), space_, deadline_);
      ++effort_.paths;
      if (tried.candidate) return std::move(tried.candidate);
      // A larger bump helps only against the collision that it is for.
      const bool is_old = tried.collision->t_begin_s < problem_.interval.t_end_s &&
                          tried.collision->t_end_s > problem_.interval.t_begin_s;
      if (!is_old) return std::nullopt;
    }
    return std::nullopt;
  }

  [[nodiscard]] std::vector<BumpRow> bump(const Vec3& direction_W, double amount,
                                          double spacing_s) const {
    const SignedPose wanted = nudged(samples_[0], direction_W, amount);
    const CubicPoint old = problem_.path.at(middle_s_);
    CubicPoint offset{wanted.position - old.position, Vec4::Zero()};
    if (wanted.orientation != samples_[0].pose.orientation) {
      const Vec4 image = motion::image_of(problem_.path.reference, wanted.orientation, old.image);
      offset.image = image * old.image.norm() - old.image;
    }
    return row_with_peak(offset, spacing_s);
  }

  [[nodiscard]] std::vector<BumpRow> row_with_peak(const CubicPoint& offset,
                                                   double spacing_s) const;

  const Problem& problem_;
  const NudgeKind kind_;
  FreeSpace& space_;
  const base::Deadline& deadline_;
  const double middle_s_;
  const double length_s_;
  const double radius_m_;
  const double margin_m_;
  std::vector<Sample> samples_;
  Effort effort_;
};

CubicPoint scaled(const CubicPoint& point, double factor) {
  return {factor * point.position, factor * point.image};
}

constexpr int kSingle = 2;  // the knot of the only bump of a row
constexpr int kSteps = 4;   // steps of its support

/// `places`, with the knots of `row` taken as well.
std::shared_ptr<const motion::KnotPlaces> with_knots_of(
    const motion::KnotRow& row, const std::shared_ptr<const motion::KnotPlaces>& places) {
  if (!places) return nullptr;
  motion::KnotPlaces all = *places;
  for (int k = 0; k <= kSteps; ++k) all.taken_s.push_back(row.knot_s(k));
  std::ranges::sort(all.taken_s);
  return std::make_shared<const motion::KnotPlaces>(std::move(all));
}

// The bump, and for each keyframe within its support a bump that cancels it there. These are too
// narrow to reach other keyframes.
std::vector<BumpRow> Nudger::row_with_peak(const CubicPoint& offset, double spacing_s) const {
  const KnotRow wide = KnotRow::about(middle_s_, spacing_s, problem_.places);
  if (!wide.fits()) return {};
  const std::shared_ptr<const motion::KnotPlaces> places = with_knots_of(wide, problem_.places);
  const std::vector<double>& keyframes_s = problem_.keyframes_s;
  std::vector<BumpRow> rows = {{wide, kSingle, {offset}}};
  double peak = wide.bump_value(kSingle, middle_s_);
  for (std::size_t i = 0; i < keyframes_s.size(); ++i) {
    const double value = wide.bump_value(kSingle, keyframes_s[i]);
    if (value == 0.0) continue;
    double room_s = spacing_s;
    if (i > 0) room_s = std::min(room_s, 0.5 * (keyframes_s[i] - keyframes_s[i - 1]));
    if (i + 1 < keyframes_s.size())
      room_s = std::min(room_s, 0.5 * (keyframes_s[i + 1] - keyframes_s[i]));
    const KnotRow narrow = KnotRow::about(keyframes_s[i], room_s, places);
    if (!narrow.fits()) return {};
    const double share = -value / narrow.bump_value(kSingle, keyframes_s[i]);
    peak += share * narrow.bump_value(kSingle, middle_s_);
    rows.push_back({narrow, kSingle, {scaled(offset, share)}});
  }
  if (!(peak > kLeastPeak)) return {};
  for (BumpRow& row : rows) row.bumps[0] = scaled(row.bumps[0], 1.0 / peak);
  return rows;
}

}  // namespace

NudgeResult nudge(const Problem& problem, NudgeKind kind, FreeSpace& space,
                  const base::Deadline& deadline) {
  return Nudger(problem, kind, space, deadline).run();
}

}  // namespace camway::correction
