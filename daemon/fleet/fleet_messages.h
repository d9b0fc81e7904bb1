// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <camway/fleet_answer_t.hpp>
#include <camway/fleet_job_t.hpp>
#include <camway/plan_request_t.hpp>
#include <camway/plan_response_t.hpp>
#include <camway/planner_status_t.hpp>

#include "daemon/base/result.h"

/// Reads messages between a front and its planners. What these return keeps all the rules of the
/// .lcm files; the failure names the one that is broken. Functions without state.
/// Thread-safe.
namespace camway::fleet {

using Bytes = std::vector<std::uint8_t>;

/// Largest size of a whole request or answer, as encoded: more than the pages of any hold.
inline constexpr std::size_t kMaxPayloadBytes = std::size_t{64} << 20;

base::Result<fleet_job_t> read_job(std::span<const std::uint8_t> bytes);
base::Result<fleet_answer_t> read_answer(std::span<const std::uint8_t> bytes);
base::Result<planner_status_t> read_status(std::span<const std::uint8_t> bytes);

/// Reads what the parts of a job hold together: a whole request, of a client whose id is valid.
base::Result<plan_request_t> read_request(std::span<const std::uint8_t> payload);
/// Reads what the parts of an answer hold together.
base::Result<plan_response_t> read_response(std::span<const std::uint8_t> payload);

}  // namespace camway::fleet
