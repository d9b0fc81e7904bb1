// SPDX-License-Identifier: MIT
#include "client/messages/plan_members.h"

#include "client/messages/body.h"
#include "client/messages/constraints.h"
#include "client/messages/members.h"

namespace camway {
namespace {

static_assert(static_cast<int>(Correction::Method::kShrink) == correction_t::SHRINK);
static_assert(static_cast<int>(PlanProgress::Stage::kCertifying) == plan_progress_t::CERTIFYING);
static_assert(static_cast<int>(Priority::kLow) == plan_request_t::LOW);

}  // namespace

void put(const Keyframe& mine, keyframe_t& wire) {
  static_assert(wire::lacks_only<keyframe_t, Keyframe>({"origin", "repaired"}));
  put_common(mine, wire);
}

void put(const PlanRequest& mine, plan_request_t& wire) {
  static_assert(wire::lacks_only<plan_request_t, PlanRequest>(
      {"client_id", "utime", "page", "num_pages", "correct_nothing", "has_times", "has_frame"}));
  put_common(mine, wire);
  wire.correct_nothing = mine.max_inserted_keyframes == 0 ? 1 : 0;
  wire.has_times = !mine.keyframes.empty() && mine.keyframes.front().time_s ? 1 : 0;
  wire.has_frame = mine.frame ? 1 : 0;
  wire::set_counts(wire);
}

void read(const keyframe_t& wire, PathKeyframe& mine) {
  static_assert(wire::lacks_only<keyframe_t, PathKeyframe>({"origin"}));
  read_common(wire, mine);
  mine.inserted = wire.origin == keyframe_t::ORIGIN_INSERTED;
}

void read(const collision_interval_t& wire, CollisionInterval& mine) {
  mine.t_begin_s = wire.t_begin_s;
  mine.t_end_s = wire.t_end_s;
  if (wire.has_witness == 0) return;
  mine.witness = Witness{wire.witness_time_s,  wire.witness_object,  wire.witness_triangle,
                         wire.witness_feature, wire.witness_depth_m, {}};
  read(wire.witness_point_m, mine.witness->point_m);
}

void read(const correction_t& wire, Correction& mine) {
  static_assert(wire::lacks_only<correction_t, Correction>(
      {"tried_directions", "tried_paths", "tried_lattice_points", "tried_tree_samples"}));
  read_common(wire, mine);
  mine.tried = {wire.tried_directions, wire.tried_paths, wire.tried_lattice_points,
                wire.tried_tree_samples};
}

void read(const keyframe_fault_t& wire, KeyframeFault& mine) {
  static_assert(wire::lacks_only<keyframe_fault_t, KeyframeFault>(
      {"has_free_pose", "free_position_m", "free_orientation_wxyz"}));
  read_common(wire, mine);
  if (wire.has_free_pose == 0) return;
  read(wire.free_position_m, mine.free_pose.emplace().position_m);
  read(wire.free_orientation_wxyz, mine.free_pose->orientation_wxyz);
}

void read(const plan_response_t& wire, PlanResponse& mine) {
  static_assert(wire::lacks_only<plan_response_t, PlanResponse>(
      {"client_id", "utime", "page", "num_pages", "has_measures_before", "has_measures",
       "has_infeasibility", "keyframe_inside", "keyframe_outside", "has_cage", "proof_cage",
       "motion_ms", "detect_ms", "correct_ms", "certify_ms", "total_ms", "segments",
       "proof_triangles", "has_frame"}));
  read_common(wire, mine);
  read_common(wire, mine.timing);
  if (wire.has_frame == 0) mine.frame.reset();
  if (wire.has_measures_before == 0) mine.measures_before.reset();
  if (wire.has_measures == 0) mine.measures.reset();
  if (wire.has_infeasibility == 0) return;
  read_common(wire, mine.infeasibility.emplace());
  mine.infeasibility->triangles = wire.proof_triangles;
  if (wire.has_cage != 0) read(wire.proof_cage, mine.infeasibility->cage);
}

void read(const plan_progress_t& wire, PlanProgress& mine) {
  static_assert(
      wire::lacks_only<plan_progress_t, PlanProgress>({"client_id", "request_id", "utime"}));
  read_common(wire, mine);
  const bool is_known =
      wire.stage >= plan_progress_t::WAITING && wire.stage <= plan_progress_t::CERTIFYING;
  if (!is_known) mine.stage = PlanProgress::Stage::kWaiting;
}

}  // namespace camway
