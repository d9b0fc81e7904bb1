// SPDX-License-Identifier: MIT
#include "daemon/correction/relaxation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "daemon/correction/orientation_rule.h"

namespace camway::correction {

namespace {

using geometry::Vec4;
using motion::CubicPoint;

// Chosen by measurement; none changes what is proved.
constexpr int kSamplesAStep = 3;    // between two knots
constexpr double kMargin = 0.03;    // of the ball's radius, kept at the samples
constexpr double kKeptShare = 0.8;  // of the gap, where that is smaller already
constexpr double kRuleMargin = 0.3 * kOrientationAllowance_rad;  // kept at the samples
constexpr int kRounds = 10;  // of relaxing, with more samples each time
constexpr double kRetreat = 0.6;
constexpr int kRetreats = 3;     // towards the correction it began with
constexpr double kSpread = 1.5;  // of the gap: over how much of it an offset fades out
constexpr int kSweeps = 16;
constexpr int kPolishedKnots = 12;
constexpr double kHorizon = 0.5;      // of the ball's radius: gaps are not measured further
constexpr double kSafeComfort = 3.0;  // of the ball's radius: a gap that is as good as any
constexpr double kSafeStep = 0.15;    // of the ball's radius

/// Weights of the squared distance from the original, and of squared first and second differences
/// of the path's control points.
struct Weights {
  double distance;
  double stretch;
  double bend;
};

Weights weights_of(Objective objective, int count) {
  switch (objective) {
    case Objective::kClosest:
      return {1.0, 0.0, std::pow(kSpread * count, 4.0)};
    case Objective::kShortest:
      return {0.0, 1.0, 0.05};
    case Objective::kSmoothest:
    case Objective::kSafest:
      return {0.0, 0.0, 1.0};
  }
  return {1.0, 0.0, 1.0};
}

CubicPoint operator+(const CubicPoint& a, const CubicPoint& b) {
  return {a.position + b.position, a.image + b.image};
}
CubicPoint operator-(const CubicPoint& a, const CubicPoint& b) {
  return {a.position - b.position, a.image - b.image};
}
CubicPoint operator*(double factor, const CubicPoint& a) {
  return {factor * a.position, factor * a.image};
}

/// The path, and beyond its ends the straight line that goes on as it does there: a natural end.
CubicPoint extended(const motion::CubicPath& path, double time_s) {
  const bool is_before = time_s < path.begin_s();
  if (!is_before && time_s <= path.end_s()) return path.at(time_s);
  const motion::CubicPiece& piece = is_before ? path.pieces.front() : path.pieces.back();
  const std::size_t i = is_before ? 0 : 2;  // the leg of the control polygon at that end
  const double legs =
      3.0 / (piece.t1_s - piece.t0_s) * (time_s - (is_before ? piece.t0_s : piece.t1_s));
  const std::size_t end = is_before ? 0 : 3;
  return {piece.position[end] + legs * (piece.position[i + 1] - piece.position[i]),
          piece.image[end] + legs * (piece.image[i + 1] - piece.image[i])};
}

/// The four bumps that are not zero between two knots, at `v` in [0, 1] of the way.
std::array<double, 4> weights_at(double v) {
  return {motion::bump_value(1.0 + v), motion::bump_value(v), motion::bump_value(1.0 - v),
          motion::bump_value(2.0 - v)};
}

class Relaxation {
 public:
  Relaxation(const Problem& problem, const Offsets& offsets, Ends ends, Objective objective,
             FreeSpace& space)
      : problem_(problem),
        space_(space),
        knots_(offsets.knots),
        objective_(objective),
        weights_(weights_of(objective, offsets.knots.count)),
        radius_m_(space.ball_radius_m()) {
    choose_range(ends);
    for (int k = first_ - kOutside; k <= last_ + kOutside; ++k) {
      path_.push_back(extended(problem.path, knots_.knot_s(k)));
      original_.push_back(extended(problem.original, knots_.knot_s(k)));
    }
    begin_with(offsets);
    sample();
  }

