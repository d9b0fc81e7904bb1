// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include <camway/plan_response_t.hpp>

namespace camway::service {

/// The values by which two answers to one request are compared.
struct AnswerQuality {
  std::size_t repaired_keyframes = 0;
  double near_scale = 1.0;
  double time_scale = 1.0;
  path_measures_t measures{};
  /// Whether `measures` has the shift of the picture. If not, it is 0 there, although the path was
  /// changed: so in files of earlier versions, and in answers of keyframe insertion.
  bool tells_shift = true;

  static AnswerQuality of(const plan_response_t& answer);
};

/// Least relative difference that counts as better.
inline constexpr double kBetterShare = 0.01;
/// Least difference of lengths that counts as better. [Units: metres]
inline constexpr double kBetterLength_m = 1e-3;
/// Least difference of shifts that counts as better, in the part that was corrected: that of
/// `kBetterLength_m`, seen from 3 m, which is less than a pixel of most pictures. [Units: radians]
inline constexpr double kBetterShift_rad = kBetterLength_m / 3.0;

/// The values that decide between two answers.
struct QualityGain {
  int sign = 0;                ///< above 0: the later answer is better; below: worse; 0: alike
  std::string_view what = {};  ///< for people: "mean shift"
  std::string_view unit = {};  ///< of the values, with a space before it, if it has one: "°", " m"
  double before = 0.0;
  double now = 0.0;
  bool is_of_objective = false;  ///< whether it is a measure of the request's objective
};

/// Returns what decides between `now` and `before`. Compares the number of repaired keyframes
/// (fewer is better); if equal, by the margins above and until two values differ: the near distance
/// (larger), the slow-down (less), and the measure of the request's objective
/// (`plan_request_t.objective`).
///
/// The measure of `CLOSEST` is the mean shift of the picture: times the duration of the path, it is
/// the part of the planner's cost (`correction/path/closeness.h`) that answers report. Unlike the
/// largest shift, it tells a short correction from a long one. The mean of a long path is small
/// whatever is corrected in it, so `kBetterShift_rad` is taken times the mean and divided by the
/// largest shift, of the answer with the larger mean. If an answer does not tell its shift, the
/// largest deviations are compared. `SAFEST` compares clearances, then as `CLOSEST` does.
///
/// If the request has no viewing distance, each answer has that of its scene, and of two answers in
/// different scenes the one that sees farther shifts less for the same moves.
QualityGain gain_of(const AnswerQuality& now, const AnswerQuality& before, std::int8_t objective);

/// Returns whether `now` is worth a change from `before`, as `gain_of` decides.
bool is_better(const AnswerQuality& now, const AnswerQuality& before, std::int8_t objective);

}  // namespace camway::service
