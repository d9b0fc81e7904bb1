// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/base/named_enum.h"
#include "tools/camway/replay/compare/difference.h"
#include "tools/camway/replay/session.h"

namespace camway::tools {

enum class Verdict {
  kSame,         ///< all bits that count are the same, or the paths are within the tolerances
  kBetter,       ///< the answer is better now
  kWorse,        ///< the answer is worse now, within the limits
  kDifferent,    ///< the answers differ, and neither is better
  kRegressed,    ///< the status fell, a proof was lost or refuted, or a limit was exceeded
  kNotCompared,  ///< there was nothing to reproduce; `note` has the reason
};

constexpr std::array<std::string_view, 6> names_of(Verdict) {
  return {"same", "better", "worse", "different", "regressed", "not_compared"};
}

/// The limits within which answers count as the same, and beyond which one is a regression.
struct Thresholds {
  /// Largest distance of paths that count as equal, if status and number of keyframes are equal; 0:
  /// the bits must be the same. [Limit: 0 <= value] [Units: metres]
  double tolerance_m = 0.0;
  /// Largest shift between paths that count as equal. Counts if `tolerance_m` is above 0.
  /// [Limit: 0 <= value] [Units: radians]
  double tolerance_shift_rad = std::numeric_limits<double>::infinity();
  /// Largest loss of proved clearance that is no regression. [Limit: 0 <= value] [Units: metres]
  std::optional<double> clearance_loss_m = {};
  /// Largest length of a path as a multiple of the length before that is no regression.
  /// [Limit: 1 <= value]
  std::optional<double> longer = {};
  /// Largest time of planning as a multiple of the time before that is no regression.
  /// [Limit: 1 <= value]
  std::optional<double> slower = {};
};

/// A verdict on two answers to a request.
struct Judgement {
  Verdict verdict = Verdict::kNotCompared;
  Difference difference;
  /// The reason of the verdict; empty where all bits are the same.
  std::string note;
};

/// The two answers to a request that are compared; null where there is none.
struct AnswerPair {
  const RecordedAnswer* then = nullptr;
  const RecordedAnswer* now = nullptr;
  /// Whether both are of scenes with the same triangles, as far as is known.
  bool has_same_scene = true;
};

/// Compares two answers to `recorded`. The rules are in docs/replay.md. Exchanging the answers
/// exchanges `kBetter` with `kWorse` or `kRegressed`, and leaves `kSame` and `kDifferent` without
/// limits as they are, but for requests that are refused in one answer alone.
Judgement judge(const RecordedRequest& recorded, const AnswerPair& answers,
                const Thresholds& thresholds);

/// The reason of a verdict on an answer that was cut short.
inline constexpr std::string_view kCutShort = "cut short by its deadline";

/// Shortest time of planning that can be a regression: below, the machine's noise decides.
/// [Units: milliseconds]
inline constexpr double kLeastSlow_ms = 20.0;

}  // namespace camway::tools