  void begin_with(const Offsets& offsets) {
    coefficients_.clear();
    for (int k = first_ - kOutside; k <= last_ + kOutside; ++k)
      coefficients_.push_back(k >= first_ && k <= last_ ? offsets(k) : CubicPoint{});
    is_active_.assign(coefficients_.size(), true);
    hold_keyframes();
  }

  /// From now on the body has to be free there too. Takes back what was done about it: as much as
  /// it takes to be free at all samples again, old and new.
  void watch(const collision::CollisionInterval& collision, const Offsets& free) {
    const double middle_s = 0.5 * (collision.t_begin_s + collision.t_end_s);
    const int middle = knot_before(middle_s);
    for (int width = 2; width <= 2 * (last_ - first_ + 4); width *= 2) {
      const int low = std::max(first_, middle - width);
      const int high = std::min(last_, middle + 1 + width);
      for (int k = low; k <= high; ++k) coefficient(k) = free(k);
      hold_keyframes();
      if (!is_free_between(low, high) || !is_free_on(collision)) continue;
      for (int k = std::max(first_, low - 3); k <= std::min(last_, high + 3); ++k)
        is_active_[slot(k)] = true;
      break;
    }
    for (const double share : {0.0, 0.5, 1.0}) {
      const double time_s = std::lerp(collision.t_begin_s, collision.t_end_s, share);
      add_sample(knot_before(time_s), place_after_knot(time_s));
    }
  }

  [[nodiscard]] Offsets run(const collision::Deadline& deadline) {
    for (int sweep = 0; sweep < kSweeps && !deadline.passed(); ++sweep) {
      bool changed = false;
      for (int i = first_; i <= last_; ++i) {
        // To and fro, so that nothing drifts to one side.
        const int k = sweep % 2 == 0 ? i : first_ + last_ - i;
        if (is_held(k) || !is_active_[slot(k)]) continue;
        const bool moved = improve(k);
        is_active_[slot(k)] = moved;
        changed = changed || moved;
        // What was blocked may be free to move now.
        for (int j = std::max(first_, k - 3); moved && j <= std::min(last_, k + 3); ++j)
          is_active_[slot(j)] = true;
      }
      if (!changed) break;
    }
    Offsets result{knots_, first_, {}};
    for (int k = first_; k <= last_; ++k) result.at.push_back(coefficient(k));
    return result;
  }

 private:
  static constexpr int kOutside = 4;  ///< zeros on either side, for differences

  struct Sample {
    CubicPoint path;
    std::size_t first;  ///< of the four coefficients
    std::array<double, 4> weights;
    double margin_m;
    motion::Pose interpolated;  ///< what the rule for orientations compares with
    double rule_margin = 0.0;   ///< that it is met by
    /// Where the body was asked about last and found free, and how far it was from the scene there:
    /// until it has moved by that, there is no need to ask again.
    motion::SignedPose known{};
    double known_gap_m = 0.0;
  };

  /// Which coefficients there are: with free ends also some before the first keyframe and after the
  /// last, as far as they do not reach the next keyframe, so that the path can swing through.
  void choose_range(Ends ends) {
    first_ = 2;
    last_ = knots_.count - 2;
    if (ends == Ends::kFixed) return;
    holds_keyframes_ = true;
    const double spacing_s = knots_.spacing_s();
    const auto beyond = [&](bool is_path_end, double room_s) {
      const int most = knots_.count / 2;
      if (is_path_end) return 1;
      return std::clamp(static_cast<int>(room_s / spacing_s) - 2, 0, most);
    };
    const std::size_t gap = problem_.gap;
    const std::vector<double>& times_s = problem_.keyframes_s;
    first_ = -beyond(gap == 0, gap == 0 ? 0.0 : times_s[gap] - times_s[gap - 1]);
    const bool is_last = gap + 2 == times_s.size();
    last_ = knots_.count + beyond(is_last, is_last ? 0.0 : times_s[gap + 2] - times_s[gap + 1]);
  }

