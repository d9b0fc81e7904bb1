// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <camway/plan_request_t.hpp>

#include "daemon/planning/request.h"

/// Conversion of those options of a request that concern corrections.
namespace camway::service {

/// Writes objective, orientation, limits, bounds, shrink, repair and seed of `options` into `wire`.
void put_correction_options(const planning::PlanOptions& options, plan_request_t& wire);

/// Reads the same options from `wire`; zeros become defaults. Returns an error, e.g. "objective: 9
/// is unknown", or an empty text. Ranges are checked by `planning::validate`.
std::string read_correction_options(const plan_request_t& wire, planning::PlanOptions& options);

}  // namespace camway::service
