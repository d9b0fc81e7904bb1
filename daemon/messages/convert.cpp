// SPDX-License-Identifier: MIT
#include "daemon/messages/convert.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <camway/occupancy_response_t.hpp>

#include "daemon/messages/body.h"
#include "daemon/messages/names.h"
#include "daemon/messages/options.h"
#include "daemon/messages/report.h"
#include "lcmtypes/wire/layout.h"

namespace camway::service {
namespace {

using geometry::Vec3;
using geometry::Vec4;
using planning::Status;

void put(const Vec3& from, double (&to)[3]) { std::copy_n(from.data(), 3, to); }
void put(const Vec4& from, double (&to)[4]) { std::copy_n(from.data(), 4, to); }
Vec3 vec3(const double (&from)[3]) { return {from[0], from[1], from[2]}; }
Vec4 vec4(const double (&from)[4]) { return {from[0], from[1], from[2], from[3]}; }

keyframe_t wire_keyframe(const motion::Keyframe& keyframe) {
  keyframe_t wire{};
  wire.time_s = keyframe.time_s;
  put(keyframe.pose.position, wire.position_m);
  put(geometry::wxyz(keyframe.pose.orientation), wire.orientation_wxyz);
  wire.origin = keyframe.origin == motion::KeyframeOrigin::kInserted ? keyframe_t::ORIGIN_INSERTED
                                                                     : keyframe_t::ORIGIN_GIVEN;
  wire.repaired = keyframe.is_repaired ? 1 : 0;
  return wire;
}

motion::Keyframe keyframe_of(const keyframe_t& wire) {
  motion::Keyframe keyframe;
  keyframe.time_s = wire.time_s;
  keyframe.pose.position = vec3(wire.position_m);
  keyframe.pose.orientation = geometry::from_wxyz(vec4(wire.orientation_wxyz));
  keyframe.origin = wire.origin == keyframe_t::ORIGIN_INSERTED ? motion::KeyframeOrigin::kInserted
                                                               : motion::KeyframeOrigin::kGiven;
  keyframe.is_repaired = wire.repaired != 0;
  return keyframe;
}

segment_t wire_segment(const motion::Segment& segment) {
  segment_t wire{};
  wire.t0_s = segment.t0_s;
  wire.t1_s = segment.t1_s;
  for (std::size_t i = 0; i < segment.position.size(); ++i) {
    put(segment.position[i], wire.position_m[i]);
  }
  for (std::size_t i = 0; i < segment.orientation.size(); ++i) {
    put(segment.orientation[i], wire.orientation_wxyz[i]);
  }
  return wire;
}

motion::Segment segment_of(const segment_t& wire) {
  motion::Segment segment;
  segment.t0_s = wire.t0_s;
  segment.t1_s = wire.t1_s;
  for (std::size_t i = 0; i < segment.position.size(); ++i) {
    segment.position[i] = vec3(wire.position_m[i]);
  }
  for (std::size_t i = 0; i < segment.orientation.size(); ++i) {
    segment.orientation[i] = vec4(wire.orientation_wxyz[i]);
  }
  return segment;
}

collision_interval_t wire_interval(const collision::CollisionInterval& interval,
                                   const planning::WitnessNames& names) {
  collision_interval_t wire{};
  wire.t_begin_s = interval.t_begin_s;
  wire.t_end_s = interval.t_end_s;
  if (!interval.witness) return wire;
  wire.has_witness = 1;
  wire.witness_time_s = interval.witness->time_s;
  wire.witness_object = clipped(names.object, wire::kMaxObjectNameBytes);
  wire.witness_triangle = static_cast<std::int32_t>(interval.witness->triangle);
  wire.witness_feature = clipped(names.feature, wire::kMaxFeatureBytes);
  wire.witness_depth_m = interval.witness->depth_m;
  put(interval.witness->point_W, wire.witness_point_m);
  return wire;
}

/// `names` may be shorter than `intervals`: the rest of the witnesses have no names.
std::vector<collision_interval_t> wire_intervals(
    const std::vector<collision::CollisionInterval>& intervals,
    const std::vector<planning::WitnessNames>& names) {
  std::vector<collision_interval_t> wire;
  wire.reserve(intervals.size());
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    wire.push_back(
        wire_interval(intervals[i], i < names.size() ? names[i] : planning::WitnessNames{}));
  }
  return wire;
}

collision::CollisionInterval interval_of(const collision_interval_t& wire) {
  collision::CollisionInterval interval{wire.t_begin_s, wire.t_end_s};
  if (wire.has_witness == 0) return interval;
  collision::Witness& witness = interval.witness.emplace();
  witness.time_s = wire.witness_time_s;
  witness.triangle = static_cast<std::uint32_t>(wire.witness_triangle);
  witness.depth_m = wire.witness_depth_m;
  witness.point_W = vec3(wire.witness_point_m);
  return interval;
}

void read_intervals(const std::vector<collision_interval_t>& wire,
                    std::vector<collision::CollisionInterval>& intervals,
                    std::vector<planning::WitnessNames>& names) {
  for (const collision_interval_t& interval : wire) {
    intervals.push_back(interval_of(interval));
    const bool has_names = interval.has_witness != 0;
    names.push_back(has_names
                        ? planning::WitnessNames{interval.witness_object, interval.witness_feature}
                        : planning::WitnessNames{});
  }
}

std::int32_t wire_status(Status status) {
  switch (status) {
    case Status::kOk:
      return plan_response_t::STATUS_OK;
    case Status::kPartial:
      return plan_response_t::STATUS_PARTIAL;
    case Status::kInfeasible:
      return plan_response_t::STATUS_INFEASIBLE;
    case Status::kTimeout:
      return plan_response_t::STATUS_TIMEOUT;
    case Status::kInvalid:
      return plan_response_t::STATUS_INVALID;
    case Status::kUnknownScene:
      return plan_response_t::STATUS_UNKNOWN_SCENE;
    case Status::kInternalError:
      return plan_response_t::STATUS_INTERNAL_ERROR;
  }
  return plan_response_t::STATUS_INTERNAL_ERROR;
}

std::optional<Status> status_of(std::int32_t wire) {
  switch (wire) {
    case plan_response_t::STATUS_OK:
      return Status::kOk;
    case plan_response_t::STATUS_PARTIAL:
      return Status::kPartial;
    case plan_response_t::STATUS_INFEASIBLE:
      return Status::kInfeasible;
    case plan_response_t::STATUS_TIMEOUT:
      return Status::kTimeout;
    case plan_response_t::STATUS_INVALID:
      return Status::kInvalid;
    case plan_response_t::STATUS_UNKNOWN_SCENE:
      return Status::kUnknownScene;
    case plan_response_t::STATUS_INTERNAL_ERROR:
      return Status::kInternalError;
    default:
      return std::nullopt;
  }
}

/// Only an exact 0 asks for the default: NaN and negative values go on to `planning::validate`.
double or_default(double wire, double fallback) { return wire == 0.0 ? fallback : wire; }

/// Checks the preconditions of `motion::Path`, which does not check them itself.
std::string path_fault(const std::vector<segment_t>& segments) {
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const segment_t& segment = segments[i];
    const std::string name = "segments[" + std::to_string(i) + "]";
    if (!std::isfinite(segment.t0_s) || !std::isfinite(segment.t1_s) ||
        !(segment.t0_s < segment.t1_s)) {
      return name + ": its times do not increase";
    }
    if (i > 0 && segments[i - 1].t1_s != segment.t0_s) {
      return name + ": does not begin where the one before ends";
    }
  }
  return {};
}

