// SPDX-License-Identifier: MIT
#include "lcmtypes/wire_layout.h"

#include <array>

#include <camway/cancel_t.hpp>
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

#include "lcmtypes/channels.h"

namespace camway::wire {
namespace {

constexpr std::size_t kByte = 1;
constexpr std::size_t kInt32 = 4;
constexpr std::size_t kInt64 = 8;
constexpr std::size_t kDouble = 8;

constexpr std::size_t kCamera = 3 * kDouble;
constexpr std::size_t kKeyframe = (1 + 3 + 4) * kDouble + 2 * kByte;
constexpr std::size_t kOrientation = kByte + (3 + 3 + 1) * kDouble + kByte + kDouble;
constexpr std::size_t kMotionLimits = 3 * kDouble + kByte;
constexpr std::size_t kMeasures = 8 * kDouble;
constexpr std::size_t kCage = 12 * kDouble;
constexpr std::size_t kCorrection = 2 * kDouble + kByte + 4 * kDouble + 4 * kInt32;
constexpr std::size_t kSlowedStretch = 4 * kDouble;
constexpr std::size_t kKeyframeFault = kInt32 + kDouble + kByte + (3 + 4) * kDouble;
constexpr std::size_t kWatchedPath = 2 * kInt64;
constexpr std::size_t kPathState = 2 * kInt64 + kByte + 2 * kInt64;
constexpr std::size_t kBrokenInterval = kInt64 + 2 * kDouble;
constexpr std::size_t kSegment = (2 + 4 * 3 + 7 * 4) * kDouble;

constexpr Field fixed(std::string_view name, std::size_t bytes) {
  return {.kind = Field::Kind::kFixed, .name = name, .bytes = bytes};
}
constexpr Field text(std::string_view name, std::size_t max_length) {
  return {.kind = Field::Kind::kString, .name = name, .max_length = max_length};
}
constexpr Field list(std::string_view name, std::size_t element_bytes) {
  return {.kind = Field::Kind::kList, .name = name, .bytes = element_bytes};
}
constexpr Field list_of(std::string_view name, std::span<const Field> element) {
  return {.kind = Field::Kind::kList, .name = name, .element = element};
}

constexpr std::array kPlanRequest{
    text("client_id", kMaxClientIdLength),
    fixed("request_id", kInt64),
    fixed("utime", kInt64),
    fixed("page", kInt32),
    fixed("num_pages", kInt32),
    text("scene", kMaxSceneNameBytes),
    fixed("camera", kCamera),
    fixed("body.type", kByte),
    fixed("body.center_m", 3 * kDouble),
    fixed("body.size_m", 3 * kDouble),
    fixed("body.radius_m", kDouble),
    list("body.piece_sizes", kInt32),
    list("body.points_m", 3 * kDouble),
    list("body.triangles", 3 * kInt32),
    text("method", kMaxMethodBytes),
    fixed("priority", kByte),
    fixed("deadline_s", kDouble),
    fixed("progress_period_s", kDouble),
    fixed("watch_lease_s", kDouble),
    fixed("chord_error_m", kDouble),
    fixed("interval_tolerance_m", kDouble),
    fixed("clearance_m", kDouble),
    fixed("max_inserted_keyframes", kInt32),
    fixed("correct_nothing", kByte),
    fixed("objective", kByte),
    fixed("orientation", kOrientation),
    fixed("limits", kMotionLimits),
    fixed("max_shrink", kDouble),
    fixed("repair_keyframes", kByte),
    fixed("seed", kInt64),
    fixed("has_times", kByte),
    fixed("default_speed_m_per_s", kDouble),
    list("keyframes", kKeyframe),
};

constexpr std::array kInterval{
    fixed("t_s", 2 * kDouble),         fixed("has_witness", kByte),
    fixed("witness_time_s", kDouble),  text("witness_object", kMaxObjectNameBytes),
    fixed("witness_triangle", kInt32), text("witness_feature", kMaxFeatureBytes),
    fixed("witness_depth_m", kDouble), fixed("witness_point_m", 3 * kDouble),
};

constexpr std::array kPlanResponse{
    text("client_id", kMaxClientIdLength),
    fixed("request_id", kInt64),
    fixed("utime", kInt64),
    fixed("page", kInt32),
    fixed("num_pages", kInt32),
    fixed("status", kInt32),
    text("message", kMaxTextBytes),
    fixed("keyframe", kInt32),
    text("scene", kMaxSceneNameBytes),
    fixed("scene_revision", kInt64),
    text("scene_digest", kMaxDigestBytes),
    fixed("certified", kByte),
    fixed("clearance_lower_bound_m", kDouble),
    fixed("scales", 2 * kDouble),
    fixed("deadline_reached", kByte),
    fixed("has_measures_before", kByte),
    fixed("measures_before", kMeasures),
    fixed("has_measures", kByte),
    fixed("measures", kMeasures),
    fixed("has_infeasibility", kByte),
    fixed("keyframes_apart", 2 * kInt32),
    fixed("has_cage", kByte),
    fixed("proof_cage", kCage),
    fixed("timing", 5 * kDouble),
    list("segments", kSegment),
    list("keyframes", kKeyframe),
    list_of("collisions", kInterval),
    list_of("remaining", kInterval),
    list("corrections", kCorrection),
    list("slowed", kSlowedStretch),
    list("keyframe_faults", kKeyframeFault),
    list("proof_triangles", kInt32),
};

constexpr std::array kCancel{
    text("client_id", kMaxClientIdLength),
    fixed("request_id", kInt64),
    fixed("utime", kInt64),
};

constexpr std::array kPlanProgress{
    text("client_id", kMaxClientIdLength),
    fixed("request_id", kInt64),
    fixed("utime", kInt64),
    fixed("stage", kByte),
    fixed("counts", 3 * kInt32),
    fixed("times", 2 * kDouble),
};

constexpr std::array kMissingPages{
    text("client_id", kMaxClientIdLength),
    fixed("request_id", kInt64),
    fixed("utime", kInt64),
    fixed("num_pages", kInt32),
    list("missing", kInt32),
};

constexpr std::array kMapPage{
    text("client_id", kMaxClientIdLength), fixed("request_id", kInt64), fixed("status", kInt32),
    text("message", kMaxTextBytes),        fixed("page", kInt32),       fixed("num_pages", kInt32),
    fixed("page_checksum", kInt64),        list("bytes", kByte),
};

constexpr std::array kOccupancyRequest{
    text("client_id", kMaxClientIdLength),
    fixed("request_id", kInt64),
    fixed("utime", kInt64),
    text("scene", kMaxSceneNameBytes),
    fixed("deadline_s", kDouble),
    list("points_m", 3 * kDouble),
    list("boxes_m", 6 * kDouble),
    list("spheres_m", 4 * kDouble),
    list("rays_m", 7 * kDouble),
    list("distances_m", 4 * kDouble),
    list("sphere_paths_m", 7 * kDouble),
};

constexpr std::array kOccupancyResponse{
    text("client_id", kMaxClientIdLength),
    fixed("request_id", kInt64),
    fixed("utime", kInt64),
    fixed("status", kInt32),
    text("message", kMaxTextBytes),
    text("scene", kMaxSceneNameBytes),
    fixed("scene_revision", kInt64),
    fixed("resolution_m", kDouble),
    list("points_occupied", kByte),
    list("boxes_occupied", kByte),
    list("spheres_occupied", kByte),
    list("rays_hit_m", kDouble),
    list("distances_m", kDouble),
    list("sphere_paths_hit_m", kDouble),
};

constexpr std::array kSceneInfo{
    text("name", kMaxSceneNameBytes), fixed("revision", kInt64),
    text("digest", kMaxDigestBytes),  fixed("num_triangles", kInt64),
    fixed("bounds_m", 6 * kDouble),   fixed("occupancy_resolution_m", kDouble),
};

constexpr std::array kSceneObject{
    text("name", kMaxObjectNameBytes), text("kind", kMaxKindBytes), text("digest", kMaxDigestBytes),
    fixed("num_triangles", kInt64),    fixed("pose", 7 * kDouble),  fixed("bounds_m", 6 * kDouble),
};

constexpr std::array kSceneChange{
    fixed("revision", kInt64),
    fixed("utime", kInt64),
    text("operation", kMaxOperationBytes),
    text("object", kMaxObjectNameBytes),
    text("client_id", kMaxClientIdLength),
    fixed("restored_revision", kInt64),
};

constexpr std::array kSceneRequest{
    text("client_id", kMaxClientIdLength),
    fixed("request_id", kInt64),
    fixed("utime", kInt64),
    fixed("operation", kByte),
    text("scene", kMaxSceneNameBytes),
    text("object", kMaxObjectNameBytes),
    text("file", kMaxFileNameBytes),
    fixed("upload", 2 * kInt64),
    text("upload_format", kMaxFormatBytes),
    fixed("scale", kDouble),
    fixed("up", kByte),
    fixed("unknown", kByte),
    fixed("occupancy_resolution_m", kDouble),
    fixed("kind", kByte),
    fixed("shape", 7 * kDouble),
    fixed("sensor", 5 * kDouble),
    fixed("pose", 7 * kDouble),
    fixed("first", kInt32),
    fixed("revision", kInt64),
    text("restore_as", kMaxSceneNameBytes),
    fixed("deadline_s", kDouble),
};

constexpr std::array kSceneResponse{
    text("client_id", kMaxClientIdLength),
    fixed("request_id", kInt64),
    fixed("utime", kInt64),
    fixed("status", kInt32),
    text("message", kMaxTextBytes),
    text("scene.name", kMaxSceneNameBytes),
    fixed("scene.revision", kInt64),
    text("scene.digest", kMaxDigestBytes),
    fixed("scene.num_triangles", kInt64),
    fixed("scene.bounds_m", 6 * kDouble),
    fixed("scene.occupancy_resolution_m", kDouble),
    fixed("first", kInt32),
    fixed("total", kInt32),
    fixed("map", 2 * kInt64),
    list_of("scenes", kSceneInfo),
    list_of("objects", kSceneObject),
    list_of("changes", kSceneChange),
};

constexpr std::array kUploadPage{
    text("client_id", kMaxClientIdLength),
    fixed("request_id", kInt64),
    fixed("utime", kInt64),
    fixed("upload", 2 * kInt64),
    fixed("page", kInt32),
    fixed("page_checksum", kInt64),
    list("bytes", kByte),
};

constexpr std::array kUploadStatus{
    text("client_id", kMaxClientIdLength),
    fixed("request_id", kInt64),
    fixed("utime", kInt64),
    fixed("status", kInt32),
    text("message", kMaxTextBytes),
    fixed("upload", 2 * kInt64),
    fixed("total_missing", kInt32),
    list("missing", kInt32),
};

constexpr std::array kWatch{
    text("client_id", kMaxClientIdLength),
    fixed("request_id", kInt64),
    fixed("utime", kInt64),
    fixed("lease_s", kDouble),
    list("paths", kWatchedPath),
};

constexpr std::array kWatchReport{
    text("client_id", kMaxClientIdLength),
    fixed("request_id", kInt64),
    fixed("utime", kInt64),
    text("message", kMaxTextBytes),
    list("paths", kPathState),
    list("intervals", kBrokenInterval),
};

constexpr std::size_t kStatusCounters = 21;
constexpr std::size_t kAnswerCounts = 3 * 16;

constexpr std::array kStatus{
    fixed("utime", kInt64),
    text("version", kMaxVersionBytes),
    fixed("uptime_s", kDouble),
    fixed("num_workers", kInt32),
    fixed("queued_requests", kInt32),
    fixed("running_requests", kInt32),
    fixed("counters", kStatusCounters* kInt64),
    fixed("answers", kAnswerCounts* kInt64),
    fixed("receipt_to_answer", kInt64 + kDouble),
    list("receipt_to_answer.buckets", kInt64),
    fixed("waiting", kInt64 + kDouble),
    list("waiting.buckets", kInt64),
    fixed("planning", kInt64 + kDouble),
    list("planning.buckets", kInt64),
    fixed("watched_paths", kInt32),
    fixed("broken_paths", kInt64),
    fixed("signed_only", kByte),
    fixed("total_scenes", kInt32),
    list_of("scenes", kSceneInfo),
};

constexpr std::array kError{
    fixed("utime", kInt64),
    text("channel", kMaxChannelLength),
    fixed("size_bytes", kInt64),
    text("message", kMaxTextBytes),
};

constexpr std::size_t kEnvelopeHead = kInt32 + 3 * kInt64 + sizeof(envelope_t::tag);
constexpr std::array kEnvelope{fixed("head", kEnvelopeHead), list("payload", kByte)};
// Fingerprint and count of the payload beside it.
static_assert(kMaxMessageBytes + kInt64 + kEnvelopeHead + kInt32 <= kMaxEnvelopeBytes);

}  // namespace

template <>
Layout layout_of<envelope_t>() {
  return {"envelope_t", envelope_t::getHash(), kEnvelope, kMaxEnvelopeBytes};
}
template <>
Layout layout_of<plan_request_t>() {
  return {"plan_request_t", plan_request_t::getHash(), kPlanRequest};
}
template <>
Layout layout_of<plan_response_t>() {
  return {"plan_response_t", plan_response_t::getHash(), kPlanResponse};
}
template <>
Layout layout_of<cancel_t>() {
  return {"cancel_t", cancel_t::getHash(), kCancel};
}
template <>
Layout layout_of<plan_progress_t>() {
  return {"plan_progress_t", plan_progress_t::getHash(), kPlanProgress};
}
template <>
Layout layout_of<missing_pages_t>() {
  return {"missing_pages_t", missing_pages_t::getHash(), kMissingPages};
}
template <>
Layout layout_of<map_page_t>() {
  return {"map_page_t", map_page_t::getHash(), kMapPage};
}
template <>
Layout layout_of<occupancy_request_t>() {
  return {"occupancy_request_t", occupancy_request_t::getHash(), kOccupancyRequest};
}
template <>
Layout layout_of<occupancy_response_t>() {
  return {"occupancy_response_t", occupancy_response_t::getHash(), kOccupancyResponse};
}
template <>
Layout layout_of<scene_request_t>() {
  return {"scene_request_t", scene_request_t::getHash(), kSceneRequest};
}
template <>
Layout layout_of<scene_response_t>() {
  return {"scene_response_t", scene_response_t::getHash(), kSceneResponse};
}
template <>
Layout layout_of<upload_page_t>() {
  return {"upload_page_t", upload_page_t::getHash(), kUploadPage};
}
template <>
Layout layout_of<upload_status_t>() {
  return {"upload_status_t", upload_status_t::getHash(), kUploadStatus};
}
template <>
Layout layout_of<watch_t>() {
  return {"watch_t", watch_t::getHash(), kWatch};
}
template <>
Layout layout_of<watch_report_t>() {
  return {"watch_report_t", watch_report_t::getHash(), kWatchReport};
}
template <>
Layout layout_of<status_t>() {
  return {"status_t", status_t::getHash(), kStatus};
}
template <>
Layout layout_of<error_t>() {
  return {"error_t", error_t::getHash(), kError};
}

}  // namespace camway::wire