  [[nodiscard]] bool is_held(int k) const {
    return holds_keyframes_ && (k == 0 || k == knots_.count);
  }
  [[nodiscard]] std::size_t slot(int k) const {
    return static_cast<std::size_t>(k - first_ + kOutside);
  }
  CubicPoint& coefficient(int k) { return coefficients_[slot(k)]; }
  [[nodiscard]] const CubicPoint& coefficient(int k) const { return coefficients_[slot(k)]; }

  void hold_keyframes() {
    if (!holds_keyframes_) return;
    for (const int k : {0, knots_.count})
      coefficient(k) = holding(coefficient(k - 1), coefficient(k + 1));
  }

  [[nodiscard]] int knot_before(double time_s) const {
    const double place = (time_s - knots_.begin_s) / knots_.spacing_s();
    return static_cast<int>(std::clamp(std::floor(place), first_ - 2.0, last_ + 1.0));
  }
  [[nodiscard]] double place_after_knot(double time_s) const {
    const double place = (time_s - knots_.begin_s) / knots_.spacing_s();
    return std::clamp(place - knot_before(time_s), 0.0, 1.0);
  }

  bool is_free_between(int low, int high) {
    return std::ranges::all_of(samples_, [&](const Sample& sample) {
      const bool uses = sample.first + 3 >= slot(low) && sample.first <= slot(high);
      if (!uses) return true;
      const motion::Pose now = pose(sample);
      return space_.is_free(now, 0.0) && meets_rule(sample, now);
    });
  }

  bool is_free_on(const collision::CollisionInterval& collision) {
    for (const double share : {0.0, 0.5, 1.0}) {
      const double time_s = std::lerp(collision.t_begin_s, collision.t_end_s, share);
      const int k = knot_before(time_s);
      const Sample sample = sample_at(time_s, k, place_after_knot(time_s));
      const motion::Pose now = pose(sample);
      if (!space_.is_free(now, 0.0) || !meets_rule(sample, now)) return false;
    }
    return true;
  }

  void sample() {
    for (int k = first_ - 2; k < last_ + 2; ++k) {
      for (int m = 0; m < kSamplesAStep; ++m) add_sample(k, (m + 0.5) / kSamplesAStep);
    }
  }

  // `v` of the way from knot `k` to the next.
  void add_sample(int k, double v) {
    const double time_s = std::lerp(knots_.knot_s(k), knots_.knot_s(k + 1), v);
    if (time_s <= problem_.path.begin_s() || time_s >= problem_.path.end_s()) return;
    if (is_others(time_s)) return;
    Sample sample = sample_at(time_s, k, v);
    look(sample);
    sample.margin_m = std::min(kMargin * radius_m_, kKeptShare * std::max(0.0, sample.known_gap_m));
    const double room = rule_room(space_.policy(), pose(sample), sample.interpolated);
    sample.rule_margin = std::min(kRuleMargin, kKeptShare * std::max(0.0, room));
    samples_.push_back(sample);
  }

  [[nodiscard]] Sample sample_at(double time_s, int k, double v) const {
    return {problem_.path.at(time_s), slot(k - 1), weights_at(v), 0.0,
            problem_.original.pose(time_s)};
  }

  [[nodiscard]] bool meets_rule(const Sample& sample, const motion::Pose& now) const {
    return rule_room(space_.policy(), now, sample.interpolated) >= sample.rule_margin;
  }

  void look(Sample& sample) {
    const motion::Pose now = pose(sample);
    sample.known = motion::signed_pose(now);
    sample.known_gap_m = space_.gap_m(now, kHorizon * radius_m_);
  }

