// SPDX-License-Identifier: MIT
#include "daemon/fleet/fleet_messages.h"
#include "daemon/fleet/fleet_parts.h"
#include "daemon/fleet/planner_board.h"
#include "daemon/messages/plan.h"
#include "tests/fuzz/targets.h"
#include "tests/messages/random_messages.h"

namespace camway::testing {
namespace {

bool is_part(std::int32_t part, std::int32_t num_parts) {
  return part >= 0 && part < num_parts && num_parts <= wire::kMaxFleetParts;
}

/// Processes bytes like a planner with a job and like a front with what planners say.
bool exercise_fleet(std::span<const std::uint8_t> bytes) {
  bool is_right = false;
  if (const auto job = fleet::read_job(bytes)) {
    is_right = true;
    promise(is_part(job->part, job->num_parts) && job->deadline_s >= 0.0, "a job keeps its rules");
    if (const auto request = fleet::read_request(job->payload)) {
      static_cast<void>(messages::from_wire(*request));
    }
  }
  if (const auto answer = fleet::read_answer(bytes)) {
    is_right = true;
    promise(is_part(answer->part, answer->num_parts), "an answer keeps its rules");
    if (const auto response = fleet::read_response(answer->payload)) {
      static_cast<void>(messages::watched_part_of(*response, 3));
      static_cast<void>(messages::without_times(*response));
    }
  }
  if (const auto status = fleet::read_status(bytes)) {
    is_right = true;
    fleet::PlannerBoard board;
    board.note(*status);
    const auto choice = board.take(0);
    const bool is_taken = choice.outlook == fleet::PlannerBoard::Outlook::kTaken;
    promise(!is_taken || (status->running < status->workers && status->is_leaving == 0),
            "a slot that is taken was free");
    promise(board.capacity() >= 0 && board.free_slots() >= 0, "slots are counted from 0");
  }
  return is_right;
}

std::vector<FuzzBytes> fleet_seeds() {
  Random random(kSeed);
  std::vector<FuzzBytes> seeds;
  for (int i = 0; i < 30; ++i) {
    fleet_job_t job{};
    job.front_id = "front";
    job.num_parts = 1;
    job.deadline_s = 1.0;
    job.payload = wire::encode(random_message<plan_request_t>(random));
    job.num_bytes = static_cast<std::int32_t>(job.payload.size());
    seeds.push_back(wire::encode(job));
    fleet_answer_t answer{};
    answer.planner_id = "planner";
    answer.num_parts = 1;
    answer.payload = wire::encode(random_message<plan_response_t>(random));
    answer.num_bytes = static_cast<std::int32_t>(answer.payload.size());
    seeds.push_back(wire::encode(answer));
    planner_status_t status = random_message<planner_status_t>(random);
    status.planner_id = "planner";
    status.workers = 4;
    status.running = i % 6;
    status.log_position = i;
    seeds.push_back(wire::encode(status));
  }
  return seeds;
}

/// Takes each four bytes for a part: its job, number, number of parts and size.
bool exercise_parts(std::span<const std::uint8_t> bytes) {
  constexpr fleet::PartJoiner::Limits kLimits{4000, 5};
  fleet::PartJoiner joiner(kLimits);
  bool is_any_whole = false;
  for (; bytes.size() >= 4; bytes = bytes.subspan(4)) {
    const std::int32_t num_parts = 1 + bytes[2] % 8;
    const std::int32_t part = bytes[1] % num_parts;
    const fleet::Bytes payload(bytes[3], bytes[0]);
    const auto whole = joiner.add({"sender", bytes[0] % 16}, part, num_parts, payload);
    promise(joiner.bytes() <= kLimits.max_bytes, "parts keep within their bytes");
    promise(joiner.half_received() <= kLimits.max_payloads, "parts keep within their number");
    if (!whole) continue;
    is_any_whole = true;
    promise(whole->size() <= std::size_t{255} * static_cast<std::size_t>(num_parts),
            "a whole is the sum of its parts");
  }
  return is_any_whole;
}

std::vector<FuzzBytes> part_seeds() {
  return {
      {1, 0, 0, 9}, {1, 0, 1, 9, 1, 1, 1, 3}, {1, 0, 2, 200, 2, 0, 1, 4, 1, 2, 2, 5, 2, 1, 1, 0}};
}

}  // namespace

constinit const FuzzTarget kFleetTarget{"fleet", exercise_fleet, fleet_seeds, 5'000};
constinit const FuzzTarget kFleetPartsTarget{"fleet_parts", exercise_parts, part_seeds, 20'000};

}  // namespace camway::testing