/// Returns an error about a member that has a value but no effect: its sender meant it.
std::string idle_member(const plan_request_t& wire) {
  if (wire.correct_nothing != 0 && wire.max_inserted_keyframes != 0) {
    return "max_inserted_keyframes: is " + std::to_string(wire.max_inserted_keyframes) +
           ", which does not count beside correct_nothing; leave it 0";
  }
  for (std::size_t i = 0; wire.has_times == 0 && i < wire.keyframes.size(); ++i) {
    if (wire.keyframes[i].time_s != 0.0) {
      return "keyframes[" + std::to_string(i) +
             "].time_s: is not 0, and does not count without has_times; set that, or leave all "
             "times 0";
    }
  }
  return {};
}

template <class List>
std::int32_t count(const List& list) {
  return static_cast<std::int32_t>(list.size());
}

}  // namespace

double deadline_of(double wire_s, const DeadlineLimits& limits) {
  const double deadline_s = or_default(wire_s, limits.default_s);
  return deadline_s > limits.max_s ? limits.max_s : deadline_s;
}

ConvertedRequest from_wire(const plan_request_t& wire, const DeadlineLimits& limits) {
  planning::PlanRequest request;
  request.scene = wire.scene;
  request.camera = {wire.camera.fov_x_rad, wire.camera.fov_y_rad, wire.camera.near_m};
  ConvertedBody body = body_of(wire.body);
  if (!body.error.empty()) return {std::nullopt, std::move(body.error)};
  request.body = std::move(body.shape);
  if (!wire.method.empty()) {
    const std::optional<planning::Method> method = planning::method_from_string(wire.method);
    if (!method) return {std::nullopt, "method: '" + wire.method + "' is unknown"};
    request.options.method = *method;
  }
  planning::PlanOptions& options = request.options;
  options.deadline_s = deadline_of(wire.deadline_s, limits);
  options.chord_error_m = or_default(wire.chord_error_m, options.chord_error_m);
  options.interval_tolerance_m =
      or_default(wire.interval_tolerance_m, options.interval_tolerance_m);
  options.clearance_m = wire.clearance_m;
  if (wire.max_inserted_keyframes != 0) {
    options.max_inserted_keyframes = wire.max_inserted_keyframes;
  }
  if (wire.correct_nothing != 0) options.max_inserted_keyframes = 0;
  if (wire.default_speed_m_per_s != 0.0) {
    options.default_speed_m_per_s = wire.default_speed_m_per_s;
  }
  if (std::string error = idle_member(wire); !error.empty()) {
    return {std::nullopt, std::move(error)};
  }
  if (std::string error = read_correction_options(wire, options); !error.empty()) {
    return {std::nullopt, std::move(error)};
  }
  request.has_times = wire.has_times != 0;
  request.spelling = wire_spelling(wire);
  request.keyframes.reserve(wire.keyframes.size());
  for (const keyframe_t& keyframe : wire.keyframes) {
    request.keyframes.push_back(keyframe_of(keyframe));
    request.keyframes.back().origin = motion::KeyframeOrigin::kGiven;
    request.keyframes.back().is_repaired = false;
  }
  return {std::move(request), {}};
}