  bool is_free(Sample& sample) {
    const motion::Pose unsigned_now = pose(sample);
    if (!meets_rule(sample, unsigned_now)) return false;
    const motion::SignedPose now = motion::signed_pose(unsigned_now);
    // A point at radius ρ moves by 2ρ·sin a where the quaternions are an angle a apart; signs
    // agree, as both are squares of images close to each other.
    const double moved_m =
        (now.position - sample.known.position).norm() +
        2.0 * space_.body().radius_m() * (now.orientation - sample.known.orientation).norm();
    if (moved_m + sample.margin_m < sample.known_gap_m) return true;
    const double gap_m = space_.gap_m(motion::unsigned_pose(now), kHorizon * radius_m_);
    if (!(gap_m > sample.margin_m)) return false;
    sample.known = now;
    sample.known_gap_m = gap_m;
    return true;
  }

  [[nodiscard]] bool is_others(double time_s) const {
    return std::ranges::any_of(problem_.others, [&](const collision::CollisionInterval& other) {
      return other.t_begin_s <= time_s && time_s <= other.t_end_s;
    });
  }

  [[nodiscard]] motion::Pose pose(const Sample& sample) const {
    CubicPoint point = sample.path;
    for (std::size_t i = 0; i < 4; ++i)
      point = point + sample.weights[i] * coefficients_[sample.first + i];
    return motion::pose_of(problem_.path.reference, point);
  }

  /// How much the coefficient at knot `i` changes when that at `k` does by 1: those at keyframes
  /// follow.
  [[nodiscard]] double follows(int i, int k) const {
    if (i == k) return 1.0;
    const bool is_next = is_held(i) && (i == k - 1 || i == k + 1);
    return is_next ? -motion::kBumpShoulder / motion::kBumpPeak : 0.0;
  }

  [[nodiscard]] bool is_on_path(int k) const {
    const double time_s = knots_.knot_s(k);
    return time_s >= problem_.path.begin_s() && time_s <= problem_.path.end_s();
  }

  /// The change of the coefficient that makes the objective least while the others stay.
  [[nodiscard]] CubicPoint wanted_change(int k) const {
    const auto value = [&](int i) { return path_[slot(i)] + coefficient(i); };
    CubicPoint sum;
    double weight = 0.0;
    const auto count = [&](double factor, double share, const CubicPoint& term) {
      sum = sum - (factor * share) * term;
      weight += factor * share * share;
    };
    for (int i = k - 2; i <= k + 2; ++i) {
      if (!is_on_path(i)) continue;
      const double here = follows(i, k);
      const double before = follows(i - 1, k);
      const double after = follows(i + 1, k);
      count(weights_.distance, here, value(i) - original_[slot(i)]);
      count(weights_.stretch, here - before, value(i) - value(i - 1));
      count(weights_.bend, before - 2.0 * here + after,
            value(i - 1) - 2.0 * value(i) + value(i + 1));
    }
    return (1.0 / weight) * sum;
  }

  bool improve(int k) {
    if (objective_ == Objective::kSafest && step_away(k)) return true;
    CubicPoint change = wanted_change(k);
    if (!space_.may_turn()) change.image.setZero();
    if (moves(k, change) || moves(k, 0.5 * change)) return true;
    // Blocked in one direction it may slide in the others.
    bool moved = moves(k, {geometry::Vec3::Zero(), change.image});
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      CubicPoint part;
      part.position[axis] = change.position[axis];
      moved = moves(k, part) || moved;
    }
    return moved;
  }

  bool moves(int k, const CubicPoint& change) {
    const double size_m = change.position.norm() + 4.0 * radius_m_ * change.image.norm();
    if (!(size_m > kSettled * radius_m_)) return false;
    const CubicPoint old = coefficient(k);
    set(k, old + change);
    if (is_free_about(k)) return true;
    set(k, old);
    return false;
  }

  void set(int k, const CubicPoint& value) {
    coefficient(k) = value;
    hold_keyframes();
  }

  template <class Visit>
  bool for_samples_about(int k, Visit visit) {
    const int low = is_held(k - 1) ? k - 1 : k;
    const int high = is_held(k + 1) ? k + 1 : k;
    for (Sample& sample : samples_) {
      const bool uses = sample.first + 3 >= slot(low) && sample.first <= slot(high);
      if (uses && !visit(sample)) return false;
    }
    return true;
  }

