// SPDX-License-Identifier: MIT
#include "daemon/collision/detect.h"

#include <algorithm>

#include "daemon/collision/piece.h"
#include "daemon/motion/motion_bound.h"

namespace camway::collision {

namespace {

using motion::Segment;

// How far a point of the body travels at the most, from the lengths of the control polygons.
double travel_bound_m(const motion::Path& path, double radius_m) {
  double travel_m = 0.0;
  for (const Segment& segment : path.segments()) {
    for (std::size_t i = 1; i < segment.position.size(); ++i) {
      travel_m += (segment.position[i] - segment.position[i - 1]).norm();
    }
    travel_m += 2.0 * radius_m * motion::motion_bound(segment).turn_rad;
  }
  return travel_m;
}

void join_close_intervals(std::vector<CollisionInterval>& intervals, double gap_s) {
  std::size_t kept = 0;
  for (std::size_t i = 1; i < intervals.size(); ++i) {
    if (intervals[i].t_begin_s - intervals[kept].t_end_s < gap_s) {
      intervals[kept].t_end_s = intervals[i].t_end_s;
    } else {
      intervals[++kept] = intervals[i];
    }
  }
  if (!intervals.empty()) intervals.resize(kept + 1);
}

// Walks the path from left to right, splitting what is undecided, and strings the colliding pieces
// together to intervals.
class Detector {
 public:
  Detector(const scene::SceneIndex& index, const motion::Corners& corners_C,
           const DetectOptions& options, const Deadline& deadline, bool only_first)
      : index_(index),
        corners_C_(corners_C),
        radius_m_(motion::body_radius_m(corners_C)),
        options_(options),
        deadline_(deadline),
        only_first_(only_first) {}

  void run(const motion::Path& path, double t_begin_s, double t_end_s) {
    for (const Segment& segment : path.segments()) {
      if (segment.t1_s <= t_begin_s || segment.t0_s >= t_end_s) continue;
      const double u0 = motion::segment_parameter(segment, t_begin_s);
      const double u1 = motion::segment_parameter(segment, t_end_s);
      if (u0 < u1) visit({&segment, u0, u1});
      if (finished_) return;
    }
    close();
  }

  [[nodiscard]] bool timed_out() const { return timed_out_; }
  [[nodiscard]] const std::vector<CollisionInterval>& intervals() const { return intervals_; }

 private:
  [[nodiscard]] Look look(const Piece& piece) const {
    return look_at(index_, corners_C_, radius_m_, piece, /*beyond_m=*/0.0);
  }

  void visit(const Piece& piece) {
    if (finished_) return;
    if (deadline_.passed()) {
      timed_out_ = finished_ = true;
      return;
    }
    const Look seen = look(piece);
    if (!seen.distance_m) {
      close();
      return;
    }
    const double resolution_m = *seen.distance_m == 0.0 ? options_.gap_m : options_.tolerance_m;
    if (seen.deviation_m <= resolution_m || !piece.splittable()) {
      extend(piece);
      return;
    }
    visit(piece.left());
    visit(piece.right());
  }

  void extend(const Piece& piece) {
    if (!last_colliding_) begin_s_ = first_not_free(piece).value_or(piece.begin_s());
    last_colliding_ = piece;
  }

  void close() {
    if (!last_colliding_) return;
    const double end_s = last_not_free(*last_colliding_).value_or(last_colliding_->end_s());
    intervals_.push_back({begin_s_, end_s});
    last_colliding_.reset();
    finished_ = finished_ || only_first_;
  }

  // Where, at the finest resolution, the first part of `piece` begins that is not free.
  [[nodiscard]] std::optional<double> first_not_free(const Piece& piece) const {
    const Look seen = look(piece);
    if (!seen.distance_m) return std::nullopt;
    if (seen.deviation_m <= options_.tolerance_m || !piece.splittable()) return piece.begin_s();
    const std::optional<double> left = first_not_free(piece.left());
    return left ? left : first_not_free(piece.right());
  }

  // Where the last such part ends.
  [[nodiscard]] std::optional<double> last_not_free(const Piece& piece) const {
    const Look seen = look(piece);
    if (!seen.distance_m) return std::nullopt;
    if (seen.deviation_m <= options_.tolerance_m || !piece.splittable()) return piece.end_s();
    const std::optional<double> right = last_not_free(piece.right());
    return right ? right : last_not_free(piece.left());
  }

  const scene::SceneIndex& index_;
  const motion::Corners& corners_C_;
  const double radius_m_;
  const DetectOptions& options_;
  const Deadline& deadline_;
  const bool only_first_;

  bool finished_ = false;
  bool timed_out_ = false;
  double begin_s_ = 0.0;
  std::optional<Piece> last_colliding_;
  std::vector<CollisionInterval> intervals_;
};

}  // namespace

std::optional<std::vector<CollisionInterval>> detect_collisions(
    const scene::SceneIndex& index, const motion::Path& path, const motion::Corners& corners_C,
    double t_begin_s, double t_end_s, const DetectOptions& options, const Deadline& deadline) {
  Detector detector(index, corners_C, options, deadline, /*only_first=*/false);
  detector.run(path, t_begin_s, t_end_s);
  if (detector.timed_out()) return std::nullopt;
  std::vector<CollisionInterval> intervals = detector.intervals();
  if (intervals.size() > 1) {
    const double travel_m = travel_bound_m(path, motion::body_radius_m(corners_C));
    join_close_intervals(intervals, options.gap_m / travel_m * (path.end_s() - path.begin_s()));
  }
  return intervals;
}

FirstCollision first_collision(const scene::SceneIndex& index, const motion::Path& path,
                               const motion::Corners& corners_C, double t_begin_s, double t_end_s,
                               const DetectOptions& options, const Deadline& deadline) {
  Detector detector(index, corners_C, options, deadline, /*only_first=*/true);
  detector.run(path, t_begin_s, t_end_s);
  if (detector.timed_out()) return {false, std::nullopt};
  if (detector.intervals().empty()) return {};
  return {true, detector.intervals().front()};
}

}  // namespace camway::collision
