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

  static AnswerQuality of(const plan_response_t& answer);
};

/// Least relative difference that counts as better.
inline constexpr double kBetterShare = 0.01;
/// Least difference of lengths that counts as better. [Units: metres]
inline constexpr double kBetterLength_m = 1e-3;

/// The values that decide between two answers.
struct QualityGain {
  int sign = 0;                ///< above 0: the later answer is better; below: worse; 0: alike
  std::string_view what = {};  ///< for people: "deviation"
  std::string_view unit = {};  ///< with a space before it, if there is one: " m"
  double before = 0.0;
  double now = 0.0;
  bool is_of_objective = false;  ///< whether it is a measure of the request's objective
};

/// Returns what decides between `now` and `before`. Compares the number of repaired keyframes
/// (fewer is better); if equal, by the margins above and until two values differ: the near distance
/// (larger), the slow-down (less), and the measure of the request's objective
/// (`plan_request_t.objective`). `SAFEST` compares clearances, then deviations as `CLOSEST` does.
QualityGain gain_of(const AnswerQuality& now, const AnswerQuality& before, std::int8_t objective);

/// Returns whether `now` is worth a change from `before`, as `gain_of` decides.
bool is_better(const AnswerQuality& now, const AnswerQuality& before, std::int8_t objective);

}  // namespace camway::service
