// SPDX-License-Identifier: MIT
#include "client/messages/plan.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <utility>

#include <camway/plan_request_t.hpp>

#include "client/messages/body.h"
#include "client/messages/constraints.h"
#include "client/messages/correction.h"
#include "client/messages/text.h"
#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/layout.h"

namespace camway {
namespace {

constexpr std::size_t kMaxKeyframes = 100'000;  // as in plan_request_t.lcm

keyframe_t to_wire(const Keyframe& keyframe) {
  keyframe_t wire{};
  wire.time_s = keyframe.time_s.value_or(0.0);
  std::copy(keyframe.position_m.begin(), keyframe.position_m.end(), wire.position_m);
  std::copy(keyframe.orientation_wxyz.begin(), keyframe.orientation_wxyz.end(),
            wire.orientation_wxyz);
  return wire;
}

PathKeyframe from_wire(const keyframe_t& wire) {
  PathKeyframe keyframe;
  keyframe.time_s = wire.time_s;
  std::copy(std::begin(wire.position_m), std::end(wire.position_m), keyframe.position_m.begin());
  std::copy(std::begin(wire.orientation_wxyz), std::end(wire.orientation_wxyz),
            keyframe.orientation_wxyz.begin());
  keyframe.inserted = wire.origin == keyframe_t::ORIGIN_INSERTED;
  keyframe.repaired = wire.repaired != 0;
  return keyframe;
}

Segment from_wire(const segment_t& wire) {
  Segment segment;
  segment.t0_s = wire.t0_s;
  segment.t1_s = wire.t1_s;
  static_assert(sizeof(segment.position_m) == sizeof(wire.position_m));
  static_assert(sizeof(segment.orientation_wxyz) == sizeof(wire.orientation_wxyz));
  std::memcpy(segment.position_m.data(), wire.position_m, sizeof(wire.position_m));
  std::memcpy(segment.orientation_wxyz.data(), wire.orientation_wxyz,
              sizeof(wire.orientation_wxyz));
  return segment;
}

CollisionInterval from_wire(const collision_interval_t& wire) {
  CollisionInterval interval{wire.t_begin_s, wire.t_end_s, std::nullopt};
  if (wire.has_witness == 0) return interval;
  Witness& witness = interval.witness.emplace();
  witness.time_s = wire.witness_time_s;
  witness.object = wire.witness_object;
  witness.triangle = wire.witness_triangle;
  witness.feature = wire.witness_feature;
  witness.depth_m = wire.witness_depth_m;
  std::copy(std::begin(wire.witness_point_m), std::end(wire.witness_point_m),
            witness.point_m.begin());
  return interval;
}

bool has_times(const PlanRequest& request) {
  return !request.keyframes.empty() && request.keyframes.front().time_s.has_value();
}

/// Returns the request without keyframes and body.
plan_request_t head_of(const PlanRequest& request, const std::string& client_id,
                       std::int64_t request_id) {
  plan_request_t wire{};
  wire.client_id = client_id;
  wire.request_id = request_id;
  wire.utime = microseconds_since_1970();
  wire.scene = request.scene;
  wire.camera.fov_x_rad = request.camera.fov_x_rad;
  wire.camera.fov_y_rad = request.camera.fov_y_rad;
  wire.camera.near_m = request.camera.near_m;
  wire.method = request.method;
  wire.priority = static_cast<std::int8_t>(request.priority);
  wire.deadline_s = request.deadline_s;
  wire.progress_period_s = request.progress_period_s;
  wire.watch_lease_s = request.watch_lease_s;
  wire.chord_error_m = request.chord_error_m;
  wire.interval_tolerance_m = request.interval_tolerance_m;
  wire.clearance_m = request.clearance_m;
  wire.max_inserted_keyframes = request.max_inserted_keyframes.value_or(0);
  wire.correct_nothing = request.max_inserted_keyframes == 0 ? 1 : 0;
  wire.objective = to_wire(request.objective);
  wire.orientation = to_wire(request.orientation);
  wire.limits = to_wire(request.limits);
  wire.bounds = to_wire(request.bounds);
  wire.max_shrink = request.max_shrink;
  wire.repair_keyframes = request.repair_keyframes ? 1 : 0;
  wire.seed = request.seed;
  wire.has_times = has_times(request) ? 1 : 0;
  wire.default_speed_m_per_s = request.default_speed_m_per_s;
  return wire;
}

bool finite(const segment_t& segment) {
  const auto is_finite = [](double value) { return std::isfinite(value); };
  return is_finite(segment.t0_s) && is_finite(segment.t1_s) &&
         std::all_of(&segment.position_m[0][0], &segment.position_m[0][0] + 4 * 3, is_finite) &&
         std::all_of(&segment.orientation_wxyz[0][0], &segment.orientation_wxyz[0][0] + 7 * 4,
                     is_finite);
}

/// Returns why segment `next` cannot follow `previous` in a path, or nothing.
std::optional<std::string> fault_in_segment(const segment_t* previous, const segment_t& next) {
  if (!finite(next)) return "holds numbers that are not finite";
  if (!(next.t0_s < next.t1_s)) return "does not end after it begins";
  // The daemon sends the same number twice, so that there is neither gap nor overlap.
  if (previous != nullptr && previous->t1_s != next.t0_s) {
    return "does not begin where the one before ends";
  }
  return std::nullopt;
}

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof(a)) == 0; }

