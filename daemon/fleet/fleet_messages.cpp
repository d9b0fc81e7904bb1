// SPDX-License-Identifier: MIT
#include "daemon/fleet/fleet_messages.h"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "daemon/fleet/subjects.h"
#include "lcmtypes/wire/check.h"

namespace camway::fleet {
namespace {

/// Returns why a message is none; empty if it keeps the rules.
std::string fault_of(const fleet_job_t& job) {
  if (!is_id(job.front_id)) return "front_id: is not of [A-Za-z0-9_-]{1,32}";
  if (job.kind != fleet_job_t::PLAN && job.kind != fleet_job_t::CANCEL) return "kind: is unknown";
  // Also refuses NaN.
  if (!(job.deadline_s >= 0.0)) return "deadline_s: is below 0";
  if (job.least_revision < 0) return "least_revision: is below 0";
  return {};
}

std::string fault_of(const fleet_answer_t& answer) {
  if (!is_id(answer.planner_id)) return "planner_id: is not of [A-Za-z0-9_-]{1,32}";
  if (answer.kind < fleet_answer_t::ANSWER || answer.kind > fleet_answer_t::UNREADABLE) {
    return "kind: is unknown";
  }
  return {};
}

std::string fault_of(const planner_status_t& status) {
  if (!is_id(status.planner_id)) return "planner_id: is not of [A-Za-z0-9_-]{1,32}";
  constexpr std::int32_t kMostSlots = 1 << 16;  // so that sums over planners cannot overflow
  if (status.workers < 0 || status.workers > kMostSlots) return "workers: is out of range";
  if (status.running < 0 || status.running > kMostSlots) return "running: is out of range";
  if (status.log_position < 0) return "log_position: is below 0";
  return {};
}

std::string fault_of(const plan_request_t& request) {
  if (!wire::is_client_id(request.client_id)) return "client_id: is not of [A-Za-z0-9_-]{1,32}";
  if (request.page != 0 || request.num_pages != 1) return "page: is not the only one";
  return {};
}

std::string fault_of(const plan_response_t& response) {
  if (!wire::is_client_id(response.client_id)) return "client_id: is not of [A-Za-z0-9_-]{1,32}";
  if (response.page != 0 || response.num_pages != 1) return "page: is not the only one";
  return {};
}

template <class Message>
base::Result<Message> checked(wire::Decoded<Message> decoded) {
  const std::string type = Message::getTypeName();
  if (!decoded.message) return base::Failure{decoded.fault.text(type)};
  std::string fault = fault_of(*decoded.message);
  if constexpr (requires(Message message) { message.num_parts; }) {
    const Message& message = *decoded.message;
    if (fault.empty() && (message.num_parts < 1 || message.num_parts > wire::kMaxFleetParts ||
                          message.part < 0 || message.part >= message.num_parts)) {
      fault = fmt::format("part: {} of {} is no part", message.part, message.num_parts);
    }
  }
  if (!fault.empty()) return base::Failure{type + "." + fault};
  return *std::move(decoded.message);
}

}  // namespace

base::Result<fleet_job_t> read_job(std::span<const std::uint8_t> bytes) {
  return checked(wire::decode<fleet_job_t>(bytes));
}

base::Result<fleet_answer_t> read_answer(std::span<const std::uint8_t> bytes) {
  return checked(wire::decode<fleet_answer_t>(bytes));
}

base::Result<planner_status_t> read_status(std::span<const std::uint8_t> bytes) {
  return checked(wire::decode<planner_status_t>(bytes));
}

base::Result<plan_request_t> read_request(std::span<const std::uint8_t> payload) {
  return checked(wire::decode_within<plan_request_t>(kMaxPayloadBytes, payload));
}

base::Result<plan_response_t> read_response(std::span<const std::uint8_t> payload) {
  return checked(wire::decode_within<plan_response_t>(kMaxPayloadBytes, payload));
}

}  // namespace camway::fleet
