// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <string_view>

#include <camway/plan_response_t.hpp>

#include "daemon/motion/body/body.h"
#include "daemon/planning/result/result.h"

namespace camway::tools {

/// The stages of planning in their order, by what they leave in an answer.
enum class Stage {
  kRequest,        ///< the request as validated: its bounds, and keyframes at fault
  kInterpolation,  ///< the given keyframes with their times, and the measures of the path through
                   ///< them
  kCollisions,     ///< collisions of the path as interpolated
  kCorrection,     ///< corrections, the shrunk near distance, the number of inserted keyframes
  kTiming,         ///< slowing by motion limits
  kPath,           ///< the path's numbers
  kProof,          ///< certificate, remaining collisions, proof that there is no path
  kMeasures,       ///< measures of the path
  kAnswer,         ///< status, and all else
};

constexpr std::array<std::string_view, 9> names_of(Stage) {
  return {"request", "interpolation", "collisions", "correction", "timing",
          "path",    "proof",         "measures",   "answer"};
}

/// The difference of two answers to one request.
struct Difference {
  /// Largest distance between the two paths' positions of the eye, or of a corner of the body's
  /// triangles, at densely sampled times. It covers position and orientation. Sampling makes it a
  /// lower bound, but it is 0 exactly if the paths have the same bits. Infinite if only one path is
  /// empty or if the time spans differ. [Units: metres]
  double path_m = 0.0;
  /// Largest shift of the picture between the two paths at these times: the turn, and the distance
  /// of the eyes divided by the viewing distance (`correction/path/closeness.h`). 0 and infinite as
  /// `path_m`. [Units: radians]
  double shift_rad = 0.0;
  Stage stage = Stage::kAnswer;  ///< the first stage in which the answers differ, if they do
  /// The first member of that stage that differs, by its name in files: "corrections[1].moved_m".
  /// Empty if all members have the same bits.
  std::string member;
  /// The two values, or the two sizes of a list: numbers in the units of files.
  std::string then, now;

  [[nodiscard]] bool has_same_bits() const { return member.empty(); }
  /// Returns "corrections[1].kind move -> go_round"; empty if all members have the same bits.
  [[nodiscard]] std::string what() const;
};

/// The body of a request, and a viewing distance, by which the paths of two answers are compared.
struct Yardstick {
  motion::Body body;
  double viewing_distance_m = 0.0;  ///< [Limit: 0 < value]
};

/// Compares two answers to one request, member by member as messages have them, but for members
/// that tell how they were found: times, effort, whether the deadline was reached, and the message,
/// whose wording may change between versions. A viewing distance counts if both tell it, since
/// files of earlier versions do not. Requires segments that are paths (`wire::path_fault`).
Difference difference_of(const plan_response_t& then, const plan_response_t& now,
                         const Yardstick& yardstick);

/// Returns the result that a message has. Its path is empty where the segments are none.
planning::PlanResult result_of(const plan_response_t& message);

}  // namespace camway::tools
