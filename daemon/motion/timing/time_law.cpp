// SPDX-License-Identifier: MIT
#include "daemon/motion/timing/time_law.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include <boost/math/quadrature/gauss.hpp>

#include "daemon/motion/path/bezier.h"

namespace camway::motion {
namespace {

using geometry::Vec3;

/// The limits at one given time.
struct Knot {
  double t_s;
  bool is_of_path;  ///< whether a segment of the path begins or ends there
  double cap;       ///< cap of x by speed, turn rate and the given time
  Vec3 first;       ///< P'
  Vec3 second;      ///< P''
};

/// Knots at the ends of segments, and at most `step_s` apart.
std::vector<Knot> knots_of(const Path& path, const RateLimits& limits, double step_s) {
  std::vector<Knot> knots;
  const auto add = [&](const Segment& segment, double u, bool is_of_path) {
    const SegmentDerivatives at = derivatives_at(segment, u);
    const double speed = limits.speed_m_per_s / at.velocity_m_per_s.norm();
    const double turn = limits.turn_rate_rad_per_s / (2.0 * at.orientation_rate_per_s.norm());
    const double rate = std::min({1.0, speed, turn});
    knots.push_back({segment_time_s(segment, u), is_of_path, rate * rate, at.velocity_m_per_s,
                     at.acceleration_m_per_s2});
  };
  for (const Segment& segment : path.segments()) {
    const double steps = std::max(1.0, std::ceil((segment.t1_s - segment.t0_s) / step_s));
    for (double i = 0.0; i < steps; ++i) add(segment, i / steps, i == 0.0);
  }
  add(path.segments().back(), 1.0, true);
  return knots;
}

/// The u with |second x + first u| <= a for a given x: all, some or none.
class AccelerationBound {
 public:
  AccelerationBound(const Vec3& first, const Vec3& second, double limit_m_per_s2)
      : limit_(limit_m_per_s2), speed_(first.norm()) {
    if (speed_ > 0.0) along_ = second.dot(first) / speed_ / speed_;
    across_ = (second - along_ * first).norm();
  }

  /// Narrows [least, most] to the range that the bound allows; false if that is empty.
  [[nodiscard]] bool narrow(double x, double& least, double& most) const {
    const double left = limit_ - across_ * x;
    if (!(left >= 0.0)) return false;
    if (!(speed_ > 0.0)) return true;
    const double reach = std::sqrt(left * (limit_ + across_ * x)) / speed_;
    least = std::max(least, -along_ * x - reach);
    most = std::min(most, -along_ * x + reach);
    return least <= most;
  }

 private:
  double limit_;
  double speed_;
  double along_ = 0.0;
  double across_;
};

/// From one control value x of the spline to the next.
struct Stage {
  double step_s;
  std::vector<AccelerationBound> bounds;
};

/// The two passes of the analysis over stages 0..n-1, between control values 0..n.
class Reachability {
 public:
  Reachability(const std::vector<Knot>& knots, double limit_m_per_s2) {
    const std::size_t last = knots.size() - 1;
    const auto clamped = [&](std::size_t i, std::size_t back) { return i < back ? 0 : i - back; };
    for (const Knot& knot : knots)
      floor_ = std::min({floor_, knot.cap, limit_m_per_s2 / knot.second.norm()});
    // Control value i affects x only between knots i - 1 and i, both included.
    for (std::size_t i = 0; i <= last + 1; ++i) {
      largest_.push_back(std::min(knots[clamped(i, 1)].cap, knots[std::min(i, last)].cap));
    }
    // Stage i acts from knot i - 1 to knot i + 1.
    for (std::size_t i = 0; i <= last; ++i) {
      const std::size_t before = clamped(i, 1);
      const std::size_t after = std::min(i + 1, last);
      Stage stage{(knots[after].t_s - knots[before].t_s) / 2.0, {}};
      for (std::size_t k = before; k <= after; ++k) {
        const auto& [t_s, is_of_path, cap, first, second] = knots[k];
        // At the end of the stage x is larger by 2 u step.
        stage.bounds.emplace_back(first, second, limit_m_per_s2);
        stage.bounds.emplace_back(first + 2.0 * stage.step_s * second, second, limit_m_per_s2);
      }
      stages_.push_back(std::move(stage));
    }
  }

