// SPDX-License-Identifier: MIT
#include "daemon/paper/sweep_detection.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "daemon/collision/near_quad.h"
#include "daemon/paper/camera_triangles.h"
#include "daemon/paper/swept_surface.h"

namespace camway::paper {

namespace {

using collision::CollisionInterval;
using collision::FirstCollision;

// Halving a double interval more often than it has bits of mantissa changes nothing.
constexpr int kMaxBisections = 60;

// A run of consecutive parameter steps in which swept triangles touch the scene.
struct HitRun {
  double t_a;  // lowest parameter of the last step without a hit before the run
  double t_b;  // highest parameter of the first step with a hit
  double t_c;  // lowest parameter of the last step with a hit
  double t_d;  // highest parameter of the first step without a hit after the run
};

// Traverses the swept surface in order of its parameters. Each segment of the path is tessellated
// when it is reached, as the first collision is often near.
class SweepWalk {
 public:
  SweepWalk(const scene::SceneIndex& index, const motion::Path& path,
            const motion::Corners& corners_C, double chord_error_m, double t_begin_s,
            double t_end_s)
      : index_(index),
        path_(path),
        corners_C_(corners_C),
        chord_error_m_(chord_error_m),
        t_end_s_(t_end_s),
        t_a_(t_begin_s),
        tessellated_to_s_(t_begin_s),
        segment_(path.segment_index(t_begin_s)) {}

  // The next run, or nothing at the end of the path or when the deadline strikes.
  std::optional<HitRun> next_run(const base::Deadline& deadline) {
    std::optional<HitRun> run;
    while (!deadline.passed()) {
      const std::optional<Step> step = take_step();
      if (!step) return run;
      if (step->hit) {
        if (!run) run = HitRun{t_a_, step->last_s, step->first_s, t_end_s_};
        run->t_c = step->first_s;
      } else if (run) {
        run->t_d = t_a_ = step->last_s;
        return run;
      } else {
        t_a_ = step->first_s;
      }
    }
    return std::nullopt;
  }

 private:
  struct Step {
    double first_s;
    double last_s;
    bool hit;
  };

  // Takes all triangles that begin at the same parameter: those of one step on the four sides.
  std::optional<Step> take_step() {
    while (next_ >= triangles_.size()) {
      if (!tessellate_next_segment()) return std::nullopt;
    }
    Step step{triangles_[next_].first_time_s(), triangles_[next_].last_time_s(), false};
    for (; next_ < triangles_.size() && triangles_[next_].first_time_s() == step.first_s; ++next_) {
      step.last_s = std::max(step.last_s, triangles_[next_].last_time_s());
      step.hit = step.hit || camera_triangles_->first_hit(static_cast<std::uint32_t>(next_));
    }
    return step;
  }

  bool tessellate_next_segment() {
    if (segment_ >= path_.segments().size() || tessellated_to_s_ >= t_end_s_) return false;
    const double to_s = std::min(path_.segments()[segment_++].t1_s, t_end_s_);
    triangles_ =
        tessellate_swept_surface(path_, corners_C_, chord_error_m_, tessellated_to_s_, to_s);
    tessellated_to_s_ = to_s;
    next_ = 0;
    camera_triangles_.emplace(index_);
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      camera_triangles_->insert(static_cast<std::uint32_t>(i), triangles_[i].triangle());
    }
    return true;
  }

  const scene::SceneIndex& index_;
  const motion::Path& path_;
  const motion::Corners& corners_C_;
  const double chord_error_m_;
  const double t_end_s_;

  double t_a_;
  double tessellated_to_s_;
  std::size_t segment_;
  std::vector<SweptTriangle> triangles_;
  std::optional<CameraTriangles> camera_triangles_;
  std::size_t next_ = 0;
};

class Bisection {
 public:
  Bisection(const scene::SceneIndex& index, const motion::Path& path,
            const motion::Corners& corners_C, double tolerance_m)
      : index_(index), path_(path), corners_C_(corners_C), tolerance_m_(tolerance_m) {}

  // Returns the last parameter known to be free next to a change between `free_s` and `colliding_s`
  // (in either order); nothing if these two do not bracket one.
  [[nodiscard]] std::optional<double> boundary(double free_s, double colliding_s) const {
    if (collides_at(free_s) || !collides_at(colliding_s)) return std::nullopt;
    for (int i = 0; i < kMaxBisections && corner_motion_m(free_s, colliding_s) > tolerance_m_;
         ++i) {
      const double t_mid_s = 0.5 * (free_s + colliding_s);
      (collides_at(t_mid_s) ? colliding_s : free_s) = t_mid_s;
    }
    return free_s;
  }

 private:
  [[nodiscard]] bool collides_at(double time_s) const {
    return collision::collides(index_, corners_C_, path_.pose(time_s));
  }

  [[nodiscard]] double corner_motion_m(double t0_s, double t1_s) const {
    const motion::Corners at_t0_W = motion::corners_W(corners_C_, path_.pose(t0_s));
    const motion::Corners at_t1_W = motion::corners_W(corners_C_, path_.pose(t1_s));
    double largest = 0.0;
    for (std::size_t i = 0; i < at_t0_W.size(); ++i) {
      largest = std::max(largest, (at_t1_W[i] - at_t0_W[i]).norm());
    }
    return largest;
  }

  const scene::SceneIndex& index_;
  const motion::Path& path_;
  const motion::Corners& corners_C_;
  double tolerance_m_;
};

}  // namespace

FirstCollision first_sweep_collision(const scene::SceneIndex& index, const motion::Path& path,
                                     const motion::Corners& corners_C, double t_begin_s,
                                     double t_end_s, const SweepOptions& options,
                                     const base::Deadline& deadline) {
  SweepWalk walk(index, path, corners_C, options.chord_error_m, t_begin_s, t_end_s);
  const Bisection bisection(index, path, corners_C, options.detect.tolerance_m);
  const motion::Body body(corners_C);
  const collision::Query query{collision::Obstacles(index), body, options.detect};
  while (const std::optional<HitRun> run = walk.next_run(deadline)) {
    const std::optional<double> t_i = bisection.boundary(run->t_a, run->t_b);
    const std::optional<double> t_f = bisection.boundary(run->t_d, run->t_c);
    if (t_i && t_f && *t_i <= *t_f) return {true, CollisionInterval{*t_i, *t_f}};
    const FirstCollision settled =
        collision::first_collision(query, path, run->t_a, run->t_d, deadline);
    if (!settled.decided || settled.interval) return settled;
  }
  return {!deadline.passed(), std::nullopt};
}

}  // namespace camway::paper
