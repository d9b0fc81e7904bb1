// SPDX-License-Identifier: MIT
#include "daemon/collision/detect.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "daemon/collision/open_interval.h"
#include "daemon/collision/probe.h"
#include "daemon/collision/step_control.h"
#include "daemon/motion/path/stretch.h"

namespace camway::collision {

namespace {

using motion::Segment;
using motion::SegmentMotion;
using motion::Stretch;

// Upper bound of how far a point of the body travels.
double travel_bound_m(const motion::Path& path, double radius_m) {
  double travel_m = 0.0;
  for (const Segment& segment : path.segments()) {
    travel_m += 2.0 * SegmentMotion(segment).around(0.0, 1.0).reach_m(radius_m);
  }
  return travel_m;
}

void join_close_intervals(std::vector<CollisionInterval>& intervals, double gap_s) {
  std::size_t kept = 0;
  for (std::size_t i = 1; i < intervals.size(); ++i) {
    CollisionInterval& before = intervals[kept];
    if (intervals[i].t_begin_s - before.t_end_s < gap_s) {
      before.t_end_s = intervals[i].t_end_s;
      const std::optional<Witness>& other = intervals[i].witness;
      if (other && (!before.witness || other->depth_m > before.witness->depth_m)) {
        before.witness = other;
      }
    } else {
      intervals[++kept] = intervals[i];
    }
  }
  if (!intervals.empty()) intervals.resize(kept + 1);
}

/// When a walk ends before the end of the path.
enum class Goal : std::uint8_t {
  kAll,
  kFirst,  ///< at the end of the first interval
  kBegin,  ///< after the first stretch of the first interval
  kAny,    ///< at the first stretch that collides at its middle, or that is resolved
};

/// Remembers, from one step within a collision to the next, which obstacle the body hits. A step is
/// proved to collide if one obstacle is hit everywhere on it. A search for such an obstacle is
/// expensive where there is none, so after each failure more steps pass before the next search.
class HitTracker {
 public:
  explicit HitTracker(Probe& probe) : probe_(probe) {}

  /// Forgets the obstacle, at the beginning of a collision.
  void restart() {
    proved_.reset();
    checks_left_ = backoff_ = 0;
  }

  /// Returns whether the last stretch was proved to hit an obstacle.
  [[nodiscard]] bool is_proved() const { return proved_.has_value(); }

  /// Returns whether the obstacle that the last stretch was proved to hit is hit everywhere on this
  /// one, too.
  [[nodiscard]] bool stays(const Stretch& stretch) const {
    return proved_ && probe_.surely_collides_with(*proved_, stretch);
  }

  /// Returns whether the body touches an obstacle at the middle of the stretch; tries at times to
  /// prove that it hits one everywhere.
  bool touches(const Stretch& stretch) {
    proved_.reset();
    const std::optional<std::uint32_t> touched = probe_.touched_in_the_middle(stretch, touched_);
    if (!touched) return false;
    touched_ = *touched;
    if (checks_left_-- <= 0) {
      proved_ = probe_.surely_hit(stretch);
      backoff_ = proved_ ? 0 : std::min(2 * backoff_ + 1, kMostBackoff);
      checks_left_ = backoff_;
    }
    return true;
  }

 private:
  static constexpr int kMostBackoff = 15;  // by measurement

  Probe& probe_;
  std::optional<std::uint32_t> proved_;  ///< obstacle that the last stretch was proved to hit
  std::uint32_t touched_ = 0;            ///< obstacle that was touched last: tried first
  int checks_left_ = 0;                  ///< checks until the next attempt of a proof
  int backoff_ = 0;                      ///< checks between attempts after the next failure
};

// Walks the path from beginning to end in steps whose length follows the distance to the scene, and
// joins the colliding pieces to intervals. (Recursive bisection would spend most queries on pieces
// that are far too long.)
class Detector {
 public:
  Detector(const Query& query, const base::Deadline& deadline, Goal goal)
      : probe_(query.obstacles, query.body, query.options.clearance_m),
        hit_(probe_),
        options_(query.options),
        deadline_(deadline),
        goal_(goal) {}

