// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include <camway/plan_progress_t.hpp>

#include "daemon/base/progress.h"

/// Stages of planning <-> their numbers in messages. Functions without state.
/// Thread-safe.
namespace camway::messages {

constexpr std::int8_t wire_stage(base::Progress::Stage stage) {
  switch (stage) {
    case base::Progress::Stage::kWaiting:
      return plan_progress_t::WAITING;
    case base::Progress::Stage::kPreparing:
      return plan_progress_t::PREPARING;
    case base::Progress::Stage::kDetecting:
      return plan_progress_t::DETECTING;
    case base::Progress::Stage::kCorrecting:
      return plan_progress_t::CORRECTING;
    case base::Progress::Stage::kCertifying:
      return plan_progress_t::CERTIFYING;
  }
  return plan_progress_t::WAITING;
}

/// Returns nothing for a number that no stage has.
constexpr std::optional<base::Progress::Stage> stage_of(std::int8_t wire) {
  using Stage = base::Progress::Stage;
  for (const Stage stage : {Stage::kWaiting, Stage::kPreparing, Stage::kDetecting,
                            Stage::kCorrecting, Stage::kCertifying}) {
    if (wire_stage(stage) == wire) return stage;
  }
  return std::nullopt;
}

}  // namespace camway::messages