plan_request_t to_wire(const planning::PlanRequest& request, const RequestIds& ids) {
  plan_request_t wire{};
  wire.client_id = ids.client_id;
  wire.request_id = ids.request_id;
  wire.utime = ids.utime;
  wire.num_pages = 1;
  wire.scene = request.scene;
  // The wire has no near quadrilateral other than the camera's, so one that is given as the body
  // goes as the camera.
  const auto* camera = request.body ? std::get_if<motion::Camera>(&*request.body) : nullptr;
  if (camera == nullptr) camera = &request.camera;
  wire.camera.fov_x_rad = camera->fov_x_rad;
  wire.camera.fov_y_rad = camera->fov_y_rad;
  wire.camera.near_m = camera->near_m;
  if (request.body) wire.body = wire_body(*request.body);
  wire.method = planning::to_string(request.options.method);
  wire.deadline_s = request.options.deadline_s;
  wire.chord_error_m = request.options.chord_error_m;
  wire.interval_tolerance_m = request.options.interval_tolerance_m;
  wire.clearance_m = request.options.clearance_m;
  wire.max_inserted_keyframes = request.options.max_inserted_keyframes;
  wire.correct_nothing = request.options.max_inserted_keyframes == 0 ? 1 : 0;
  wire.default_speed_m_per_s = request.options.default_speed_m_per_s.value_or(0.0);
  put_correction_options(request.options, wire);
  wire.has_times = request.has_times ? 1 : 0;
  wire.keyframes.reserve(request.keyframes.size());
  for (const motion::Keyframe& keyframe : request.keyframes) {
    wire.keyframes.push_back(wire_keyframe(keyframe));
    if (!request.has_times) wire.keyframes.back().time_s = 0.0;
  }
  wire.num_keyframes = count(wire.keyframes);
  return wire;
}