  void run(const motion::Path& path, double t_begin_s, double t_end_s) {
    for (const Segment& segment : path.segments()) {
      if (segment.t1_s <= t_begin_s || segment.t0_s >= t_end_s) continue;
      const double u0 = motion::segment_parameter(segment, t_begin_s);
      const double u1 = motion::segment_parameter(segment, t_end_s);
      if (u0 < u1) walk({&segment, u0, u1});
      if (finished_) return;
    }
    close();
    if (!timed_out_) until_s_ = t_end_s;
  }

  [[nodiscard]] bool timed_out() const { return timed_out_; }
  /// End of the time that was searched.
  [[nodiscard]] double until_s() const { return until_s_; }
  [[nodiscard]] std::vector<CollisionInterval>& intervals() { return intervals_; }

 private:
  void walk(const Piece& all) {
    const SegmentMotion motion(*all.segment);
    double width = all.u1 - all.u0;
    for (double u = all.u0; u < all.u1 && !finished_;) {
      if (out_of_time()) {
        until_s_ = open_.is_open() ? open_.begin_s() : motion::segment_time_s(*all.segment, u);
        return;
      }
      const Piece piece{all.segment, u, end_of_step(u, width, all.u1)};
      width = piece.u1 - u;
      const Stretch stretch = motion.around(piece.u0, piece.u1);
      // Only the motion matters: splitting does not reduce the rounding.
      const double motion_m = probe_.reach_m(stretch) - probe_.rounding_m(stretch);
      const bool is_skipped = is_too_long(motion_m, target_reach_m_) && piece.splittable();
      if (!is_skipped && settle(piece, stretch)) u = piece.u1;
      width *= width_factor(motion_m, target_reach_m_, kDetectionGrowth);
    }
  }

  enum class Verdict { kSettled, kTooLong, kUnknown };

  // Checks a piece and chooses the reach of the next; returns false if the piece was too long.
  bool settle(const Piece& piece, const Stretch& stretch) {
    const Verdict inside = open_.is_open() ? settle_inside(piece, stretch) : Verdict::kUnknown;
    if (inside != Verdict::kUnknown) return inside == Verdict::kSettled;
    const ProbeResult seen = look(piece, stretch, Probe::Way::kForwards);
    if (seen.free) {
      close();
      target_reach_m_ = std::max(next_reach_m(seen), kBelow * options_.tolerance_m);
      return true;
    }
    if (goal_ == Goal::kAny && (seen.contains || seen.collides())) {
      extend(piece, seen.gap_m, /*surely=*/true);
      close();
      return true;
    }
    if (seen.contains) {
      extend(piece, seen.gap_m, /*surely=*/true);
      target_reach_m_ = kGrowthInCollision * seen.reach_m;
      return true;
    }
    const bool counts =
        open_.is_open() && seen.collides() && seen.motion_m() <= options_.joining_distance_m;
    if (counts || is_resolved(seen) || !piece.splittable()) {
      extend(piece, seen.gap_m, /*surely=*/goal_ == Goal::kAny);
      if (goal_ == Goal::kAny) close();
      target_reach_m_ =
          seen.collides() ? kBelow * options_.joining_distance_m : options_.tolerance_m;
      return true;
    }
    // Must be shorter, or the loop would not end.
    target_reach_m_ = std::min(kBelow * seen.motion_m(),
                               std::max(next_reach_m(seen), kBelow * least_reach_m(seen)));
    return false;
  }

  // Measures the distance at the middle only if the piece will not be split.
  ProbeResult look(const Piece& piece, const Stretch& stretch, Probe::Way way) {
    ProbeResult seen = probe_.check(stretch, /*margin_m=*/0.0, way);
    const double largest_m = open_.is_open() ? options_.joining_distance_m : options_.tolerance_m;
    if (seen.motion_m() <= largest_m || !piece.splittable()) probe_.refine(stretch, seen);
    return seen;
  }

