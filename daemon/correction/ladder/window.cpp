// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/window.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace camway::correction {

namespace {

// Chosen by measurement, in spacings; none changes what is proved.
constexpr double kOnePeak = 0.8;      // longest time that one knot covers
constexpr double kNearest = 0.5;      // least distance of a knot inside from a keyframe
constexpr double kBeyond = 1.3;       // a keyframe that is nearer is crossed
constexpr double kStretched = 2.6;    // a keyframe that is nearer is the end of the row
constexpr double kMostPeaks = 12.0;   // knots in the time itself
constexpr double kInner = 1.3;        // the step beside the outermost peak
constexpr double kOuter = 1.0 / 3.0;  // step at an open end of a row, as a share of the one before

/// Two knots before `at_s`, from the far one: `room_s` is the time to the keyframe there. Works
/// backwards in time as well, with `direction` -1 for knots before and 1 for knots after.
struct Side {
  double direction;
  double spacing_s;

  void add_two(double at_s, double room_s, std::vector<double>& knots_s) const {
    const bool ends_at_keyframe = room_s < kStretched * spacing_s;
    const double step_s = ends_at_keyframe ? 0.5 * room_s : kInner * spacing_s;
    const double last_step_s = ends_at_keyframe ? step_s : kOuter * step_s;
    knots_s.push_back(at_s + direction * step_s);
    knots_s.push_back(at_s + direction * (step_s + last_step_s));
  }

  /// The knots on this side of `at_s`, the nearest first. `keyframe_s`: the keyframe on this side;
  /// `next_s`: the one behind it; null if it is the last.
  [[nodiscard]] std::vector<double> knots(double at_s, double keyframe_s,
                                          const double* next_s) const {
    std::vector<double> knots_s;
    const double room_s = std::abs(keyframe_s - at_s);
    if (room_s >= kBeyond * spacing_s) {
      add_two(at_s, room_s, knots_s);
      // Exactly at the keyframe, where the sum may round.
      if (room_s < kStretched * spacing_s) knots_s.back() = keyframe_s;
      return knots_s;
    }
    knots_s.push_back(keyframe_s);
    const double beyond_s = next_s ? std::abs(*next_s - keyframe_s) : 2.0 * kStretched * spacing_s;
    add_two(keyframe_s, beyond_s, knots_s);
    if (next_s && beyond_s < kStretched * spacing_s) knots_s.back() = *next_s;
    return knots_s;
  }
};

}  // namespace

motion::KnotRow window_about(const Problem& problem, double begin_s, double end_s,
                             double spacing_s) {
  const double leg_begin_s = problem.leg_begin_s();
  const double leg_end_s = problem.leg_end_s();
  const double spacing = std::min(spacing_s, leg_end_s - leg_begin_s);
  const double away_s = std::min(kNearest * spacing, 0.25 * (leg_end_s - leg_begin_s));
  const auto inside = [&](double time_s) {
    return std::clamp(time_s, leg_begin_s + away_s, leg_end_s - away_s);
  };
  double first_s = inside(begin_s);
  double last_s = inside(end_s);
  const double peaks = std::min(kMostPeaks, 1.0 + std::ceil((last_s - first_s) / spacing));
  if (last_s - first_s <= kOnePeak * spacing) first_s = last_s = 0.5 * (first_s + last_s);

  const std::vector<double>& times_s = problem.keyframes_s;
  const double* before = problem.leg > 0 ? &times_s[problem.leg - 1] : nullptr;
  const double* after = problem.leg + 2 < times_s.size() ? &times_s[problem.leg + 2] : nullptr;
  std::vector<double> knots_s = Side{-1.0, spacing}.knots(first_s, leg_begin_s, before);
  std::ranges::reverse(knots_s);
  if (first_s == last_s) {
    knots_s.push_back(first_s);
  } else {
    const int steps = static_cast<int>(peaks) - 1;
    for (int i = 0; i <= steps; ++i) {
      knots_s.push_back(std::lerp(first_s, last_s, static_cast<double>(i) / steps));
    }
  }
  for (const double time_s : Side{1.0, spacing}.knots(last_s, leg_end_s, after)) {
    knots_s.push_back(time_s);
  }
  return motion::KnotRow::at(knots_s, problem.places);
}

}  // namespace camway::correction
