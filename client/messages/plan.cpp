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

static_assert(static_cast<int>(Body::Shape::kMesh) == body_t::MESH);
static_assert(static_cast<int>(Correction::Method::kShrink) == correction_t::SHRINK);
static_assert(static_cast<int>(Objective::kSafest) == plan_request_t::SAFEST);
static_assert(static_cast<int>(Orientation::Policy::kTarget) == orientation_t::TARGET);
static_assert(static_cast<int>(PlanProgress::Stage::kCertifying) == plan_progress_t::CERTIFYING);
static_assert(static_cast<int>(Priority::kLow) == plan_request_t::LOW);

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

void convert(const Keyframe& mine, keyframe_t& wire) {
  static_assert(wire::lacks_only<keyframe_t, Keyframe>({"origin", "repaired"}));
  convert_common(mine, wire);
}

/// Writes the lists that the shape uses; the daemon refuses others.
void convert(const Body& mine, body_t& wire) {
  convert(mine.shape, wire.type);
  convert(mine.center_m, wire.center_m);
  convert(mine.size_m, wire.size_m);
  wire.radius_m = mine.radius_m;
  if (mine.shape == Body::Shape::kConvex) {
    for (const std::vector<Body::Point>& piece : mine.pieces_m) {
      wire.piece_sizes.push_back(static_cast<std::int32_t>(piece.size()));
      convert(piece, wire.points_m);
    }
  } else if (mine.shape == Body::Shape::kMesh) {
    convert(mine.vertices_m, wire.points_m);
    convert(mine.triangles, wire.triangles);
  }
  wire::set_counts(wire);
}

void convert(const PlanRequest& mine, plan_request_t& wire) {
  static_assert(wire::lacks_only<plan_request_t, PlanRequest>(
      {"client_id", "utime", "page", "num_pages", "correct_nothing", "has_times"}));
  convert_common(mine, wire);
  wire.correct_nothing = mine.max_inserted_keyframes == 0 ? 1 : 0;
  wire.has_times = has_times(mine) ? 1 : 0;
  wire::set_counts(wire);
}

void convert(const keyframe_t& wire, PathKeyframe& mine) {
  static_assert(wire::lacks_only<keyframe_t, PathKeyframe>({"origin"}));
  convert_common(wire, mine);
  mine.inserted = wire.origin == keyframe_t::ORIGIN_INSERTED;
}

void convert(const keyframe_fault_t& wire, KeyframeFault& mine) {
  static_assert(wire::lacks_only<keyframe_fault_t, KeyframeFault>(
      {"has_free_pose", "free_position_m", "free_orientation_wxyz"}));
  convert_common(wire, mine);
  if (wire.has_free_pose == 0) return;
  convert(wire.free_position_m, mine.free_pose.emplace().position_m);
  convert(wire.free_orientation_wxyz, mine.free_pose->orientation_wxyz);
}

void convert(const plan_response_t& wire, PlanResponse& mine) {
  static_assert(wire::lacks_only<plan_response_t, PlanResponse>(
      {"client_id", "utime", "page", "num_pages", "has_infeasibility", "keyframe_inside",
       "keyframe_outside", "has_cage", "proof_cage", "motion_ms", "detect_ms", "correct_ms",
       "certify_ms", "total_ms", "segments", "proof_triangles"}));
  convert_common(wire, mine);
  convert_common(wire, mine.timing);
  if (wire.has_infeasibility == 0) return;
  convert_common(wire, mine.infeasibility.emplace());
  mine.infeasibility->triangles = wire.proof_triangles;
  if (wire.has_cage != 0) convert(wire.proof_cage, mine.infeasibility->cage);
}

void convert(const plan_progress_t& wire, PlanProgress& mine) {
  static_assert(
      wire::lacks_only<plan_progress_t, PlanProgress>({"client_id", "request_id", "utime"}));
  convert_common(wire, mine);
  const bool is_known =
      wire.stage >= plan_progress_t::WAITING && wire.stage <= plan_progress_t::CERTIFYING;
  if (!is_known) mine.stage = PlanProgress::Stage::kWaiting;
}

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