  // The reach below which a piece need not be split.
  [[nodiscard]] double least_reach_m(const ProbeResult& seen) const {
    return open_.is_open() && seen.collides() ? options_.joining_distance_m : finest_m(seen);
  }

  // Within a collision: extends it by a stretch that is proved to collide everywhere, or one that
  // is short enough and collides at its middle.
  Verdict settle_inside(const Piece& piece, const Stretch& stretch) {
    const double reach_m = probe_.reach_m(stretch);
    if (!std::isfinite(reach_m)) return Verdict::kUnknown;
    const double motion_m = reach_m - probe_.rounding_m(stretch);
    const bool is_short = motion_m <= options_.joining_distance_m || !piece.splittable();
    if (hit_.stays(stretch)) {
      extend(piece, 0.0, /*surely=*/true);
      target_reach_m_ = kGrowthInCollision * reach_m;
      return Verdict::kSettled;
    }
    if (!is_short) {
      target_reach_m_ = std::max(0.5 * motion_m, kBelow * options_.joining_distance_m);
      return Verdict::kTooLong;
    }
    if (!hit_.touches(stretch)) return Verdict::kUnknown;
    extend(piece, 0.0, hit_.is_proved());
    target_reach_m_ =
        hit_.is_proved() ? kGrowthInCollision * reach_m : kBelow * options_.joining_distance_m;
    return Verdict::kSettled;
  }

  // The reach below which a stretch that is not free counts as colliding.
  [[nodiscard]] double finest_m(const ProbeResult& seen) const {
    return seen.collides() ? options_.tolerance_m : kFinestShare * options_.tolerance_m;
  }

  [[nodiscard]] bool is_resolved(const ProbeResult& seen) const {
    return !(seen.motion_m() > finest_m(seen));
  }

  bool out_of_time() {
    if (steps_++ % steps_per_clock(probe_) != 0 || !deadline_.passed()) return false;
    timed_out_ = finished_ = true;
    return true;
  }

  static double end_of_step(double u, double width, double u1) {
    const double left = u1 - u;
    if (!(width < left)) return u1;
    // Avoid a sliver at the end of a segment: take two halves.
    const double end = u + (1.25 * width < left ? width : 0.5 * left);
    return end > u ? end : std::nextafter(u, u1);
  }

  void extend(const Piece& piece, double gap_m, bool surely) {
    if (!open_.is_open()) hit_.restart();
    open_.extend(piece, gap_m, surely);
    // An interval keeps its beginning, whatever follows.
    if (goal_ == Goal::kBegin) close();
  }

  void close() {
    if (!open_.is_open()) return;
    const Piece last = open_.last();
    const bool is_exact = goal_ == Goal::kBegin || open_.is_last_sure();
    const double end_s = is_exact ? last.end_s() : last_not_free(last).value_or(last.end_s());
    const double begin_s = open_.begin_s();
    if (timed_out_) {
      until_s_ = begin_s;
      return;
    }
    intervals_.push_back({begin_s, end_s, std::nullopt});
    if (goal_ == Goal::kAll) {
      intervals_.back().witness = open_.witness(probe_, 0.5 * (begin_s + end_s));
    }
    open_.close();
    finished_ = finished_ || goal_ != Goal::kAll;
  }

  // Walks `piece` backwards from its end, which is free, and returns the end of the last part that
  // is not free at the finest resolution. Nothing if all of it is free.
  std::optional<double> last_not_free(const Piece& piece) {
    const SegmentMotion motion(*piece.segment);
    double width = piece.u1 - piece.u0;
    for (double u = piece.u1; u > piece.u0 && !out_of_time();) {
      const double from = std::min(u - width, std::nextafter(u, piece.u0));
      const Piece part{piece.segment, std::max(from, piece.u0), u};
      const ProbeResult seen = look(part, motion.around(part.u0, part.u1), Probe::Way::kBackwards);
      if (seen.free) {
        u = part.u0;
      } else if (is_resolved(seen) || !part.splittable()) {
        return part.end_s();
      }
      const double aim_m = std::max(next_reach_m(seen), kBelow * finest_m(seen));
      width = (part.u1 - part.u0) *
              width_factor(seen.reach_m, aim_m, seen.free ? kDetectionGrowth : kBelow);
    }
    return std::nullopt;
  }

