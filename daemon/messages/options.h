// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <camway/plan_request_t.hpp>

#include "daemon/planning/request.h"

/// The part of a request that says what corrections are asked for.
namespace camway::service {

/// Writes objective, orientation, limits, bounds, shrink, repair and seed of `options` into `wire`.
void put_correction_options(const planning::PlanOptions& options, plan_request_t& wire);

/// Reads them back; zeros become defaults. Returns why there are none, e.g. "objective: 9 is
/// unknown"; empty if all is well. Ranges are `planning::validate`'s.
std::string read_correction_options(const plan_request_t& wire, planning::PlanOptions& options);

}  // namespace camway::service
