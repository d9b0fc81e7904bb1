// SPDX-License-Identifier: MIT
#include "client/messages/plan.h"

#include "client/messages/convert.h"
#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/layout.h"
#include "lcmtypes/wire/utime.h"

namespace camway {
namespace {

static_assert(static_cast<int>(Body::Shape::kSolidMesh) == body_t::SOLID_MESH);
static_assert(static_cast<int>(Correction::Method::kShrink) == correction_t::SHRINK);
static_assert(static_cast<int>(Objective::kSafest) == plan_request_t::SAFEST);
static_assert(static_cast<int>(Orientation::Policy::kTarget) == orientation_t::TARGET);
static_assert(static_cast<int>(PlanProgress::Stage::kCertifying) == plan_progress_t::CERTIFYING);
static_assert(static_cast<int>(Priority::kLow) == plan_request_t::LOW);

bool has_times(const PlanRequest& request) {
  return !request.keyframes.empty() && request.keyframes.front().time_s.has_value();
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
  } else if (mine.shape == Body::Shape::kMesh || mine.shape == Body::Shape::kSolidMesh) {
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

std::vector<wire::Bytes> to_pages(const PlanRequest& request, const std::string& client_id,
                                  std::int64_t request_id) {
  plan_request_t wire{};
  convert(request, wire);
  wire.client_id = client_id;
  wire.request_id = request_id;
  wire.utime = wire::utime_now();
  return wire::encode_pages(wire);
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

}  // namespace camway