  // Chosen by measurement over furnished and empty scenes: none changes what is proved.
  static constexpr double kFinestShare = 0.1;        // share of the tolerance
  static constexpr double kBelow = 0.9;              // keeps rounding from exceeding a limit
  static constexpr double kGrowthInCollision = 2.0;  // after a stretch proved to collide

  Probe probe_;
  HitTracker hit_;
  const DetectOptions& options_;
  const base::Deadline& deadline_;
  const Goal goal_;

  /// Reach of the next step, rounding apart.
  double target_reach_m_ = std::numeric_limits<double>::infinity();
  unsigned steps_ = 0;
  bool finished_ = false;
  bool timed_out_ = false;
  double until_s_ = 0.0;

  OpenInterval open_;
  std::vector<CollisionInterval> intervals_;
};

FirstCollision searched(const Query& query, const motion::Path& path, double t_begin_s,
                        double t_end_s, const base::Deadline& deadline, Goal goal) {
  Detector detector(query, deadline, goal);
  detector.run(path, t_begin_s, t_end_s);
  if (detector.timed_out()) return {false, std::nullopt};
  if (detector.intervals().empty()) return {};
  return {true, detector.intervals().front()};
}

}  // namespace

std::optional<std::vector<CollisionInterval>> detect_collisions(const Query& query,
                                                                const motion::Path& path,
                                                                double t_begin_s, double t_end_s,
                                                                const base::Deadline& deadline) {
  FoundCollisions found = search_collisions(query, path, t_begin_s, t_end_s, deadline);
  if (!found.complete) return std::nullopt;
  return std::move(found.collisions);
}

FoundCollisions search_collisions(const Query& query, const motion::Path& path, double t_begin_s,
                                  double t_end_s, const base::Deadline& deadline) {
  Detector detector(query, deadline, Goal::kAll);
  detector.run(path, t_begin_s, t_end_s);
  FoundCollisions found{!detector.timed_out(), std::move(detector.intervals()), detector.until_s()};
  if (found.collisions.size() > 1) {
    const double travel_m = travel_bound_m(path, query.body.radius_m());
    join_close_intervals(found.collisions, query.options.joining_distance_m / travel_m *
                                               (path.end_s() - path.begin_s()));
  }
  return found;
}

FirstCollision first_collision(const Query& query, const motion::Path& path, double t_begin_s,
                               double t_end_s, const base::Deadline& deadline) {
  return searched(query, path, t_begin_s, t_end_s, deadline, Goal::kFirst);
}

FirstCollision first_contact(const Query& query, const motion::Path& path, double t_begin_s,
                             double t_end_s, const base::Deadline& deadline) {
  return searched(query, path, t_begin_s, t_end_s, deadline, Goal::kBegin);
}

FirstCollision any_collision(const Query& query, const motion::Path& path, double t_begin_s,
                             double t_end_s, const base::Deadline& deadline) {
  return searched(query, path, t_begin_s, t_end_s, deadline, Goal::kAny);
}

void remove_undecided(const Query& query, const motion::Path& path, const base::Deadline& deadline,
                      std::vector<CollisionInterval>& collisions) {
  Query finer = query;
  finer.options.tolerance_m *= kFinerTolerance;
  std::erase_if(collisions, [&](const CollisionInterval& interval) {
    if (!(interval.t_begin_s < interval.t_end_s)) return false;
    const FirstCollision found =
        any_collision(finer, path, interval.t_begin_s, interval.t_end_s, deadline);
    return found.decided && !found.interval;
  });
}

}  // namespace camway::collision
