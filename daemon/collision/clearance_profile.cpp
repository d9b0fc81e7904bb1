// SPDX-License-Identifier: MIT
#include "daemon/collision/clearance_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "daemon/collision/clearance.h"
#include "daemon/collision/least_gap.h"
#include "daemon/collision/open_interval.h"
#include "daemon/collision/probe.h"
#include "daemon/collision/step_control.h"
#include "daemon/motion/path/stretch.h"

namespace camway::collision {

namespace {

using motion::Segment;
using motion::SegmentMotion;
using motion::Stretch;

// Relative rounding of a time that belongs to a parameter of a segment: of a product, a sum and a
// quotient in each direction.
constexpr double kTimeRounding = 8.0 * std::numeric_limits<double>::epsilon();

// Neighbours whose bounds differ by less than this are joined first. [Units: metres]
constexpr double kFinestDifference_m = 1e-3;
constexpr double kFinestRatio = 1.05;

/// Walks parts of a path and appends a stretch for each step.
class ProfileWalk {
 public:
  ProfileWalk(const Query& query, double least_m, const base::Deadline& deadline,
              std::vector<ClearanceStretch>& profile)
      : probe_(query.obstacles.without_bounds(), query.body, /*clearance_m=*/0.0),
        least_m_(least_m),
        deadline_(deadline),
        profile_(profile) {}

  /// Covers the path from `begin_s` to `end_s`, which has no collision.
  void cover(const motion::Path& path, double begin_s, double end_s) {
    for (const Segment& segment : path.segments()) {
      if (segment.t1_s <= begin_s || segment.t0_s >= end_s) continue;
      const double from_s = std::max(begin_s, segment.t0_s);
      const double to_s = std::min(end_s, segment.t1_s);
      walk(segment, from_s, to_s);
    }
  }

 private:
  /// Parameters of a segment; the times of its ends are known exactly.
  void walk(const Segment& segment, double from_s, double to_s) {
    const SegmentMotion motion(segment);
    // An end that is no end of the segment is that of a collision, which has the smaller bound: the
    // rounding of its parameter is left to it (`move_times`).
    const double u0 = motion::segment_parameter(segment, from_s);
    const double u1 = motion::segment_parameter(segment, to_s);
    double width = u1 - u0;
    double begin_s = from_s;
    for (double u = u0; u < u1;) {
      if (is_late()) break;
      const double end = width < u1 - u ? std::max(u + width, std::nextafter(u, 1.0)) : u1;
      width = end - u;
      const Stretch stretch = motion.around(u, end);
      const double reach_m = probe_.reach_m(stretch);
      const bool is_splittable = Piece{&segment, u, end}.splittable();
      if (!is_splittable || !is_too_long(reach_m, target_reach_m_)) {
        if (settle(stretch, is_splittable)) {
          const double end_s = end == u1 ? to_s : motion::segment_time_s(segment, end);
          append(begin_s, end_s, bound_m_);
          begin_s = end_s;
          u = end;
        }
      }
      width *= width_factor(reach_m, target_reach_m_, kClearanceGrowth);
    }
    if (begin_s < to_s) append(begin_s, to_s, least_m_);
  }

  /// Bounds the clearance of a stretch (`bound_m_`); returns false if it should be shorter.
  bool settle(const Stretch& stretch, bool is_splittable) {
    const ProbeResult seen = probe_.check_refined(stretch, kLargestClearance_m, kProfileShare);
    if (seen.free) {
      bound_m_ = kLargestClearance_m;
      target_reach_m_ = std::max(next_reach_m(seen), kFinestReach_m);
      return true;
    }
    // No stretch at this place has a larger bound.
    const double best_m =
        seen.gap_m > 0.0 ? least_gap_at_middle_m(probe_, seen, kProfileShare) : 0.0;
    const double everywhere_m = least_gap_m(best_m, seen);
    bound_m_ = std::clamp(everywhere_m, 0.0, kLargestClearance_m);
    target_reach_m_ = std::max(kReachOfBest * best_m, kFinestReach_m);
    // If the reach is mostly rounding, splitting does not help.
    const bool is_good = everywhere_m >= kEnough * best_m || !is_splittable ||
                         !(seen.reach_m > std::max(kFinestReach_m, 2.0 * seen.rounding_m));
    // Must be shorter, or the loop would not end.
    if (!is_good) target_reach_m_ = std::min(target_reach_m_, kLargestShare * seen.reach_m);
    return is_good;
  }

  void append(double begin_s, double end_s, double bound_m) {
    if (begin_s < end_s) profile_.push_back({begin_s, end_s, std::max(bound_m, least_m_)});
  }

  bool is_late() {
    is_late_ = is_late_ || (steps_++ % steps_per_clock(probe_) == 0 && deadline_.passed());
    return is_late_;
  }

