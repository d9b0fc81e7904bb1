// SPDX-License-Identifier: MIT
#include "client/engine/plan_collector.h"

#include <optional>
#include <utility>

#include "client/messages/convert.h"
#include "client/messages/plan.h"
#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/path_fault.h"

namespace camway {
namespace {

/// Returns whether plan requests are answered with this status.
bool is_known(std::int32_t status) {
  return (status >= 0 && status <= plan_response_t::STATUS_MALFORMED) ||
         status == plan_response_t::STATUS_CANCELLED || status == plan_response_t::STATUS_LIMIT ||
         status == plan_response_t::STATUS_OLD_SCENE;
}

/// Returns why the path and the report of an answer make no sense; nothing if they do. `whole`: all
/// pages of the answer, joined.
std::optional<std::string> fault_in_answer(const plan_response_t& whole) {
  if (!is_known(whole.status)) return "status " + std::to_string(whole.status) + " is unknown";
  if (std::string fault = wire::path_fault(whole.segments); !fault.empty()) return fault;
  for (const correction_t& correction : whole.corrections) {
    if (correction.method < correction_t::NONE || correction.method > correction_t::SHRINK) {
      return "a correction by method " + std::to_string(correction.method);
    }
  }
  if (whole.status == plan_response_t::STATUS_OK && whole.segments.empty()) {
    return "status ok without a path";
  }
  return std::nullopt;
}

PlanResponse bad_answer(const plan_response_t& wire, const std::string& what) {
  PlanResponse response;
  response.status = Status::kBadAnswer;
  response.message = wire.message;
  response.request_id = wire.request_id;
  response.error = "the daemon's answer makes no sense: " + what +
                   "; check that client and daemon are of one version";
  return response;
}

}  // namespace

PlanCollector::PlanCollector(std::string client_id, std::int64_t request_id)
    : client_id_(std::move(client_id)), request_id_(request_id) {}

PlanCollector::Taken PlanCollector::take(std::span<const std::uint8_t> bytes) {
  wire::Decoded<plan_response_t> decoded = wire::decode<plan_response_t>(bytes);
  if (!decoded.message) {
    fault_ = decoded.fault.text("plan_response_t");
    return Taken::kBad;
  }
  plan_response_t& page = *decoded.message;
  if (page.client_id != client_id_ || page.request_id != request_id_) return Taken::kForeign;
  if (const std::string fault = wire::page_fault(page); !fault.empty()) {
    fault_ = "plan_response_t." + fault;
    return Taken::kBad;
  }
  if (pages_.held() > 0 && pages_.any().utime != page.utime) clear();
  return pages_.add(std::move(page)) ? Taken::kNew : Taken::kKnown;
}

PlanResponse PlanCollector::response() const {
  const plan_response_t whole = pages_.whole();
  if (const auto fault = fault_in_answer(whole)) return bad_answer(whole, *fault);
  PlanResponse response;
  convert(whole, response);
  std::vector<Segment> segments;
  convert(whole.segments, segments);
  response.path = Path(std::move(segments));
  return response;
}

}  // namespace camway
