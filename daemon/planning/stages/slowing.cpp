// SPDX-License-Identifier: MIT
#include "daemon/planning/stages/slowing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "daemon/correction/path/orientation_rule.h"
#include "daemon/motion/timing/retimed_path.h"
#include "daemon/planning/stages/path_check.h"

namespace camway::planning {

namespace {

using collision::CollisionInterval;
using motion::CubicPath;
using motion::Path;
using motion::RateLimits;
using motion::Segment;
using motion::TimeLaw;

// A path that is as fast as allowed must not be too fast by rounding.
constexpr double kLimitRounding = 1e-6;

// How much slower than allowed a path is made, so that its fit need not be perfect.
constexpr double kSlowerThanAllowed = 1.002;

// Knots to the mean piece of a path, first and last, and pieces at most: 27 MB of an answer, which
// may have 61 on the wire.
constexpr double kFewestKnots = 4.0;
constexpr double kMostKnots = 256.0;
constexpr std::size_t kMostPieces = 80'000;

// Least time that a law takes for each of its knots, without a look at the deadline; measured.
constexpr double kLeast_s_per_knot = 2e-6;

constexpr int kSamples = 32;  // of a segment, for breaches

constexpr int kMostFits = 4;  // of a path that is slowed uniformly, more each time

/// The largest rate beside its limit, in words.
std::string describe_rate(const Segment& segment, double u, const RateLimits& limits) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  const motion::SegmentDerivatives at = motion::derivatives_at(segment, u);
  const auto text = [](std::string_view name, double rate, double limit, std::string_view unit) {
    return fmt::format("its {0} is up to {1:.3g} {3}, of {2:.3g} {3} that are allowed", name, rate,
                       limit, unit);
  };
  const motion::SlowDowns needed = motion::slow_downs(segment, u, limits);
  if (needed.speed >= std::max(needed.acceleration, needed.turn_rate)) {
    return text("speed", at.velocity_m_per_s.norm(), limits.speed_m_per_s, "m/s");
  }
  if (needed.turn_rate >= needed.acceleration) {
    return text("turn rate", 2.0 * at.orientation_rate_per_s.norm() * kDegrees,
                limits.turn_rate_rad_per_s * kDegrees, "degrees/s");
  }
  return text("acceleration", at.acceleration_m_per_s2.norm(), limits.acceleration_m_per_s2,
              "m/s²");
}

/// An instant of a path, and the slow-down that it needs.
struct Sample {
  const Segment* segment;
  double u;
  double needed_slow_down;