  // Chosen so that a profile takes about as many steps as detection: none changes what is proved.
  static constexpr double kProfileShare = 0.96;   // the true distance is at least this share
  static constexpr double kEnough = 0.7;          // bound of a stretch, as a share of the best
  static constexpr double kReachOfBest = 0.25;    // reach aimed at, as a share of the best bound
  static constexpr double kLargestShare = 0.8;    // share of a reach that was too long
  static constexpr double kFinestReach_m = 1e-3;  // shorter stretches say no more to a reader

  Probe probe_;
  const double least_m_;
  const base::Deadline& deadline_;
  std::vector<ClearanceStretch>& profile_;
  double target_reach_m_ = std::numeric_limits<double>::infinity();
  double bound_m_ = 0.0;
  unsigned steps_ = 0;
  bool is_late_ = false;
};

/// Joins neighbours whose bounds are within `ratio` of each other.
std::vector<ClearanceStretch> joined_within(double ratio,
                                            const std::vector<ClearanceStretch>& profile) {
  std::vector<ClearanceStretch> joined;
  double most_m = 0.0;
  for (const ClearanceStretch& each : profile) {
    if (!joined.empty()) {
      const double less_m = std::min(joined.back().clearance_m, each.clearance_m);
      const double more_m = std::max(most_m, each.clearance_m);
      if (more_m <= ratio * less_m + (ratio - 1.0) / (kFinestRatio - 1.0) * kFinestDifference_m) {
        joined.back().t_end_s = each.t_end_s;
        joined.back().clearance_m = less_m;
        most_m = more_m;
        continue;
      }
    }
    joined.push_back(each);
    most_m = each.clearance_m;
  }
  return joined;
}

}  // namespace

void join_neighbours(std::size_t most, std::vector<ClearanceStretch>& profile) {
  double ratio = kFinestRatio;
  for (;;) {
    std::vector<ClearanceStretch> joined = joined_within(ratio, profile);
    // An infinite ratio joins all of them.
    if (joined.size() <= most) {
      profile = std::move(joined);
      return;
    }
    ratio = 1.0 + 1.5 * (ratio - 1.0);
  }
}

void move_times(const TimeMap& map, std::vector<ClearanceStretch>& profile) {
  if (profile.empty()) return;
  const double last_s = map.nearest(profile.back().t_end_s);
  double begin_s = map.nearest(profile.front().t_begin_s);
  std::vector<ClearanceStretch> moved;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const ClearanceStretch& each = profile[i];
    double end_s = last_s;
    if (i + 1 < profile.size()) {
      const bool grows = each.clearance_m < profile[i + 1].clearance_m;
      end_s = std::min(last_s, grows ? map.not_before(each.t_end_s) : map.not_after(each.t_end_s));
    }
    if (begin_s < end_s) {
      moved.push_back({begin_s, end_s, each.clearance_m});
      begin_s = end_s;
    } else if (!moved.empty() && i + 1 < profile.size()) {
      // The stretch before reaches into the one behind this.
      moved.back().clearance_m = std::min(moved.back().clearance_m, profile[i + 1].clearance_m);
    }
  }
  if (moved.empty()) moved.push_back({begin_s, last_s, 0.0});
  moved.back().t_end_s = last_s;
  profile = std::move(moved);
}

std::vector<ClearanceStretch> clearance_profile(const Query& query, const motion::Path& path,
                                                std::span<const CollisionInterval> colliding,
                                                double least_m, const base::Deadline& deadline) {
  std::vector<ClearanceStretch> profile;
  ProfileWalk walk(query, least_m, deadline, profile);
  double from_s = path.begin_s();
  for (const CollisionInterval& interval : colliding) {
    const double begin_s = std::clamp(interval.t_begin_s, from_s, path.end_s());
    const double end_s = std::clamp(interval.t_end_s, begin_s, path.end_s());
    if (from_s < begin_s) walk.cover(path, from_s, begin_s);
    profile.push_back({begin_s, end_s, 0.0});
    from_s = end_s;
  }
  if (from_s < path.end_s()) walk.cover(path, from_s, path.end_s());
  join_neighbours(kMostProfileStretches, profile);
  const double rounding_s =
      kTimeRounding * std::max(std::abs(path.begin_s()), std::abs(path.end_s()));
  move_times(
      {[](double time_s) { return time_s; }, [=](double time_s) { return time_s - rounding_s; },
       [=](double time_s) { return time_s + rounding_s; }},
      profile);
  if (colliding.empty() && !profile.empty()) {
    std::ranges::min_element(profile, {}, &ClearanceStretch::clearance_m)->clearance_m = least_m;
  }
  return profile;
}

}  // namespace camway::collision
