// SPDX-License-Identifier: MIT
#include "lcmtypes/wire/check.h"
#include "tests/fuzz/exercise_message.h"
#include "tests/fuzz/targets.h"
#include "tests/messages/random_messages.h"

namespace camway::testing {
namespace {

template <class... Messages>
std::vector<FuzzBytes> messages_of(int of_each) {
  Random random(kSeed);
  std::vector<FuzzBytes> all;
  for (int i = 0; i < of_each; ++i) {
    (all.push_back(wire::encode(random_message<Messages>(random))), ...);
  }
  return all;
}

std::vector<FuzzBytes> wire_seeds() {
  return messages_of<plan_request_t, plan_response_t, plan_progress_t, cancel_t, missing_pages_t,
                     map_page_t, occupancy_request_t, occupancy_response_t, scene_request_t,
                     scene_response_t, upload_page_t, upload_status_t, watch_t, watch_report_t,
                     claim_t, status_t, error_t, envelope_t, fleet_job_t, fleet_answer_t,
                     planner_status_t>(30);
}

}  // namespace

constinit const FuzzTarget kWireTarget{
    "wire", [](std::span<const std::uint8_t> bytes) { return exercise_message(bytes) > 0; },
    wire_seeds, 2'000};

}  // namespace camway::testing
