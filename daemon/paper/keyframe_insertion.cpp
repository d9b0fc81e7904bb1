// SPDX-License-Identifier: MIT
#include "daemon/paper/keyframe_insertion.h"

#include <algorithm>
#include <utility>

#include "daemon/motion/spline/interpolate.h"
#include "daemon/paper/push_out.h"

namespace camway::paper {

namespace {

using collision::CollisionInterval;
using collision::FirstCollision;
using motion::Keyframe;

// Largest speed towards a new keyframe, as a multiple of the average. Beyond it the spline swings
// out by far more than the depth of the collision and collides anew: the method diverges.
constexpr double kMostHurry = 10.0;

// Margin of a new keyframe, in tolerances of detection. A body within one tolerance counts as
// colliding; the margin leaves room for the path to leave the keyframe at a slant.
constexpr double kMarginTolerances = 10.0;

class Corrector {
 public:
  Corrector(const scene::SceneIndex& index, std::vector<Keyframe> keyframes,
            const motion::Corners& corners_C, const KeyframeInsertionOptions& options,
            const base::Deadline& deadline)
      : index_(index),
        corners_C_(corners_C),
        body_(corners_C),
        options_(options),
        deadline_(deadline),
        radius_m_(motion::body_radius_m(corners_C)),
        keyframes_(std::move(keyframes)),
        mean_speed_m_per_s_(mean_speed_m_per_s()),
        path_(motion::interpolate(keyframes_, options.origin)) {}

  KeyframeInsertionResult run() && {
    KeyframeInsertionResult result;
    for (; result.rounds < options_.max_rounds; ++result.rounds) {
      const Round round = go_through();
      result.gave_up = round.gave_up;
      if (timed_out_ || round.corrected == 0) break;
    }
    result.keyframes = std::move(keyframes_);
    result.path = std::move(path_);
    result.timed_out = timed_out_;
    return result;
  }

 private:
  struct Round {
    int corrected = 0;
    int gave_up = 0;
  };

  // One pass along the path.
  Round go_through() {
    Round round;
    double cursor_s = path_.begin_s();
    while (!timed_out_) {
      const std::optional<CollisionInterval> interval = next_collision(cursor_s, path_.end_s());
      if (!interval) break;
      const std::vector<Keyframe> before = keyframes_;
      if (correct(*interval, 0)) {
        ++round.corrected;
      } else {
        ++round.gave_up;
        keyframes_ = before;
        path_ = motion::interpolate(keyframes_, options_.origin);
      }
      if (interval->t_end_s <= cursor_s) break;
      cursor_s = interval->t_end_s;
    }
    return round;
  }

  // The first collision in the window: of the sides of the swept tube by the paper's sweep, and of
  // enclosed objects by the distance-based check of everything before.
  std::optional<CollisionInterval> next_collision(double t_begin_s, double t_end_s) {
    const FirstCollision side = first_sweep_collision(index_, path_, corners_C_, t_begin_s, t_end_s,
                                                      options_.sweep, deadline_);
    const double before_s = side.interval ? side.interval->t_begin_s : t_end_s;
    const FirstCollision enclosed =
        collision::first_collision({collision::Obstacles(index_), body_, options_.sweep.detect},
                                   path_, t_begin_s, before_s, deadline_);
    timed_out_ = timed_out_ || !side.decided || !enclosed.decided;
    if (!enclosed.interval) return side.interval;
    // The interval was cut off at `before_s`: it is the beginning of the same collision.
    if (side.interval && enclosed.interval->t_end_s >= before_s) {
      return CollisionInterval{enclosed.interval->t_begin_s, side.interval->t_end_s};
    }
    return enclosed.interval;
  }

  // Inserts a keyframe in the middle of `interval` and corrects the collisions that remain in it.
  // Returns whether the interval is free at the end.
  bool correct(const CollisionInterval& interval, int recursion) {
    if (recursion > options_.max_recursion || !insert_at_middle(interval)) return false;
    double cursor_s = interval.t_begin_s;
    while (const std::optional<CollisionInterval> rest =
               next_collision(cursor_s, interval.t_end_s)) {
      if (!correct(*rest, recursion + 1) || rest->t_end_s <= cursor_s) return false;
      cursor_s = rest->t_end_s;
    }
    return !timed_out_;
  }

  bool insert_at_middle(const CollisionInterval& interval) {
    const double t_mid_s = options_.origin.nearest_s(0.5 * (interval.t_begin_s + interval.t_end_s));
    const auto next = std::upper_bound(
        keyframes_.begin(), keyframes_.end(), t_mid_s,
        [](double time_s, const Keyframe& keyframe) { return time_s < keyframe.time_s; });
    if (next == keyframes_.begin() || next == keyframes_.end()) return false;
    if (inserted() >= options_.max_inserted_keyframes) return false;
    const PushOut pushed = push_out(index_, corners_C_, path_.pose(t_mid_s),
                                    kMarginTolerances * options_.sweep.detect.tolerance_m);
    if (pushed.outcome != PushOutOutcome::kFree) return false;
    const Keyframe inserted{t_mid_s, pushed.pose, motion::KeyframeOrigin::kInserted};
    if (hurries(*std::prev(next), inserted) || hurries(inserted, *next)) return false;
    keyframes_.insert(next, inserted);
    path_ = motion::interpolate(keyframes_, options_.origin);
    return true;
  }

  // About how far the body moves between two keyframes on the direct way.
  [[nodiscard]] double travel_m(const Keyframe& from, const Keyframe& to) const {
    return (to.pose.position - from.pose.position).norm() +
           radius_m_ * from.pose.orientation.angularDistance(to.pose.orientation);
  }

  [[nodiscard]] double mean_speed_m_per_s() const {
    double travelled_m = 0.0;
    for (std::size_t i = 1; i < keyframes_.size(); ++i) {
      travelled_m += travel_m(keyframes_[i - 1], keyframes_[i]);
    }
    return travelled_m / (keyframes_.back().time_s - keyframes_.front().time_s);
  }

  [[nodiscard]] bool hurries(const Keyframe& from, const Keyframe& to) const {
    return travel_m(from, to) >= kMostHurry * mean_speed_m_per_s_ * (to.time_s - from.time_s);
  }

  [[nodiscard]] std::ptrdiff_t inserted() const {
    return std::count_if(keyframes_.begin(), keyframes_.end(), [](const Keyframe& keyframe) {
      return keyframe.origin == motion::KeyframeOrigin::kInserted;
    });
  }

  const scene::SceneIndex& index_;
  const motion::Corners& corners_C_;
  const motion::Body body_;  ///< the near quadrilateral with these corners
  const KeyframeInsertionOptions& options_;
  const base::Deadline& deadline_;
  const double radius_m_;

  std::vector<Keyframe> keyframes_;
  const double mean_speed_m_per_s_;  // of the given keyframes
  motion::Path path_;
  bool timed_out_ = false;
};

}  // namespace

KeyframeInsertionResult insert_keyframes(const scene::SceneIndex& index,
                                         const std::vector<motion::Keyframe>& keyframes,
                                         const motion::Corners& corners_C,
                                         const KeyframeInsertionOptions& options,
                                         const base::Deadline& deadline) {
  return Corrector(index, keyframes, corners_C, options, deadline).run();
}

}  // namespace camway::paper
