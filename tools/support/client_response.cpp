// SPDX-License-Identifier: MIT
#include "tools/support/client_response.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

namespace camway::tools {
namespace {

using geometry::Vec3;
using geometry::Vec4;

static_assert(static_cast<int>(Status::kInternalError) ==
              static_cast<int>(planning::Status::kInternalError));
static_assert(static_cast<int>(Correction::Method::kShrink) ==
              static_cast<int>(correction::CorrectionKind::kShrink));

Vec3 point_of(const std::array<double, 3>& sent) { return {sent[0], sent[1], sent[2]}; }
Vec4 four_of(const std::array<double, 4>& sent) { return {sent[0], sent[1], sent[2], sent[3]}; }
geometry::Quat turn_of(const std::array<double, 4>& sent) {
  return geometry::from_wxyz(four_of(sent));
}

/// No index is -1.
std::optional<std::size_t> index_of(std::int32_t sent) {
  if (sent < 0) return std::nullopt;
  return static_cast<std::size_t>(sent);
}

motion::Path path_of(const Path& sent) {
  std::vector<motion::Segment> segments;
  for (const Segment& each : sent.segments()) {
    motion::Segment& segment = segments.emplace_back();
    segment.t0_s = each.t0_s;
    segment.t1_s = each.t1_s;
    std::ranges::transform(each.position_m, segment.position.begin(), point_of);
    std::ranges::transform(each.orientation_wxyz, segment.orientation.begin(), four_of);
  }
  return segments.empty() ? motion::Path() : motion::Path(std::move(segments));
}

motion::Keyframe keyframe_of(const PathKeyframe& sent) {
  motion::Keyframe keyframe;
  keyframe.time_s = sent.time_s;
  keyframe.pose = {point_of(sent.position_m), turn_of(sent.orientation_wxyz)};
  keyframe.origin =
      sent.inserted ? motion::KeyframeOrigin::kInserted : motion::KeyframeOrigin::kGiven;
  keyframe.is_repaired = sent.repaired;
  keyframe.image = four_of(sent.image);
  return keyframe;
}

motion::PathEnd end_of(const PathEnd& sent) {
  return {point_of(sent.velocity_m_per_s), four_of(sent.image_rate_per_s)};
}

motion::PathFrame frame_of(const PathFrame& sent) {
  return {four_of(sent.reference_wxyz), end_of(sent.begin), end_of(sent.end)};
}

void take_collisions(const std::vector<CollisionInterval>& sent,
                     std::vector<collision::CollisionInterval>& collisions,
                     std::vector<planning::WitnessNames>& names) {
  for (const CollisionInterval& each : sent) {
    collision::CollisionInterval& mine = collisions.emplace_back();
    mine.t_begin_s = each.t_begin_s;
    mine.t_end_s = each.t_end_s;
    planning::WitnessNames& name = names.emplace_back();
    if (!each.witness) continue;
    collision::Witness& witness = mine.witness.emplace();
    witness.time_s = each.witness->time_s;
    // Sides of the bounds are negative on the wire, and at the end of the range in memory.
    witness.triangle = static_cast<std::uint32_t>(each.witness->triangle);
    witness.depth_m = each.witness->depth_m;
    witness.point_W = point_of(each.witness->point_m);
    name = {each.witness->object, each.witness->feature};
  }
}

correction::Correction correction_of(const Correction& sent) {
  correction::Correction mine;
  mine.interval.t_begin_s = sent.t_begin_s;
  mine.interval.t_end_s = sent.t_end_s;
  mine.kind = static_cast<correction::CorrectionKind>(sent.method);
  mine.t_begin_s = sent.changed_t_begin_s;
  mine.t_end_s = sent.changed_t_end_s;
  mine.moved_m = sent.moved_m;
  mine.turned_rad = sent.turned_rad;
  mine.shift = {sent.largest_shift_rad, sent.mean_shift_rad};
  mine.tried = {sent.tried.directions, sent.tried.paths, sent.tried.lattice_points,
                sent.tried.tree_samples};
  return mine;
}

motion::PathMeasures measures_of(const PathMeasures& sent) {
  motion::PathMeasures mine;
  mine.length_m = sent.length_m;
  mine.largest_deviation_m = sent.largest_deviation_m;
  mine.largest_shift_rad = sent.largest_shift_rad;
  mine.mean_shift_rad = sent.mean_shift_rad;
  mine.bending_energy_m2_per_s3 = sent.bending_energy_m2_per_s3;
  mine.largest_speed_m_per_s = sent.largest_speed_m_per_s;
  mine.largest_acceleration_m_per_s2 = sent.largest_acceleration_m_per_s2;
  mine.largest_turn_rate_rad_per_s = sent.largest_turn_rate_rad_per_s;
  mine.largest_turn_acceleration_rad_per_s2 = sent.largest_turn_acceleration_rad_per_s2;
  mine.clearance_lower_bound_m = sent.clearance_lower_bound_m;
  return mine;
}

planning::KeyframeFault fault_of_keyframe(const KeyframeFault& sent) {
  planning::KeyframeFault fault;
  fault.keyframe = static_cast<std::size_t>(std::max(sent.keyframe, 0));
  fault.depth_m = sent.depth_m;
  if (sent.free_pose) {
    fault.free_pose = motion::Pose{point_of(sent.free_pose->position_m),
                                   turn_of(sent.free_pose->orientation_wxyz)};
  }
  return fault;
}

planning::Infeasibility proof_of(const Infeasibility& sent) {
  planning::Infeasibility proof;
  proof.keyframe_inside = static_cast<std::size_t>(std::max(sent.keyframe_inside, 0));
  proof.keyframe_outside = static_cast<std::size_t>(std::max(sent.keyframe_outside, 0));
  proof.triangles.assign(sent.triangles.begin(), sent.triangles.end());
  if (!sent.cage) return proof;
  correction::CageBox& cage = proof.cage.emplace();
  cage.box = geometry::Box(point_of(sent.cage->min_m), point_of(sent.cage->max_m));
  cage.orientation = turn_of(sent.cage->orientation_wxyz);
  cage.widest_hole_m = sent.cage->widest_hole_m;
  cage.shortest_chord_m = sent.cage->shortest_chord_m;
  return proof;
}

/// The members of the answer that say of the path what was proved, measured and slowed.
void take_report(const PlanResponse& response, planning::PlanResult& result) {
  result.certificate = {response.certified, response.clearance_lower_bound_m};
  std::ranges::transform(response.corrections, std::back_inserter(result.corrections),
                         correction_of);
  if (response.measures_before) result.measures_before = measures_of(*response.measures_before);
  if (response.measures) result.measures = measures_of(*response.measures);
  if (response.viewing_distance_m > 0.0) result.viewing_distance_m = response.viewing_distance_m;
  result.bounds = geometry::bounds_of({response.bounds.min_m, response.bounds.max_m});
  result.near_scale = response.near_scale;
  result.time_scale = response.time_scale;
  for (const SlowedStretch& each : response.slowed) {
    result.slowed.push_back(
        {each.t_begin_s, each.t_end_s, each.given_t_begin_s, each.given_t_end_s});
  }
  for (const ClearanceStretch& each : response.clearance_profile) {
    result.clearance_profile.push_back({each.t_begin_s, each.t_end_s, each.clearance_m});
  }
  std::ranges::transform(response.keyframe_faults, std::back_inserter(result.keyframe_faults),
                         fault_of_keyframe);
  if (response.infeasibility) result.infeasibility = proof_of(*response.infeasibility);
  result.deadline_reached = response.deadline_reached;
  const PlanTiming& timing = response.timing;
  result.timing = {0.0,
                   timing.motion_ms,
                   timing.detect_ms,
                   timing.correct_ms,
                   timing.certify_ms,
                   timing.total_ms};
}

}  // namespace

bool has_result(Status status) {
  return static_cast<int>(status) >= static_cast<int>(Status::kOk) &&
         static_cast<int>(status) <= static_cast<int>(Status::kInternalError);
}

planning::PlanResult to_plan_result(const PlanResponse& response) {
  planning::PlanResult result;
  result.status = static_cast<planning::Status>(response.status);
  result.message = response.message;
  result.keyframe = index_of(response.keyframe);
  result.path = path_of(response.path);
  std::ranges::transform(response.keyframes, std::back_inserter(result.keyframes), keyframe_of);
  if (response.frame) result.frame = frame_of(*response.frame);
  take_collisions(response.collisions, result.collisions, result.collision_names);
  take_collisions(response.remaining, result.remaining_collisions, result.remaining_names);
  take_report(response, result);
  return result;
}

}  // namespace camway::tools