/// Returns whether two pages belong to one answer: whether their repeated members are equal.
bool same_answer(const plan_response_t& a, const plan_response_t& b) {
  return a.num_pages == b.num_pages && a.utime == b.utime && a.status == b.status &&
         a.message == b.message && a.keyframe == b.keyframe && a.scene == b.scene &&
         a.scene_revision == b.scene_revision && a.scene_digest == b.scene_digest &&
         a.certified == b.certified &&
         same_bits(a.clearance_lower_bound_m, b.clearance_lower_bound_m) &&
         same_bits(a.near_scale, b.near_scale) && same_bits(a.time_scale, b.time_scale) &&
         a.deadline_reached == b.deadline_reached &&
         a.has_measures_before == b.has_measures_before && a.has_measures == b.has_measures &&
         a.has_infeasibility == b.has_infeasibility && a.keyframe_inside == b.keyframe_inside &&
         a.keyframe_outside == b.keyframe_outside && a.has_cage == b.has_cage &&
         same_bits(a.total_ms, b.total_ms);
}

void append_lists(const plan_response_t& page, std::vector<Segment>& segments,
                  PlanResponse& response) {
  for (const segment_t& segment : page.segments) segments.push_back(from_wire(segment));
  for (const keyframe_t& keyframe : page.keyframes) {
    response.keyframes.push_back(from_wire(keyframe));
  }
  for (const collision_interval_t& interval : page.collisions) {
    response.collisions.push_back(from_wire(interval));
  }
  for (const collision_interval_t& interval : page.remaining) {
    response.remaining.push_back(from_wire(interval));
  }
}

/// Returns the answer without its lists.
PlanResponse head_of(const plan_response_t& page) {
  PlanResponse response;
  response.status = static_cast<Status>(page.status);
  response.message = page.message;
  response.keyframe = page.keyframe;
  response.certified = page.certified != 0;
  response.clearance_lower_bound_m = page.clearance_lower_bound_m;
  response.scene = page.scene;
  response.scene_revision = page.scene_revision;
  response.scene_digest = page.scene_digest;
  response.request_id = page.request_id;
  read_correction_head(page, response);
  response.timing = {page.motion_ms, page.detect_ms, page.correct_ms, page.certify_ms,
                     page.total_ms};
  return response;
}

PlanResponse bad_answer(const PlanResponse& head, const std::string& what) {
  PlanResponse response;
  response.status = Status::kBadAnswer;
  response.message = head.message;
  response.request_id = head.request_id;
  response.error = "the daemon's answer makes no sense: " + what +
                   "; check that client and daemon are of one version";
  return response;
}

}  // namespace

std::optional<std::string> fault_in_form(const PlanRequest& request) {
  if (auto fault = fault_in_text("scene", request.scene, wire::kMaxSceneNameBytes)) return fault;
  if (auto fault = fault_in_text("method", request.method, wire::kMaxMethodBytes)) return fault;
  if (auto fault = fault_in_form(request.body)) return fault;
  if (request.keyframes.size() > kMaxKeyframes) {
    return "keyframes: there are " + std::to_string(request.keyframes.size()) + ", at most " +
           std::to_string(kMaxKeyframes) + " are allowed";
  }
  for (std::size_t i = 0; i < request.keyframes.size(); ++i) {
    if (request.keyframes[i].time_s.has_value() == has_times(request)) continue;
    return "keyframes[" + std::to_string(i) + "].time_s: " +
           (has_times(request) ? "is not set, that of keyframe 0 is"
                               : "is set, that of keyframe 0 is not") +
           "; all keyframes have a time, or none has";
  }
  return std::nullopt;
}