  /// The control values of the fastest law.
  std::vector<double> solve() && {
    for (std::size_t i = stages_.size(); i-- > 0;) largest_[i] = largest_controllable(i);
    std::vector<double> x = {largest_[0]};
    for (std::size_t i = 0; i < stages_.size(); ++i) {
      const std::optional<double> next = largest_after(i, x[i]);
      x.push_back(std::max(floor_, next.value_or(floor_)));
    }
    return x;
  }

 private:
  // The largest control value i from which stage i leads to one that is controllable.
  [[nodiscard]] double largest_controllable(std::size_t i) const {
    constexpr int kBisections = 40;  // leaves 1e-12 of the range
    double low = floor_;
    double high = largest_[i];
    if (largest_after(i, high)) return high;
    for (int k = 0; k < kBisections; ++k) {
      const double middle = low + (high - low) / 2.0;
      (largest_after(i, middle) ? low : high) = middle;
    }
    return low;
  }

  // The largest admissible x after stage i if it is `x` before; nothing if there is none.
  [[nodiscard]] std::optional<double> largest_after(std::size_t i, double x) const {
    const Stage& stage = stages_[i];
    double least = (floor_ - x) / (2.0 * stage.step_s);
    double most = (largest_[i + 1] - x) / (2.0 * stage.step_s);
    if (least > most) return std::nullopt;
    const double unlimited = most;
    for (const AccelerationBound& bound : stage.bounds) {
      if (!bound.narrow(x, least, most)) return std::nullopt;
    }
    // A rate of 1 stays exactly 1.
    return most == unlimited ? largest_[i + 1] : x + 2.0 * stage.step_s * most;
  }

