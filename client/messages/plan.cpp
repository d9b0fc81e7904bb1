// SPDX-License-Identifier: MIT
#include "client/messages/plan.h"

#include <utility>

#include "client/messages/members.h"
#include "client/messages/text.h"
#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/layout.h"
#include "lcmtypes/wire/path_fault.h"
#include "lcmtypes/wire/utime.h"

namespace camway {
namespace {

constexpr std::size_t kMaxKeyframes = 100'000;  // as in plan_request_t.lcm

bool has_times(const PlanRequest& request) {
  return !request.keyframes.empty() && request.keyframes.front().time_s.has_value();
}

/// Returns whether plan requests are answered with this status.
bool is_known(std::int32_t status) {
  return (status >= 0 && status <= plan_response_t::STATUS_MALFORMED) ||
         status == plan_response_t::STATUS_CANCELLED || status == plan_response_t::STATUS_LIMIT;
}

/// Returns why the path and the report of an answer make no sense; nothing if they do.
std::optional<std::string> fault_in(const plan_response_t& whole) {
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

std::optional<std::string> fault_in_count(const std::string& field, std::size_t count,
                                          std::size_t most) {
  if (count <= most) return std::nullopt;
  return field + ": there are " + std::to_string(count) + ", at most " + std::to_string(most) +
         " are allowed";
}

/// Returns the fault of a keyframe whose time is set or not set unlike that of keyframe 0.
std::optional<std::string> fault_in_times(const PlanRequest& request) {
  for (std::size_t i = 0; i < request.keyframes.size(); ++i) {
    if (request.keyframes[i].time_s.has_value() == has_times(request)) continue;
    return "keyframes[" + std::to_string(i) + "].time_s: " +
           (has_times(request) ? "is not set, that of keyframe 0 is"
                               : "is set, that of keyframe 0 is not") +
           "; all keyframes have a time, or none has";
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

std::optional<std::string> fault_in_form(const PlanRequest& request) {
  const Body& body = request.body;
  std::size_t points = 0;
  for (const auto& piece : body.pieces_m) points += piece.size();
  for (auto& fault :
       {fault_in_text("scene", request.scene, wire::kMaxSceneNameBytes),
        fault_in_text("method", request.method, wire::kMaxMethodBytes),
        // An empty piece has a size on the wire all the same.
        fault_in_count("body.pieces_m", body.pieces_m.size(), wire::kMaxBodyPoints),
        fault_in_count("points in body.pieces_m", points, wire::kMaxBodyPoints),
        fault_in_count("body.vertices_m", body.vertices_m.size(), wire::kMaxBodyPoints),
        fault_in_count("body.triangles", body.triangles.size(), wire::kMaxBodyTriangles),
        fault_in_count("keyframes", request.keyframes.size(), kMaxKeyframes),
        fault_in_times(request)}) {
    if (fault) return fault;
  }
  return std::nullopt;
}

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
  if (!wire::page_fault(page).empty()) {
    fault_ = "plan_response_t.page: " + std::to_string(page.page) + " of " +
             std::to_string(page.num_pages) + " is out of range";
    return Taken::kBad;
  }
  if (pages_.held() > 0 && pages_.any().utime != page.utime) clear();
  return pages_.add(std::move(page)) ? Taken::kNew : Taken::kKnown;
}

PlanResponse PlanCollector::response() const {
  const plan_response_t whole = pages_.whole();
  if (const auto fault = fault_in(whole)) return bad_answer(whole, *fault);
  PlanResponse response;
  convert(whole, response);
  std::vector<Segment> segments;
  convert(whole.segments, segments);
  response.path = Path(std::move(segments));
  return response;
}

}  // namespace camway
