// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <camway/plan_response_t.hpp>

#include "daemon/planning/result.h"

/// Conversion of those parts of an answer that concern corrections, their effect and their limits.
namespace camway::service {

/// Writes corrections, measures, scales, keyframe faults and the proof of infeasibility of `result`
/// into `wire`. Requires that its lists of them are empty.
void put_report(const planning::PlanResult& result, plan_response_t& wire);

/// Reads the same parts from `wire`, except for the witness of a correction's collision, which
/// stands with the collision. Returns an error, e.g. "corrections[3].method: 9 is unknown", or an
/// empty text.
std::string read_report(const plan_response_t& wire, planning::PlanResult& result);

}  // namespace camway::service
