// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <camway/cancel_t.hpp>
#include <camway/claim_t.hpp>
#include <camway/envelope_t.hpp>
#include <camway/error_t.hpp>
#include <camway/fleet_answer_t.hpp>
#include <camway/fleet_job_t.hpp>
#include <camway/map_page_t.hpp>
#include <camway/missing_pages_t.hpp>
#include <camway/occupancy_request_t.hpp>
#include <camway/occupancy_response_t.hpp>
#include <camway/plan_progress_t.hpp>
#include <camway/plan_request_t.hpp>
#include <camway/plan_response_t.hpp>
#include <camway/planner_status_t.hpp>
#include <camway/scene_request_t.hpp>
#include <camway/scene_response_t.hpp>
#include <camway/status_t.hpp>
#include <camway/upload_page_t.hpp>
#include <camway/upload_status_t.hpp>
#include <camway/watch_report_t.hpp>
#include <camway/watch_t.hpp>

#include "tests/support/random.h"

/// Random messages that are valid on the wire: strings and lists have any length within the limits,
/// numbers have any bits, NaN included.
namespace camway::testing {

/// The random seed of all tests in this folder. A failing test prints it with the number of its
/// trial.
inline constexpr std::uint64_t kSeed = 20060619;

/// Returns an integer in [0, below).
std::size_t below(Random& random, std::size_t below);

/// `Message`: any type with a channel or a subject.
template <class Message>
Message random_message(Random& random);

}  // namespace camway::testing