  bool is_free_about(int k) {
    return for_samples_about(k, [&](Sample& sample) { return is_free(sample); });
  }

  // A step in the direction, of six, that makes the smallest gap about a knot larger.
  bool step_away(int k) {
    const CubicPoint old = coefficient(k);
    const auto least_gap_m = [&] {
      double least_m = std::numeric_limits<double>::infinity();
      for_samples_about(k, [&](Sample& sample) {
        const motion::Pose now = pose(sample);
        least_m = meets_rule(sample, now)
                      ? std::min(least_m, space_.gap_m(now, kSafeComfort * radius_m_))
                      : 0.0;
        return least_m > 0.0;
      });
      return least_m;
    };
    const double before_m = least_gap_m();
    if (before_m >= kSafeComfort * radius_m_) return false;
    for (int code = 0; code < 6; ++code) {
      const double sign = code % 2 == 0 ? 1.0 : -1.0;
      CubicPoint moved = old;
      moved.position += sign * kSafeStep * radius_m_ * geometry::Vec3::Unit(code / 2);
      set(k, moved);
      if (least_gap_m() > before_m + 0.1 * kSafeStep * radius_m_) return true;
    }
    set(k, old);
    return false;
  }

  static constexpr double kSettled = 5e-3;  // of the ball's radius: changes below do not matter

  const Problem& problem_;
  FreeSpace& space_;
  const motion::KnotRow knots_;
  const Objective objective_;
  const Weights weights_;
  const double radius_m_;
  int first_ = 0;  ///< knots of the first and the last coefficient
  int last_ = 0;
  bool holds_keyframes_ = false;
  std::vector<CubicPoint> coefficients_;
  std::vector<CubicPoint> path_;      ///< at the same knots
  std::vector<CubicPoint> original_;  ///< and there
  std::vector<bool> is_active_;       ///< whether another look at a coefficient may change it
  std::vector<Sample> samples_;
};

Offsets mixed(const Offsets& a, const Offsets& b, double share_of_b) {
  Offsets result = b;
  for (int k = b.first; k <= b.last(); ++k) {
    result.at[static_cast<std::size_t>(k - b.first)] =
        (1.0 - share_of_b) * a(k) + share_of_b * b(k);
  }
  return result;
}

}  // namespace

Relaxed relaxed(const Problem& problem, Relaxed free, Ends ends, Objective objective,
                FreeSpace& space, const collision::Deadline& deadline) {
  Relaxation relaxation(problem, free.offsets, ends, objective, space);
  Offsets better = free.offsets;
  for (int i = 0; i < kRounds && !deadline.passed(); ++i) {
    better = relaxation.run(deadline);
    Attempt tried = attempt(problem, {bumps_for(better, ends)}, space, deadline);
    if (tried.candidate) return {better, std::move(*tried.candidate)};
    // Something slips through between the samples: then there is to be one.
    relaxation.watch(*tried.collision, free.offsets);
  }
  double share = kRetreat;
  for (int i = 0; i < kRetreats && !deadline.passed(); ++i, share *= kRetreat) {
    const Offsets between = mixed(free.offsets, better, share);
    Attempt tried = attempt(problem, {bumps_for(between, ends)}, space, deadline);
    if (tried.candidate) return {between, std::move(*tried.candidate)};
  }
  return free;
}

std::optional<Candidate> polished(const Problem& problem, Objective objective, FreeSpace& space,
                                  const collision::Deadline& deadline) {
  const Offsets none{{problem.gap_begin_s(), problem.gap_end_s(), kPolishedKnots}, 1, {}};
  Relaxed better = relaxed(problem, {none, {}}, Ends::kFree, objective, space, deadline);
  if (better.candidate.rows.empty()) return std::nullopt;
  return std::move(better.candidate);
}

}  // namespace camway::correction
