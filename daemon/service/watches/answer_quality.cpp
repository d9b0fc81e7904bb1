// SPDX-License-Identifier: MIT
#include "daemon/service/watches/answer_quality.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <camway/plan_request_t.hpp>

namespace camway::service {
namespace {

/// Returns a number above 0 if `now` is better, below 0 if it is worse, 0 if they are alike. A
/// difference below `least` counts as alike.
int compare(double now, double before, double least, bool more_is_better) {
  const double gain = more_is_better ? now - before : before - now;
  const double margin = std::max(least, kBetterShare * std::max(std::abs(now), std::abs(before)));
  if (gain > margin) return 1;
  return gain < -margin ? -1 : 0;
}

/// Returns what decides by the mean shift. Exchanging the two reverses the sign.
QualityGain shift_gain(const path_measures_t& now, const path_measures_t& before) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  const path_measures_t& larger = now.mean_shift_rad > before.mean_shift_rad ? now : before;
  // About the share of the path that the correction takes.
  const double share =
      larger.largest_shift_rad > 0.0 ? larger.mean_shift_rad / larger.largest_shift_rad : 0.0;
  const int sign =
      compare(now.mean_shift_rad, before.mean_shift_rad, kBetterShift_rad * share, false);
  return {sign, "mean shift", "°", kDegrees * before.mean_shift_rad, kDegrees * now.mean_shift_rad,
          true};
}

QualityGain objective_gain(const AnswerQuality& now_quality, const AnswerQuality& before_quality,
                           std::int8_t objective) {
  const path_measures_t& now = now_quality.measures;
  const path_measures_t& before = before_quality.measures;
  const auto less = [&](std::string_view what, std::string_view unit,
                        double path_measures_t::*measure, double least) {
    const int sign = compare(now.*measure, before.*measure, least, false);
    return QualityGain{sign, what, unit, before.*measure, now.*measure, true};
  };
  switch (objective) {
    case plan_request_t::SHORTEST:
      return less("length", " m", &path_measures_t::length_m, kBetterLength_m);
    case plan_request_t::SMOOTHEST:
      return less("bending energy", " m^2/s^3", &path_measures_t::bending_energy_m2_per_s3, 0.0);
    case plan_request_t::SAFEST: {
      const double before_m = before.clearance_lower_bound_m;
      const double now_m = now.clearance_lower_bound_m;
      const int safer = compare(now_m, before_m, kBetterLength_m, true);
      if (safer != 0) return {safer, "clearance", " m", before_m, now_m, true};
      break;
    }
    default:
      break;
  }
  if (now_quality.tells_shift && before_quality.tells_shift) return shift_gain(now, before);
  return less("deviation", " m", &path_measures_t::largest_deviation_m, kBetterLength_m);
}

/// Whether the shift of an answer is measured, or is 0 because nothing was changed that counts.
bool tells_shift(const plan_response_t& answer) {
  if (answer.measures.largest_shift_rad > 0.0) return true;
  if (answer.measures.largest_deviation_m > kBetterLength_m) return false;
  return std::ranges::none_of(answer.corrections, [](const correction_t& correction) {
    return correction.moved_m > kBetterLength_m || correction.turned_rad > kBetterShift_rad;
  });
}

}  // namespace

AnswerQuality AnswerQuality::of(const plan_response_t& answer) {
  AnswerQuality quality;
  quality.repaired_keyframes = static_cast<std::size_t>(std::ranges::count_if(
      answer.keyframes, [](const keyframe_t& keyframe) { return keyframe.repaired != 0; }));
  quality.near_scale = answer.near_scale;
  quality.time_scale = answer.time_scale;
  quality.measures = answer.measures;
  quality.tells_shift = service::tells_shift(answer);
  return quality;
}

QualityGain gain_of(const AnswerQuality& now, const AnswerQuality& before, std::int8_t objective) {
  if (now.repaired_keyframes != before.repaired_keyframes) {
    const bool is_fewer = now.repaired_keyframes < before.repaired_keyframes;
    return {is_fewer ? 1 : -1, "repaired keyframes", "", double(before.repaired_keyframes),
            double(now.repaired_keyframes)};
  }
  const int larger = compare(now.near_scale, before.near_scale, 0.0, true);
  if (larger != 0)
    return {larger, "share of the near distance", "", before.near_scale, now.near_scale};
  const int faster = compare(now.time_scale, before.time_scale, 0.0, false);
  if (faster != 0) return {faster, "slowing", " times", before.time_scale, now.time_scale};
  return objective_gain(now, before, objective);
}

bool is_better(const AnswerQuality& now, const AnswerQuality& before, std::int8_t objective) {
  return gain_of(now, before, objective).sign > 0;
}

}  // namespace camway::service
