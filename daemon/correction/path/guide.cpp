// SPDX-License-Identifier: MIT
#include "daemon/correction/path/guide.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "daemon/motion/path/quaternion.h"

namespace camway::correction {

namespace {

using geometry::Vec4;
using motion::BumpRow;
using motion::CubicPoint;
using motion::SignedPose;

constexpr int kTimes = 24;                          // grid on which a guide is timed: steps in time
constexpr int kPlaces = 96;                         // and places along the guide
constexpr int kLongestStep = 2 * kPlaces / kTimes;  // places per time step: twice the mean speed
constexpr double kHurry = 30.0;  // weight of a squared step, relative to a squared distance

using Places = std::array<double, kPlaces + 1>;

/// Whether the turn is far below half a turn, so that the straight motion between the poses is the
/// intended one.
bool turns_little(const SignedPose& a, const SignedPose& b) {
  constexpr double kLeastDot = 0.3;
  return a.orientation.dot(b.orientation) > kLeastDot;
}

bool is_none(const CubicPoint& offset) {
  return offset.position.isZero(0.0) && offset.image.isZero(0.0);
}

/// `pose` with the orientation of `other`; the centre of the body stays.
SignedPose oriented_as(const SignedPose& other, const SignedPose& pose, const FreeSpace& space) {
  const geometry::Vec3 center_W = space.center_W(motion::unsigned_pose(pose));
  const geometry::Quat orientation = geometry::from_wxyz(other.orientation);
  return {space.pose_around(center_W, orientation).position, other.orientation};
}

}  // namespace

SignedPose signed_pose_at(const motion::CubicPath& path, double time_s) {
  const CubicPoint point = path.at(time_s);
  const Vec4 q = motion::quaternion::multiply(
      path.reference, motion::quaternion::multiply(point.image, point.image));
  return {point.position, q / q.norm()};
}

motion::Pose pose_at_share(std::span<const motion::Pose> poses, double share) {
  const double place = share * static_cast<double>(poses.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(place), poses.size() - 2);
  const double rest = place - static_cast<double>(i);
  return {(1.0 - rest) * poses[i].position + rest * poses[i + 1].position,
          poses[i].orientation.slerp(rest, poses[i + 1].orientation)};
}

TimedGuide::TimedGuide(const motion::CubicPath& path, const Guide& guide, double begin_s,
                       double end_s, const FreeSpace& space)
    : guide_(guide), begin_s_(begin_s), end_s_(end_s), so_far_m_(1, 0.0) {
  for (std::size_t i = 1; i < guide.size(); ++i)
    so_far_m_.push_back(so_far_m_.back() + space.distance_m(guide[i - 1], guide[i]));
  choose_shares(path);
}

SignedPose TimedGuide::after(double share) const {
  const double at_m = share * so_far_m_.back();
  const auto next = std::ranges::upper_bound(so_far_m_, at_m);
  if (next == so_far_m_.end()) return guide_.back();
  const auto i = static_cast<std::size_t>(next - so_far_m_.begin());
  const double step_m = so_far_m_[i] - so_far_m_[i - 1];
  return motion::between(guide_[i - 1], guide_[i], (at_m - so_far_m_[i - 1]) / step_m);
}

SignedPose TimedGuide::at(double time_s) const {
  const double place = (time_s - begin_s_) / (end_s_ - begin_s_) * kTimes;
  const auto i = static_cast<std::size_t>(std::clamp(place, 0.0, kTimes - 1.0));
  return after(std::lerp(shares_[i], shares_[i + 1], place - static_cast<double>(i)));
}

// Chooses the best places on a grid of times and places by dynamic programming (as in dynamic time
// warping, Sakoe & Chiba 1978).
void TimedGuide::choose_shares(const motion::CubicPath& path) {
  std::vector<geometry::Vec3> places_W;
  for (int p = 0; p <= kPlaces; ++p) places_W.push_back(after(p / double{kPlaces}).position);
  const double step_m = so_far_m_.back() / kPlaces;
  const double hurry = kHurry * step_m * step_m;
  std::vector<std::array<int, kPlaces + 1>> before(kTimes + 1);
  Places cost{};
  cost.fill(std::numeric_limits<double>::infinity());
  cost[0] = 0.0;
  for (int t = 1; t <= kTimes; ++t) {
    const geometry::Vec3 old_W =
        path.at(std::lerp(begin_s_, end_s_, static_cast<double>(t) / kTimes)).position;
    const Places last = cost;
    // Other places cannot be reached from the beginning, or the end not from them.
    const int nearest = std::max(0, kPlaces - (kTimes - t) * kLongestStep);
    const int farthest = std::min(kPlaces, t * kLongestStep);
    for (int p = nearest; p <= farthest; ++p) {
      const auto place = static_cast<std::size_t>(p);
      double best = std::numeric_limits<double>::infinity();
      for (int q = std::max(0, p - kLongestStep); q <= p; ++q) {
        const double sum = last[static_cast<std::size_t>(q)] + hurry * (p - q) * (p - q);
        if (sum < best) {
          best = sum;
          before[static_cast<std::size_t>(t)][place] = q;
        }
      }
      cost[place] = best + (old_W - places_W[place]).squaredNorm();
    }
  }
  shares_.resize(kTimes + 1);
  int place = kPlaces;
  for (std::size_t t = kTimes + 1; t-- > 0;) {
    shares_[t] = place / double{kPlaces};
    place = before[t][static_cast<std::size_t>(place)];
  }
}

std::optional<Offsets> offsets_to(const motion::CubicPath& path,
                                  const motion::CubicPath& interpolated, const TimedGuide& guide,
                                  const motion::KnotRow& knots, Turning turning,
                                  const FreeSpace& space) {
  Offsets offsets{knots, 1, {}};
  Vec4 image = path.at(knots.begin_s).image;
  bool turns = false;
  for (int k = 1; k < knots.count; ++k) {
    const double time_s = knots.knot_s(k);
    const CubicPoint old = path.at(time_s);
    const SignedPose now = signed_pose_at(path, time_s);
    SignedPose wanted = guide.at(time_s);
    if (turning == Turning::kAsPath) wanted = oriented_as(now, wanted, space);
    wanted = space.allowed(wanted, interpolated.pose(time_s));
    CubicPoint offset{wanted.position - old.position, Vec4::Zero()};
    if (wanted.orientation == now.orientation) {
      image = old.image.normalized();
    } else {
      image = motion::image_of(path.reference, wanted.orientation, image);
      offset.image = image * old.image.norm() - old.image;
      turns = true;
    }
    offsets.at.push_back(offset);
  }
  if (turns && image.dot(path.at(knots.end_s).image) <= 0.0) return std::nullopt;
  return offsets;
}

CubicPoint holding(const motion::KnotRow& knots, int knot, const CubicPoint& before,
                   const CubicPoint& after) {
  const double peak = knots.bump_at_knot(knot, knot);
  const double of_before = -knots.bump_at_knot(knot - 1, knot) / peak;
  const double of_after = -knots.bump_at_knot(knot + 1, knot) / peak;
  return {of_before * before.position + of_after * after.position,
          of_before * before.image + of_after * after.image};
}

BumpRow bumps_for(const Offsets& offsets, Ends ends) {
  const int count = offsets.knots.count;
  const bool is_free = ends == Ends::kFree;
  const int first = is_free ? std::min(offsets.first, 0) : 2;
  const int last = is_free ? std::max(offsets.last(), count) : count - 2;
  BumpRow row{offsets.knots, first, {}};
  for (int k = first; k <= last; ++k) {
    const bool is_keyframe = k == 0 || k == count;
    row.bumps.push_back(is_keyframe ? holding(offsets.knots, k, offsets(k - 1), offsets(k + 1))
                                    : offsets(k));
  }
  // Zero bumps would only cut the path into pieces.
  while (!row.bumps.empty() && is_none(row.bumps.back())) row.bumps.pop_back();
  while (!row.bumps.empty() && is_none(row.bumps.front())) {
    row.bumps.erase(row.bumps.begin());
    ++row.first;
  }
  return row;
}

Guide divided(const Guide& guide, const FreeSpace& space, double longest_m) {
  Guide result = {guide.front()};
  for (std::size_t i = 1; i < guide.size(); ++i) {
    // A motion as long as coordinates permit may have more steps than an int can count.
    const double wanted = std::ceil(space.distance_m(guide[i - 1], guide[i]) / longest_m);
    const int parts = static_cast<int>(std::clamp(wanted, 1.0, double{kMostPartsOfMotion}));
    for (int k = 1; k < parts; ++k) {
      result.push_back(motion::between(guide[i - 1], guide[i], static_cast<double>(k) / parts));
    }
    result.push_back(guide[i]);
  }
  return result;
}

Guide shortened(const Guide& guide, FreeSpace& space, double margin_m) {
  Guide result = {guide.front()};
  for (std::size_t i = 0; i + 1 < guide.size();) {
    // Doubles the leap while the motion is free, then halves it.
    std::size_t reached = i + 1;
    for (std::size_t leap = 2; leap > 0;) {
      const std::size_t next = std::min(reached + leap, guide.size() - 1);
      const bool grows = next > reached && turns_little(guide[i], guide[next]) &&
                         space.passes(guide[i], guide[next], margin_m);
      if (grows) reached = next;
      leap = grows && next + 1 < guide.size() ? 2 * leap : leap / 2;
      if (reached + 1 == guide.size()) break;
    }
    result.push_back(guide[reached]);
    i = reached;
  }
  return result;
}

}  // namespace camway::correction
