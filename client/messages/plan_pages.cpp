// SPDX-License-Identifier: MIT
#include "client/messages/plan_pages.h"

#include <optional>
#include <utility>

#include "client/messages/convert.h"
#include "client/messages/plan.h"
#include "client/messages/plan_faults.h"
#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/utime.h"

namespace camway {
namespace {

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

std::vector<Bytes> to_pages(const PlanRequest& request, const std::string& client_id,
                            std::int64_t request_id) {
  plan_request_t wire{};
  convert(request, wire);
  wire.client_id = client_id;
  wire.request_id = request_id;
  wire.utime = wire::utime_now();
  return wire::encode_pages(wire);
}

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
