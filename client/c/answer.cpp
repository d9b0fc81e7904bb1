// SPDX-License-Identifier: MIT
#include "client/c/answer.h"

#include <algorithm>
#include <limits>

#include "client/c/handles.h"
#include "client/c/lists.h"
#include "client/c/sized.h"

namespace camway::c {
namespace {

constexpr double kNoBound_m = std::numeric_limits<double>::infinity();

camway_segment segment_of(const Segment& from) {
  camway_segment segment{};
  segment.t0_s = from.t0_s;
  segment.t1_s = from.t1_s;
  for (std::size_t i = 0; i < from.position_m.size(); ++i) {
    std::copy(from.position_m[i].begin(), from.position_m[i].end(), segment.position_m[i]);
  }
  for (std::size_t i = 0; i < from.orientation_wxyz.size(); ++i) {
    std::copy(from.orientation_wxyz[i].begin(), from.orientation_wxyz[i].end(),
              segment.orientation_wxyz[i]);
  }
  return segment;
}

camway_path_keyframe keyframe_of(const PathKeyframe& from) {
  camway_path_keyframe keyframe{};
  keyframe.time_s = from.time_s;
  std::copy(from.position_m.begin(), from.position_m.end(), keyframe.position_m);
  std::copy(from.orientation_wxyz.begin(), from.orientation_wxyz.end(), keyframe.orientation_wxyz);
  keyframe.inserted = from.inserted;
  keyframe.repaired = from.repaired;
  return keyframe;
}

camway_keyframe_fault fault_of(const KeyframeFault& from) {
  camway_keyframe_fault fault{};
  fault.keyframe = from.keyframe;
  fault.depth_m = from.depth_m;
  if (from.free_pose) {
    fault.has_free_pose = 1;
    std::copy_n(from.free_pose->position_m.begin(), 3, fault.free_pose.position_m);
    std::copy_n(from.free_pose->orientation_wxyz.begin(), 4, fault.free_pose.orientation_wxyz);
  }
  return fault;
}

camway_answer_summary summary_of(const PlanResponse& from) {
  camway_answer_summary summary{};
  summary.status = static_cast<camway_status>(from.status);
  summary.certified = from.certified;
  summary.deadline_reached = from.deadline_reached;
  summary.keyframe = from.keyframe;
  summary.corrected = static_cast<std::int32_t>(std::count_if(
      from.corrections.begin(), from.corrections.end(),
      [](const Correction& correction) { return correction.method != Correction::Method::kNone; }));
  summary.request_id = from.request_id;
  summary.scene_revision = from.scene_revision;
  summary.begin_s = from.path.begin();
  summary.end_s = from.path.end();
  summary.clearance_m = from.clearance_lower_bound_m;
  summary.near_scale = from.near_scale;
  summary.time_scale = from.time_scale;
  summary.elapsed_s = from.elapsed_s;
  summary.viewing_distance_m = from.viewing_distance_m;
  return summary;
}

void evaluate(const Path& path, const double* times_s, std::size_t count, double* positions_m,
              double* orientations_wxyz) {
  for (std::size_t i = 0; i < count; ++i) {
    const Pose pose = path.pose(times_s[i]);
    if (positions_m != nullptr) std::copy_n(pose.position_m.begin(), 3, positions_m + 3 * i);
    if (orientations_wxyz != nullptr) {
      std::copy_n(pose.orientation_wxyz.begin(), 4, orientations_wxyz + 4 * i);
    }
  }
}

}  // namespace

camway_collision collision_of(const CollisionInterval& from) {
  camway_collision collision{};
  collision.t_begin_s = from.t_begin_s;
  collision.t_end_s = from.t_end_s;
  collision.object = "";
  if (from.witness) {
    collision.has_witness = 1;
    collision.triangle = from.witness->triangle;
    collision.time_s = from.witness->time_s;
    collision.depth_m = from.witness->depth_m;
    std::copy_n(from.witness->point_m.begin(), 3, collision.point_m);
    collision.object = from.witness->object.c_str();
  }
  return collision;
}

}  // namespace camway::c

using namespace camway::c;

camway_status camway_answer_free(camway_answer* answer) {
  return guarded([&] {
    Handles::all().take(answer);
    return CAMWAY_OK;
  });
}

camway_status camway_answer_copy(const camway_answer* answer, camway_answer** copy) {
  return guarded([&] {
    require(copy, "copy");
    *copy = nullptr;
    *copy = Handles::all().add<camway_answer>(Handles::all().find(answer));
    return CAMWAY_OK;
  });
}

camway_status camway_answer_summarize(const camway_answer* answer, camway_answer_summary* summary,
                                      size_t struct_size) {
  return guarded([&] {
    write_sized(summary_of(*Handles::all().find(answer)), summary, struct_size);
    return CAMWAY_OK;
  });
}

const char* camway_answer_error(const camway_answer* answer) {
  return guarded_text([&] { return Handles::all().find(answer)->error.c_str(); });
}

const char* camway_answer_message(const camway_answer* answer) {
  return guarded_text([&] { return Handles::all().find(answer)->message.c_str(); });
}

camway_status camway_answer_bounds(const camway_answer* answer, double min_m[3], double max_m[3]) {
  return guarded([&] {
    const auto found = Handles::all().find(answer);
    require(min_m, "min_m");
    require(max_m, "max_m");
    for (std::size_t i = 0; i < 3; ++i) {
      min_m[i] = found->bounds.min_m[i].value_or(-kNoBound_m);
      max_m[i] = found->bounds.max_m[i].value_or(kNoBound_m);
    }
    return CAMWAY_OK;
  });
}

camway_status camway_answer_poses(const camway_answer* answer, const double* times_s, size_t count,
                                  double* positions_m, double* orientations_wxyz) {
  return guarded([&]() -> camway_status {
    const auto found = Handles::all().find(answer);
    require_array(times_s, count, "times_s");
    if (found->path.empty()) throw Refusal{CAMWAY_INVALID, "the answer has no path"};
    evaluate(found->path, times_s, count, positions_m, orientations_wxyz);
    return CAMWAY_OK;
  });
}

camway_status camway_answer_segments(const camway_answer* answer, camway_segment* segments,
                                     size_t capacity, size_t* count) {
  return guarded([&] {
    return write_list(Handles::all().find(answer)->path.segments(), segments, capacity, count,
                      segment_of);
  });
}

camway_status camway_answer_keyframes(const camway_answer* answer, camway_path_keyframe* keyframes,
                                      size_t capacity, size_t* count) {
  return guarded([&] {
    return write_list(Handles::all().find(answer)->keyframes, keyframes, capacity, count,
                      keyframe_of);
  });
}

camway_status camway_answer_collisions(const camway_answer* answer, camway_collision* collisions,
                                       size_t capacity, size_t* count) {
  return guarded([&] {
    return write_list(Handles::all().find(answer)->collisions, collisions, capacity, count,
                      collision_of);
  });
}

camway_status camway_answer_remaining(const camway_answer* answer, camway_collision* collisions,
                                      size_t capacity, size_t* count) {
  return guarded([&] {
    return write_list(Handles::all().find(answer)->remaining, collisions, capacity, count,
                      collision_of);
  });
}

camway_status camway_answer_keyframe_faults(const camway_answer* answer,
                                            camway_keyframe_fault* faults, size_t capacity,
                                            size_t* count) {
  return guarded([&] {
    return write_list(Handles::all().find(answer)->keyframe_faults, faults, capacity, count,
                      fault_of);
  });
}