std::vector<Bytes> to_pages(const PlanRequest& request, const std::string& client_id,
                            std::int64_t request_id) {
  const plan_request_t head = head_of(request, client_id, request_id);
  const auto keyframe_bytes = static_cast<std::size_t>(keyframe_t{}._getEncodedSizeNoHash());
  const auto fit = [&](const plan_request_t& page) {
    return (wire::kMaxMessageBytes - static_cast<std::size_t>(page.getEncodedSize())) /
           keyframe_bytes;
  };
  std::vector<plan_request_t> pages{head};
  pages.back().body = to_wire(request.body);
  std::size_t left = fit(pages.back());
  for (const Keyframe& keyframe : request.keyframes) {
    if (left == 0) {
      pages.push_back(head);
      left = fit(head);
    }
    pages.back().keyframes.push_back(to_wire(keyframe));
    --left;
  }
  std::vector<Bytes> encoded;
  for (plan_request_t& page : pages) {
    page.page = static_cast<std::int32_t>(encoded.size());
    page.num_pages = static_cast<std::int32_t>(pages.size());
    page.num_keyframes = static_cast<std::int32_t>(page.keyframes.size());
    encoded.push_back(wire::encode(page));
  }
  return encoded;
}

PlanProgress from_wire(const plan_progress_t& wire) {
  PlanProgress progress;
  if (wire.stage >= plan_progress_t::WAITING && wire.stage <= plan_progress_t::CERTIFYING) {
    progress.stage = static_cast<PlanProgress::Stage>(wire.stage);
  }
  progress.requests_ahead = wire.requests_ahead;
  progress.num_collisions = wire.num_collisions;
  progress.num_corrected = wire.num_corrected;
  progress.since_receipt_s = wire.since_receipt_s;
  progress.deadline_s = wire.deadline_s;
  return progress;
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
  if (page.num_pages < 1 || page.num_pages > wire::kMaxResponsePages || page.page < 0 ||
      page.page >= page.num_pages) {
    fault_ = "plan_response_t.page: " + std::to_string(page.page) + " of " +
             std::to_string(page.num_pages) + " is out of range";
    return Taken::kBad;
  }
  if (!pages_.empty() && !same_answer(pages_.begin()->second, page)) pages_.clear();
  const bool is_new = pages_.emplace(page.page, std::move(page)).second;
  return is_new ? Taken::kNew : Taken::kKnown;
}

bool PlanCollector::complete() const {
  return !pages_.empty() && pages_.size() == pages_expected();
}

std::size_t PlanCollector::pages_expected() const {
  return pages_.empty() ? 0 : static_cast<std::size_t>(pages_.begin()->second.num_pages);
}

std::vector<std::int32_t> PlanCollector::missing() const {
  std::vector<std::int32_t> missing;
  for (std::int32_t page = 0; page < static_cast<std::int32_t>(pages_expected()); ++page) {
    if (pages_.find(page) == pages_.end()) missing.push_back(page);
  }
  return missing;
}

Status PlanCollector::status() const { return static_cast<Status>(pages_.begin()->second.status); }

PlanResponse PlanCollector::response() const {
  PlanResponse response = head_of(pages_.begin()->second);
  const std::int32_t status = pages_.begin()->second.status;
  if ((status < 0 || status > plan_response_t::STATUS_MALFORMED) &&
      status != plan_response_t::STATUS_CANCELLED && status != plan_response_t::STATUS_LIMIT) {
    return bad_answer(response, "status " + std::to_string(status) + " is unknown");
  }
  std::vector<Segment> segments;
  const segment_t* previous = nullptr;
  for (const auto& [number, page] : pages_) {
    for (const segment_t& segment : page.segments) {
      if (const auto fault = fault_in_segment(previous, segment)) {
        return bad_answer(
            response, "a segment of the path at " + std::to_string(segment.t0_s) + " s " + *fault);
      }
      previous = &segment;
    }
    append_lists(page, segments, response);
    if (const auto fault = append_correction_lists(page, response)) {
      return bad_answer(response, *fault);
    }
  }
  if (response.ok() && segments.empty()) return bad_answer(response, "status ok without a path");
  response.path = Path(std::move(segments));
  return response;
}

}  // namespace camway
