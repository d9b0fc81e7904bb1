// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <random>

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

/// Messages that are right on the wire but otherwise arbitrary: every string length and list length
/// within the limits is possible, numbers are any bits, NaN among them.
namespace camway::testing {

using Random = std::mt19937_64;

/// The seed of all tests here; a failing test prints it with the number of its trial.
inline constexpr std::uint64_t kSeed = 20060619;

/// An integer of [0, below).
std::size_t below(Random& random, std::size_t below);

/// `Message`: any type with a channel.
template <class Message>
Message random_message(Random& random);

}  // namespace camway::testing
