// SPDX-License-Identifier: MIT
#include "daemon/collision/clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

class ClearanceSearch {
 public:
  ClearanceSearch(const Obstacles& obstacles, const motion::Body& body,
                  const base::Deadline& deadline)
      : probe_(obstacles.without_bounds(), body, /*clearance_m=*/0.0), deadline_(deadline) {}

  std::optional<PathClearance> run(const motion::Path& path) {
    seed(path);
    for (const Segment& segment : path.segments()) {
      if (!walk(segment)) return timed_out_ ? std::nullopt : std::optional(touch());
    }
    return PathClearance{std::min(lower_m_, upper_m_), upper_m_, closest_s_};
  }

 private:
  // Finds a first upper bound at the closest of a few places; a small one excludes most of the
  // path.
  void seed(const motion::Path& path) {
    Stretch closest;
    double closest_s = path.begin_s();
    double least_m = std::numeric_limits<double>::infinity();
    for (const Segment& segment : path.segments()) {
      const SegmentMotion motion(segment);
      for (int i = 0; i < kPlacesASegment; ++i) {
        const double u = (i + 0.5) / kPlacesASegment;
        const Stretch place = motion.around(u, u);
        const double distance_m = probe_.at_least_m(place);
        if (distance_m < least_m) {
          least_m = distance_m;
          closest = place;
          closest_s = motion::segment_time_s(segment, u);
        }
      }
    }
    if (least_m < std::numeric_limits<double>::infinity()) {
      ProbeResult seen = check(closest);
      measure(closest, closest_s, /*must=*/true, seen);
    }
  }

  // Returns false where no positive distance can be proved, or when the deadline struck.
  bool walk(const Segment& segment) {
    const SegmentMotion motion(segment);
    double width = 1.0;
    for (double u = 0.0; u < 1.0;) {
      if (steps_++ % steps_per_clock(probe_) == 0 && deadline_.passed()) {
        timed_out_ = true;
        return false;
      }
      const double end = width < 1.0 - u ? std::max(u + width, std::nextafter(u, 1.0)) : 1.0;
      width = end - u;
      const Stretch stretch = motion.around(u, end);
      const double reach_m = probe_.reach_m(stretch);
      const bool splittable = Piece{&segment, u, end}.splittable();
      if (!is_too_long(reach_m, target_reach_m_) || !splittable) {
        const double middle_s = motion::segment_time_s(segment, 0.5 * (u + end));
        const Verdict verdict = settle(stretch, middle_s, splittable);
        if (verdict == Verdict::kTouches) return false;
        if (verdict == Verdict::kSettled) u = end;
      }
      width *= width_factor(reach_m, target_reach_m_, kClearanceGrowth);
    }
    return true;
  }

  enum class Verdict { kSettled, kTooLong, kTouches };

  Verdict settle(const Stretch& stretch, double middle_s, bool splittable) {
    ProbeResult seen = check(stretch);
    // If rounding alone hides the difference, splitting does not help.
    const bool is_hopeless = !seen.free && (!(seen.reach_m > 2.0 * seen.rounding_m) || !splittable);
    const bool is_measured = measure(stretch, middle_s, /*must=*/is_hopeless, seen);
    const double enough_m = enough();
    if (seen.free) {
      lower_m_ = std::min(lower_m_, asked_m_);
      target_reach_m_ = next_reach_m(seen);
      return Verdict::kSettled;
    }
    const double everywhere_m =
        is_measured ? least_gap_m(least_gap_at_middle_m(probe_, seen, kShare), seen) : 0.0;
    if (is_hopeless && !(everywhere_m > 0.0)) return Verdict::kTouches;
    if (!(seen.gap_m > 0.0)) return Verdict::kTouches;
    target_reach_m_ = std::max(kApproach * (seen.gap_m - enough_m), 1.5 * seen.rounding_m);
    if (is_hopeless || everywhere_m >= enough_m) {
      lower_m_ = std::min({lower_m_, everywhere_m, asked_m_});
      return Verdict::kSettled;
    }
    target_reach_m_ =
        std::min(std::max(target_reach_m_, next_reach_m(seen)), kLargestShare * seen.reach_m);
    return Verdict::kTooLong;
  }

  // Checks whether the distance is at least `enough` all over the stretch.
  ProbeResult check(const Stretch& stretch) {
    asked_m_ = enough();
    return probe_.check(stretch, asked_m_);
  }

  // Measures the distance at the middle of a stretch that was checked, if `must` or if that may
  // lower the upper bound. A check that fails stops at one triangle, and the distance is at most
  // that of the triangle. Elsewhere the distance is of no use: measuring it takes five times as
  // long as the check of a shorter stretch. Returns whether `seen.gap_m` was measured.
  bool measure(const Stretch& stretch, double middle_s, bool must, ProbeResult& seen) {
    if (!seen.is_measured) return false;
    const bool is_near = std::max(0.0, seen.gap_m) + seen.rounding_m < upper_m_;
    if (!must && !is_near) return false;
    probe_.refine(stretch, seen, kShare);
    const double at_middle_m = std::max(0.0, seen.gap_m) + seen.rounding_m;
    if (at_middle_m < upper_m_) {
      upper_m_ = at_middle_m;
      closest_s_ = middle_s;
    }
    return true;
  }

  [[nodiscard]] double enough() const {
    return upper_m_ < kLargestClearance_m ? (1.0 - kClearanceTolerance) * upper_m_
                                          : kLargestClearance_m;
  }
  [[nodiscard]] PathClearance touch() const { return {0.0, upper_m_, closest_s_}; }

  // Chosen by measurement: none changes what is proved.
  static constexpr double kShare = 0.96;  // the true distance is at least this share
  static constexpr int kPlacesASegment = 8;
  static constexpr double kApproach = 0.8;      // reach aimed at, as a share of the gap
  static constexpr double kLargestShare = 0.8;  // share of a reach that was too long

  Probe probe_;
  const base::Deadline& deadline_;
  double target_reach_m_ = std::numeric_limits<double>::infinity();
  double asked_m_ = 0.0;
  unsigned steps_ = 0;
  bool timed_out_ = false;
  double lower_m_ = kLargestClearance_m;
  double upper_m_ = kLargestClearance_m;
  double closest_s_ = 0.0;  ///< time of `upper_m_`
};

}  // namespace

std::optional<PathClearance> path_clearance(const Obstacles& obstacles, const motion::Path& path,
                                            const motion::Body& body,
                                            const base::Deadline& deadline) {
  return ClearanceSearch(obstacles, body, deadline).run(path);
}

}  // namespace camway::collision
