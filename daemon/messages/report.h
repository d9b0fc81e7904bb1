// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <camway/plan_response_t.hpp>

#include "daemon/planning/result.h"

/// The part of an answer that says what correction did, and what stood in its way.
namespace camway::service {

/// Writes corrections, measures, scales, keyframe faults and the proof of infeasibility of `result`
/// into `wire`, whose lists of them are empty.
void put_report(const planning::PlanResult& result, plan_response_t& wire);

/// Reads them back. The witness of a correction's collision is not among them: it stands with the
/// collision. Returns why there are none, e.g. "corrections[3].method: 9 is unknown"; empty if all
/// is well.
std::string read_report(const plan_response_t& wire, planning::PlanResult& result);

}  // namespace camway::service