  [[nodiscard]] bool is_too_fast() const { return needed_slow_down > 1.0; }
  [[nodiscard]] double time_s() const { return motion::segment_time_s(*segment, u); }
};

std::vector<Sample> samples_of(const Path& path, const RateLimits& limits) {
  std::vector<Sample> samples;
  for (const Segment& segment : path.segments()) {
    for (int i = 0; i <= kSamples; ++i) {
      const double u = static_cast<double>(i) / kSamples;
      samples.push_back({&segment, u, motion::needed_slow_down(segment, u, limits)});
    }
  }
  return samples;
}

/// The largest of the same samples; nothing if the deadline struck first.
std::optional<double> largest_slow_down(const Path& path, const RateLimits& limits,
                                        const base::Deadline& deadline) {
  double largest = motion::needed_slow_down(path.segments().front(), 0.0, limits);
  for (const Segment& segment : path.segments()) {
    if (deadline.passed()) return std::nullopt;
    for (int i = 0; i <= kSamples; ++i) {
      const double u = static_cast<double>(i) / kSamples;
      largest = std::max(largest, motion::needed_slow_down(segment, u, limits));
    }
  }
  return largest;
}

/// Whether no point of the body is farther from its former place than the interval tolerance, at
/// samples between the knots of `law`.
bool stays_close(const TooFast& problem, const CubicPath& slowed, const TimeLaw& law,
                 const base::Deadline& deadline) {
  const std::span<const double> knots_s = law.knots_s();
  for (std::size_t i = 0; i + 1 < knots_s.size(); ++i) {
    if (deadline.passed()) return false;
    for (const double share : {0.25, 0.5, 0.75}) {
      const double given_s = knots_s[i] + share * (knots_s[i + 1] - knots_s[i]);
      const motion::Pose was = problem.path.pose(given_s);
      const motion::Pose is = slowed.pose(law.new_time_s(given_s));
      const double turned_rad = was.orientation.angularDistance(is.orientation);
      const double moved_m = (is.position - was.position).norm() +
                             2.0 * problem.query.body.radius_m() * std::sin(turned_rad / 2.0);
      if (!(moved_m <= problem.query.options.tolerance_m)) return false;
    }
  }
  return true;
}

/// The spline through the points of the path at the law's knots, with its check for collisions.
/// Nothing if it breaks the limits, is not close to the path, violates the orientation policy, is
/// not proved free although the path was, or if the deadline strikes.
std::optional<Retimed> fitted(const TooFast& problem, TimeLaw law, const base::Deadline& deadline) {
  CubicPath slowed = motion::retimed(problem.path, law);
  const Path slowed_path = slowed.path();
  if (deadline.passed() || !motion::meets(slowed_path, problem.limits) ||
      !stays_close(problem, slowed, law, deadline)) {
    return std::nullopt;
  }
  CubicPath interpolated = motion::retimed(problem.interpolated, law);
  if (correction::first_breach(problem.orientation, slowed, interpolated, slowed.begin_s(),
                               slowed.end_s())) {
    return std::nullopt;
  }
  PathCheck check = check_path(problem.query, slowed_path, deadline, deadline);
  if (!check.complete || (problem.is_free && !check.certificate.certified)) return std::nullopt;
  return Retimed{std::move(law), std::move(slowed), std::move(interpolated), std::move(check)};
}

/// The path by a law with knots `step_s` apart, if `fitted` accepts it.
std::optional<Retimed> slowed_with_step(const TooFast& problem, const Path& path, double step_s,
                                        const base::Deadline& deadline) {
  std::optional<TimeLaw> law =
      TimeLaw::within(path, scaled_limits(problem.limits, 1.0 / kSlowerThanAllowed), step_s)
          .sendable(problem.origin, problem.keyframes_s);
  if (!law || law->knots_s().size() > kMostPieces || deadline.passed()) return std::nullopt;
  return fitted(problem, std::move(*law), deadline);
}

/// The times at which segments of `path` begin or end, increasing.
std::vector<double> knots_of(const Path& path) {
  std::vector<double> knots_s = {path.begin_s()};
  for (const Segment& segment : path.segments()) knots_s.push_back(segment.t1_s);
  return knots_s;
}

/// The path with all times multiplied by `factor`.
std::optional<Retimed> slowed_by(double factor, const TooFast& problem, const Path& path,
                                 const base::Deadline& deadline) {
  std::optional<TimeLaw> law =
      TimeLaw::uniform(knots_of(path), factor).sendable(problem.origin, problem.keyframes_s);
  if (!law) return std::nullopt;
  if (!motion::slows_uniformly(problem.path, *law))
    return fitted(problem, std::move(*law), deadline);
  CubicPath slowed = motion::with_new_times(problem.path, *law);
  CubicPath interpolated = motion::with_new_times(problem.interpolated, *law);
  return Retimed{std::move(*law), std::move(slowed), std::move(interpolated), std::nullopt};
}

std::vector<SlowedStretch> slowed_stretches(const TimeLaw& law) {
  const std::span<const double> given_s = law.knots_s();
  const std::span<const double> new_s = law.new_knots_s();
  std::vector<SlowedStretch> slowed;
  for (std::size_t i = 0; i + 1 < given_s.size(); ++i) {
    // A parabola within (0, 1] is 1 in its middle only if it is so everywhere.
    if (law.rate((given_s[i] + given_s[i + 1]) / 2.0) == 1.0) continue;
    if (slowed.empty() || slowed.back().given_t_end_s != given_s[i])
      slowed.push_back({new_s[i], new_s[i], given_s[i], given_s[i]});
    slowed.back().t_end_s = new_s[i + 1];
    slowed.back().given_t_end_s = given_s[i + 1];
  }
  return slowed;
}

void move(const TimeLaw& law, CollisionInterval& interval) {
  interval.t_begin_s = law.new_time_s(interval.t_begin_s);
  interval.t_end_s = law.new_time_s(interval.t_end_s);
  if (interval.witness) interval.witness->time_s = law.new_time_s(interval.witness->time_s);
}

}  // namespace

