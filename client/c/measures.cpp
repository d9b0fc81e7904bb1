// SPDX-License-Identifier: MIT
#include <camway/camway.h>
#include <camway/plan.h>

#include <optional>

#include "client/c/handles.h"
#include "client/c/lists.h"
#include "client/c/sized.h"

namespace camway::c {
namespace {

static_assert(CAMWAY_CORRECTION_SHRINK == static_cast<int>(Correction::Method::kShrink));

camway_status write_measures(const std::optional<PathMeasures>& from,
                             camway_path_measures* measures, std::size_t struct_size) {
  if (!from) throw Refusal{CAMWAY_INVALID, "the answer has no such measures"};
  camway_path_measures made{};
  made.length_m = from->length_m;
  made.largest_deviation_m = from->largest_deviation_m;
  made.largest_shift_rad = from->largest_shift_rad;
  made.mean_shift_rad = from->mean_shift_rad;
  made.bending_energy_m2_per_s3 = from->bending_energy_m2_per_s3;
  made.largest_speed_m_per_s = from->largest_speed_m_per_s;
  made.largest_acceleration_m_per_s2 = from->largest_acceleration_m_per_s2;
  made.largest_turn_rate_rad_per_s = from->largest_turn_rate_rad_per_s;
  made.largest_turn_acceleration_rad_per_s2 = from->largest_turn_acceleration_rad_per_s2;
  made.clearance_m = from->clearance_lower_bound_m;
  write_sized(made, measures, struct_size);
  return CAMWAY_OK;
}

camway_correction correction_of(const Correction& from) {
  camway_correction correction{};
  correction.method = static_cast<std::int32_t>(from.method);
  correction.t_begin_s = from.t_begin_s;
  correction.t_end_s = from.t_end_s;
  correction.changed_t_begin_s = from.changed_t_begin_s;
  correction.changed_t_end_s = from.changed_t_end_s;
  correction.moved_m = from.moved_m;
  correction.turned_rad = from.turned_rad;
  correction.largest_shift_rad = from.largest_shift_rad;
  correction.mean_shift_rad = from.mean_shift_rad;
  return correction;
}

camway_slowed_stretch slowed_of(const SlowedStretch& from) {
  return {from.t_begin_s, from.t_end_s, from.given_t_begin_s, from.given_t_end_s};
}

camway_clearance_stretch clearance_of(const ClearanceStretch& from) {
  return {from.t_begin_s, from.t_end_s, from.clearance_m};
}

camway_plan_timing timing_of(const PlanTiming& from) {
  camway_plan_timing timing{};
  timing.motion_ms = from.motion_ms;
  timing.detect_ms = from.detect_ms;
  timing.correct_ms = from.correct_ms;
  timing.certify_ms = from.certify_ms;
  timing.total_ms = from.total_ms;
  return timing;
}

}  // namespace
}  // namespace camway::c

using namespace camway::c;

camway_status camway_answer_measures(const camway_answer* answer, camway_path_measures* measures,
                                     size_t struct_size) {
  return guarded(
      [&] { return write_measures(Handles::all().find(answer)->measures, measures, struct_size); });
}

camway_status camway_answer_measures_before(const camway_answer* answer,
                                            camway_path_measures* measures, size_t struct_size) {
  return guarded([&] {
    return write_measures(Handles::all().find(answer)->measures_before, measures, struct_size);
  });
}

camway_status camway_answer_corrections(const camway_answer* answer, camway_correction* corrections,
                                        size_t capacity, size_t* count) {
  return guarded([&] {
    return write_list(Handles::all().find(answer)->corrections, corrections, capacity, count,
                      correction_of);
  });
}

camway_status camway_answer_slowed(const camway_answer* answer, camway_slowed_stretch* slowed,
                                   size_t capacity, size_t* count) {
  return guarded([&] {
    return write_list(Handles::all().find(answer)->slowed, slowed, capacity, count, slowed_of);
  });
}

camway_status camway_answer_clearance_profile(const camway_answer* answer,
                                              camway_clearance_stretch* stretches, size_t capacity,
                                              size_t* count) {
  return guarded([&] {
    return write_list(Handles::all().find(answer)->clearance_profile, stretches, capacity, count,
                      clearance_of);
  });
}

camway_status camway_answer_timing(const camway_answer* answer, camway_plan_timing* timing,
                                   size_t struct_size) {
  return guarded([&] {
    write_sized(timing_of(Handles::all().find(answer)->timing), timing, struct_size);
    return CAMWAY_OK;
  });
}
