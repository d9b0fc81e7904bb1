// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <camway/cancel_t.hpp>
#include <camway/claim_t.hpp>
#include <camway/envelope_t.hpp>
#include <camway/error_t.hpp>
#include <camway/map_page_t.hpp>
#include <camway/missing_pages_t.hpp>
#include <camway/occupancy_request_t.hpp>
#include <camway/occupancy_response_t.hpp>
#include <camway/plan_progress_t.hpp>
#include <camway/plan_request_t.hpp>
#include <camway/plan_response_t.hpp>
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

template <class Message>
Message random_message(Random& random);
template <>
plan_request_t random_message<plan_request_t>(Random& random);
template <>
plan_response_t random_message<plan_response_t>(Random& random);
template <>
cancel_t random_message<cancel_t>(Random& random);
template <>
claim_t random_message<claim_t>(Random& random);
template <>
plan_progress_t random_message<plan_progress_t>(Random& random);
template <>
missing_pages_t random_message<missing_pages_t>(Random& random);
template <>
map_page_t random_message<map_page_t>(Random& random);
template <>
occupancy_request_t random_message<occupancy_request_t>(Random& random);
template <>
occupancy_response_t random_message<occupancy_response_t>(Random& random);
template <>
scene_request_t random_message<scene_request_t>(Random& random);
template <>
scene_response_t random_message<scene_response_t>(Random& random);
template <>
upload_page_t random_message<upload_page_t>(Random& random);
template <>
upload_status_t random_message<upload_status_t>(Random& random);
template <>
watch_t random_message<watch_t>(Random& random);
template <>
watch_report_t random_message<watch_report_t>(Random& random);
template <>
status_t random_message<status_t>(Random& random);
template <>
error_t random_message<error_t>(Random& random);
template <>
envelope_t random_message<envelope_t>(Random& random);

}  // namespace camway::testing
