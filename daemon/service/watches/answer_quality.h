// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include <camway/plan_response_t.hpp>

namespace camway::service {

/// What decides which of two answers to one request is the better one.
struct AnswerQuality {
  std::size_t repaired_keyframes = 0;
  double near_scale = 1.0;
  double time_scale = 1.0;
  path_measures_t measures{};

  static AnswerQuality of(const plan_response_t& answer);
};

/// By how much of itself a number has to be better to count.
inline constexpr double kBetterShare = 0.01;
/// And by how much at least where it is a length. [Units: metres]
inline constexpr double kBetterLength_m = 1e-3;

/// Whether `now` is worth a change from `before`: fewer given keyframes repaired; or as many and a
/// larger near distance; or that alike and slowed less; or all that alike and better by the measure
/// of the request's objective (`plan_request_t.objective`), by the margins above. `SAFEST` goes by
/// the clearance, and where that is alike by the deviation, as `CLOSEST` does.
bool is_better(const AnswerQuality& now, const AnswerQuality& before, std::int8_t objective);

}  // namespace camway::service