  double floor_ = 1.0;           ///< the largest constant x that is admissible everywhere
  std::vector<double> largest_;  ///< caps of the control values, then the largest controllable ones
  std::vector<Stage> stages_;
};

bool is_given_rate(const std::array<double, 3>& squares) {
  return std::ranges::all_of(squares, [](double square) { return square == 1.0; });
}

}  // namespace

TimeLaw::TimeLaw(std::vector<double> knots_s, std::vector<std::array<double, 3>> squares)
    : knots_s_(std::move(knots_s)), squares_(std::move(squares)) {
  new_knots_s_.push_back(knots_s_.front());
  for (std::size_t i = 0; i < squares_.size(); ++i)
    new_knots_s_.push_back(new_knots_s_.back() + passed_s(i, knots_s_[i + 1]));
}

TimeLaw TimeLaw::uniform(std::vector<double> knots_s, double factor) {
  const double square = 1.0 / (factor * factor);
  std::vector<std::array<double, 3>> squares(knots_s.size() - 1, {square, square, square});
  return TimeLaw(std::move(knots_s), std::move(squares));
}

std::optional<TimeLaw> TimeLaw::sendable(const TimeOrigin& origin,
                                         std::span<const double> kept_s) const {
  TimeLaw law = *this;
  const std::size_t last = squares_.size();
  for (std::size_t from = 0, to = 1; to <= last; ++to) {
    if (to != last && !std::ranges::binary_search(kept_s, knots_s_[to])) continue;
    const double begin_s = law.new_knots_s_[from];
    const double passed_s = new_knots_s_[to] - new_knots_s_[from];
    const double end_s = origin.nearest_s(begin_s + passed_s);
    const double scale = (end_s - begin_s) / passed_s;
    for (std::size_t i = from + 1; i < to; ++i) {
      const double wanted_s = begin_s + scale * (new_knots_s_[i] - new_knots_s_[from]);
      law.new_knots_s_[i] = origin.nearest_s(wanted_s);
      law.knots_s_[i] += (law.new_knots_s_[i] - wanted_s) * std::sqrt(squares_[i][0]);
    }
    law.new_knots_s_[to] = end_s;
    from = to;
  }
  const auto increases = [](std::span<const double> times_s) {
    return std::ranges::adjacent_find(times_s, std::greater_equal()) == times_s.end();
  };
  if (!increases(law.knots_s_) || !increases(law.new_knots_s_)) return std::nullopt;
  return law;
}

TimeLaw TimeLaw::within(const Path& path, const RateLimits& limits, double step_s) {
  assert(!path.empty() && step_s > 0.0);
  const std::vector<Knot> knots = knots_of(path, limits, step_s);
  const std::vector<double> x = Reachability(knots, limits.acceleration_m_per_s2).solve();
  // The control values of a quadratic spline are the inner Bézier points; the values at knots
  // divide the lines between them as the knots divide time.
  const std::size_t pieces = knots.size() - 1;
  const auto at_knot = [&](std::size_t i) {
    if (i == 0) return x.front();
    if (i == pieces) return x.back();
    const double before_s = knots[i].t_s - knots[i - 1].t_s;
    const double after_s = knots[i + 1].t_s - knots[i].t_s;
    return x[i] == x[i + 1] ? x[i] : bezier::lerp(x[i], x[i + 1], before_s / (before_s + after_s));
  };
  std::vector<double> knots_s = {knots[0].t_s};
  std::vector<std::array<double, 3>> squares;
  for (std::size_t i = 0; i < pieces; ++i) {
    const std::array<double, 3> piece = {at_knot(i), x[i + 1], at_knot(i + 1)};
    const bool goes_on =
        i > 0 && !knots[i].is_of_path && is_given_rate(piece) && is_given_rate(squares.back());
    if (goes_on) {
      knots_s.back() = knots[i + 1].t_s;
    } else {
      knots_s.push_back(knots[i + 1].t_s);
      squares.push_back(piece);
    }
  }
  return TimeLaw(std::move(knots_s), std::move(squares));
}

std::size_t TimeLaw::piece_at(double given_s) const {
  const auto later = std::ranges::upper_bound(knots_s_, given_s);
  const auto begun = static_cast<std::size_t>(later - knots_s_.begin());
  return std::clamp<std::size_t>(begun, 1, squares_.size()) - 1;
}

// How much new time passes on a piece until `given_s`.
double TimeLaw::passed_s(std::size_t piece, double given_s) const {
  const double from_s = knots_s_[piece];
  const std::array<double, 3>& squares = squares_[piece];
  if (squares[0] == squares[1] && squares[1] == squares[2])
    return (given_s - from_s) / std::sqrt(squares[0]);
  const double duration_s = knots_s_[piece + 1] - from_s;
  const auto slowness = [&](double u) { return 1.0 / std::sqrt(bezier::value_at(squares, u)); };
  // Smooth on a piece; ten points leave nothing but rounding unless the rate changes many times
  // over.
  const double share = (given_s - from_s) / duration_s;
  return share > 0.0 ? duration_s * boost::math::quadrature::gauss<double, 10>::integrate(
                                        slowness, 0.0, share)
                     : 0.0;
}

double TimeLaw::new_time_s(double given_s) const {
  const std::size_t piece = piece_at(given_s);
  if (given_s <= knots_s_[piece]) return new_knots_s_[piece];
  if (given_s >= knots_s_[piece + 1]) return new_knots_s_[piece + 1];
  return std::min(new_knots_s_[piece] + passed_s(piece, given_s), new_knots_s_[piece + 1]);
}

double TimeLaw::rate(double given_s) const {
  const std::size_t piece = piece_at(given_s);
  const double duration_s = knots_s_[piece + 1] - knots_s_[piece];
  const double u = std::clamp((given_s - knots_s_[piece]) / duration_s, 0.0, 1.0);
  return std::sqrt(bezier::value_at(squares_[piece], u));
}

double TimeLaw::slow_down() const {
  return (new_knots_s_.back() - new_knots_s_.front()) / (knots_s_.back() - knots_s_.front());
}

}  // namespace camway::motion