ConvertedResult from_wire(const plan_response_t& wire) {
  const std::optional<Status> status = status_of(wire.status);
  if (!status) {
    return {std::nullopt, std::string(status_name(wire.status)) + ": " + wire.message};
  }
  if (std::string fault = path_fault(wire.segments); !fault.empty()) return {std::nullopt, fault};

  planning::PlanResult result;
  result.status = *status;
  result.message = wire.message;
  if (wire.keyframe >= 0) result.keyframe = static_cast<std::size_t>(wire.keyframe);
  std::vector<motion::Segment> segments;
  segments.reserve(wire.segments.size());
  for (const segment_t& segment : wire.segments) segments.push_back(segment_of(segment));
  if (!segments.empty()) result.path = motion::Path(std::move(segments));
  for (const keyframe_t& keyframe : wire.keyframes) {
    result.keyframes.push_back(keyframe_of(keyframe));
  }
  read_intervals(wire.collisions, result.collisions, result.collision_names);
  read_intervals(wire.remaining, result.remaining_collisions, result.remaining_names);
  result.certificate = {wire.certified != 0, wire.clearance_lower_bound_m};
  result.timing.motion_ms = wire.motion_ms;
  result.timing.detect_ms = wire.detect_ms;
  result.timing.correct_ms = wire.correct_ms;
  result.timing.certify_ms = wire.certify_ms;
  result.timing.total_ms = wire.total_ms;
  if (std::string error = read_report(wire, result); !error.empty()) {
    return {std::nullopt, std::move(error)};
  }
  return {std::move(result), {}};
}

plan_response_t to_wire(const planning::PlanResult& result, const AnswerHeader& header) {
  plan_response_t wire = plain_answer(wire_status(result.status), result.message, header);
  if (result.keyframe) wire.keyframe = static_cast<std::int32_t>(*result.keyframe);
  wire.certified = result.certificate.certified ? 1 : 0;
  wire.clearance_lower_bound_m = result.certificate.clearance_lower_bound_m;
  wire.motion_ms = result.timing.motion_ms;
  wire.detect_ms = result.timing.detect_ms;
  wire.correct_ms = result.timing.correct_ms;
  wire.certify_ms = result.timing.certify_ms;
  wire.total_ms = result.timing.total_ms;
  for (const motion::Segment& segment : result.path.segments()) {
    wire.segments.push_back(wire_segment(segment));
  }
  for (const motion::Keyframe& keyframe : result.keyframes) {
    wire.keyframes.push_back(wire_keyframe(keyframe));
  }
  wire.collisions = wire_intervals(result.collisions, result.collision_names);
  wire.remaining = wire_intervals(result.remaining_collisions, result.remaining_names);
  wire.num_segments = count(wire.segments);
  wire.num_keyframes = count(wire.keyframes);
  wire.num_collisions = count(wire.collisions);
  wire.num_remaining = count(wire.remaining);
  put_report(result, wire);
  return wire;
}

plan_response_t plain_answer(std::int32_t status, std::string_view message,
                             const AnswerHeader& header) {
  plan_response_t wire{};
  wire.client_id = header.ids.client_id;
  wire.request_id = header.ids.request_id;
  wire.utime = header.ids.utime;
  wire.num_pages = 1;
  wire.status = status;
  wire.message = clipped(message, wire::kMaxTextBytes);
  wire.keyframe = -1;
  wire.scene = clipped(header.scene, wire::kMaxSceneNameBytes);
  wire.scene_revision = header.scene_revision;
  wire.scene_digest = clipped(header.scene_digest, wire::kMaxDigestBytes);
  wire.near_scale = 1.0;
  wire.time_scale = 1.0;
  wire.keyframe_inside = -1;
  wire.keyframe_outside = -1;
  return wire;
}

std::string_view status_name(std::int32_t wire_status) {
  if (const std::optional<Status> status = status_of(wire_status)) {
    return planning::to_string(*status);
  }
  if (wire_status == plan_response_t::STATUS_OVERLOADED) return "overloaded";
  if (wire_status == plan_response_t::STATUS_MALFORMED) return "malformed";
  if (wire_status == plan_response_t::STATUS_CANCELLED) return "cancelled";
  if (wire_status == plan_response_t::STATUS_LIMIT) return "limit";
  if (wire_status == occupancy_response_t::STATUS_NO_MAP) return "no_map";
  return "unknown status";
}

std::string clipped(std::string_view text, std::size_t max_bytes) {
  std::size_t size = std::min({text.size(), max_bytes, text.find('\0')});
  // A byte 10xxxxxx continues a character; cutting before one would leave half of it.
  const auto continues = [&](std::size_t i) {
    return (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U;
  };
  if (size == max_bytes) {
    while (size > 0 && size < text.size() && continues(size)) --size;
  }
  return std::string(text.substr(0, size));
}

}  // namespace camway::service