bool meets_limits(const Path& path, const RateLimits& limits) {
  return motion::meets(path, scaled_limits(limits, 1.0 + kLimitRounding));
}

std::optional<LimitBreach> find_limit_breach(const Path& path, const RateLimits& limits) {
  if (meets_limits(path, limits)) return std::nullopt;
  const std::vector<Sample> samples = samples_of(path, limits);
  const auto worst = std::ranges::max_element(samples, {}, &Sample::needed_slow_down);
  auto first = worst;
  auto last = worst;
  while (first != samples.begin() && std::prev(first)->is_too_fast()) --first;
  while (std::next(last) != samples.end() && std::next(last)->is_too_fast()) ++last;
  LimitBreach breach{first->time_s(), last->time_s(), 1,
                     describe_rate(*worst->segment, worst->u, limits)};
  for (auto sample = samples.begin(); sample != samples.end(); ++sample) {
    const bool begins = sample == samples.begin() || !std::prev(sample)->is_too_fast();
    if (begins && sample->is_too_fast() && sample != first) ++breach.parts;
  }
  return breach;
}

std::optional<Retimed> slowed_where_needed(const TooFast& problem, const base::Deadline& deadline) {
  const Path path = problem.path.path();
  const auto pieces = static_cast<double>(path.segments().size());
  const double mean_s = (path.end_s() - path.begin_s()) / pieces;
  for (double knots = kFewestKnots; knots <= kMostKnots && !deadline.passed(); knots *= 2.0) {
    if (knots * pieces > static_cast<double>(kMostPieces)) break;
    if (!deadline.leaves_s(knots * pieces * kLeast_s_per_knot)) break;
    if (auto slowed = slowed_with_step(problem, path, mean_s / knots, deadline)) return slowed;
  }
  return std::nullopt;
}

std::optional<Retimed> slowed_uniformly(const TooFast& problem, const base::Deadline& deadline) {
  const Path path = problem.path.path();
  const std::optional<double> needed = largest_slow_down(path, problem.limits, deadline);
  if (!needed) return std::nullopt;
  double factor = *needed;
  // Samples may miss a little of the largest rate, or much of one that peaks.
  double margin = kSlowerThanAllowed;
  for (int fits = 0; fits < kMostFits && !deadline.passed();) {
    factor *= margin;
    margin *= margin;
    if (!std::isfinite(factor)) return std::nullopt;
    if (!motion::meets(path, scaled_limits(problem.limits, factor))) continue;
    if (auto slowed = slowed_by(factor, problem, path, deadline)) return slowed;
    ++fits;
  }
  return std::nullopt;
}

void move_times(const TimeLaw& law, PlanResult& result) {
  result.time_scale = law.slow_down();
  result.slowed = slowed_stretches(law);
  for (motion::Keyframe& keyframe : result.keyframes)
    keyframe.time_s = law.new_time_s(keyframe.time_s);
  for (CollisionInterval& interval : result.remaining_collisions) move(law, interval);
}

void move_findings(const TimeLaw& law, PlanResult& result) {
  for (CollisionInterval& interval : result.collisions) move(law, interval);
  for (correction::Correction& correction : result.corrections) {
    move(law, correction.interval);
    correction.t_begin_s = law.new_time_s(correction.t_begin_s);
    correction.t_end_s = law.new_time_s(correction.t_end_s);
  }
}

}  // namespace camway::planning
