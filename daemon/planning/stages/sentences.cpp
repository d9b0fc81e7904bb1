// SPDX-License-Identifier: MIT
#include "daemon/planning/stages/sentences.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "daemon/planning/stages/keyframe_faults.h"
#include "daemon/planning/stages/keyframe_times.h"

namespace camway::planning {

namespace {

using correction::Correction;
using correction::Effort;
using correction::ShutIn;

constexpr std::size_t kMostNamed = 5;  // keyframes

// Cameras are seldom rolled by so much: 30 degrees.
constexpr double kNotableTilt_rad = 0.5236;

// A body of fewer interval tolerances gets a note.
constexpr double kLeastTolerances = 10.0;

std::size_t inserted_keyframes(const PlanResult& result) {
  return static_cast<std::size_t>(std::ranges::count(
      result.keyframes, motion::KeyframeOrigin::kInserted, &motion::Keyframe::origin));
}

void add(std::string& list, std::string_view item) {
  if (!list.empty()) list += ", ";
  list += item;
}

/// "1, 4, 7 and 2 more", from the keyframe of index `first` on.
std::string listed(const std::vector<ShutIn>& shut_in, std::size_t first) {
  std::string list;
  for (std::size_t i = first; i < shut_in.size() && i < kMostNamed; ++i)
    add(list, std::to_string(shut_in[i].keyframe));
  if (shut_in.size() > kMostNamed) list += fmt::format(" and {} more", shut_in.size() - kMostNamed);
  return list;
}

std::string note_of_complete(const std::vector<ShutIn>& shut_in, bool is_bounded) {
  if (shut_in.empty()) return {};
  const geometry::Vec3 sizes_m = shut_in.front().region_W.sizes();
  std::string note = fmt::format(
      "; keyframe {} seems shut in: no way out of a region of {:.2g} x {:.2g} x {:.2g} m about it "
      "was found{}",
      shut_in.front().keyframe, sizes_m.x(), sizes_m.y(), sizes_m.z(),
      is_bounded ? " within the bounds" : "");
  if (shut_in.size() > 1) note += "; and so do " + listed(shut_in, 1);
  return note;
}

std::string note_of_not_left(const std::vector<ShutIn>& shut_in) {
  if (shut_in.empty()) return {};
  const bool is_one = shut_in.size() == 1;
  return fmt::format("; no search found a way out of the place{} where keyframe{} {} {}",
                     is_one ? "" : "s", is_one ? "" : "s", listed(shut_in, 0),
                     is_one ? "is" : "are");
}

}  // namespace

std::string counted(std::size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string rounded_down(double value) {
  if (!(value > 0.0)) return "0";
  const double scale = std::pow(10.0, 2.0 - std::floor(std::log10(value)));
  return fmt::format("{:.3g}", std::floor(value * scale) / scale);
}

std::string what_was_done(const PlanResult& result) {
  std::string text = result.collisions.empty()
                         ? "no collision to correct"
                         : counted(result.collisions.size(), "collision") + " at first";
  const std::size_t inserted = inserted_keyframes(result);
  if (inserted > 0) text += fmt::format(", {} inserted", counted(inserted, "keyframe"));
  const std::size_t repaired = result.keyframe_faults.size();
  if (repaired > 0) text += fmt::format(", {} repaired", counted(repaired, "keyframe"));
  return text;
}

std::string effort_text(const Effort& effort) {
  std::string text;
  const auto add_some = [&](std::int32_t count, std::string_view noun, std::string_view what_for) {
    if (count == 0) return;
    add(text, counted(static_cast<std::size_t>(count), noun) + std::string(what_for));
  };
  add_some(effort.directions, "direction", " to move or turn in");
  add_some(effort.paths, "changed path", "");
  add_some(effort.lattice_points, "place", " on a way round");
  add_some(effort.tree_samples, "pose", " on a way round that turns");
  return text;
}

std::string note_of_effort(const std::vector<Correction>& corrections) {
  Effort sum;
  for (const Correction& correction : corrections) {
    if (correction.kind == correction::CorrectionKind::kNone) sum += correction.tried;
  }
  const std::string text = effort_text(sum);
  return text.empty() ? text : "; tried without success: " + text;
}

std::string note_of_shut_in(const std::vector<ShutIn>& shut_in, bool is_bounded) {
  std::vector<ShutIn> complete = shut_in;
  // Not std::ranges::stable_partition: Clang 14 cannot compile that of GCC 12's library.
  const auto others = std::stable_partition(complete.begin(), complete.end(),
                                            [](const ShutIn& shut) { return shut.is_complete; });
  const std::vector<ShutIn> not_left(others, complete.end());
  complete.erase(others, complete.end());
  return note_of_complete(complete, is_bounded) + note_of_not_left(not_left);
}

std::string note_of_method(const PlanRequest& request) {
  if (request.options.method != Method::kKeyframeInsertion) return {};
  const PlanOptions usual;
  std::string unused;
  const auto add_name = [&](std::string_view path) { add(unused, request.name_of(path)); };
  if (request.options.objective != usual.objective) add_name("options.objective");
  if (!(request.options.orientation == usual.orientation)) add_name("options.orientation");
  if (request.options.seed != usual.seed) add_name("options.seed");
  if (request.options.viewing_distance_m) add_name("options.viewing_distance_m");
  std::string note;
  if (!unused.empty()) note = "; note: keyframe_insertion does not look at " + unused;
  if (request.options.bounds.any())
    note += "; note: keyframe_insertion corrects without regard to " +
            request.name_of("options.bounds") + ", and is checked";
  if (moving_camera(request) == nullptr) {
    note += "; note: keyframe_insertion corrects paths of cameras alone";
  }
  return note;
}

std::string note_of_tilt(const PlanRequest& request) {
  const correction::OrientationPolicy& policy = request.options.orientation;
  if (policy.rule != correction::OrientationRule::kLevel) return {};
  for (std::size_t i = 0; i < request.keyframes.size(); ++i) {
    const geometry::Vec3 across_W =
        request.keyframes[i].pose.orientation.normalized() * geometry::Vec3::UnitX();
    const double tilt_rad =
        std::atan2(std::abs(policy.up_W.dot(across_W)), policy.up_W.cross(across_W).norm());
    if (tilt_rad < kNotableTilt_rad) continue;
    return fmt::format("; note: keyframe {} is tilted by {:.0f} degrees, check {}", i,
                       tilt_rad * 180.0 / std::numbers::pi,
                       request.name_of("options.orientation.up"));
  }
  return {};
}

double body_size_m(const motion::Body& body) {
  return body.box_C().sizes().maxCoeff() + 2.0 * body.ball_radius_m();
}

std::string note_of_tolerance(const PlanRequest& request, const motion::Body& body) {
  const double tolerance_m = request.options.interval_tolerance_m;
  const double size_m = body_size_m(body);
  if (!(size_m < kLeastTolerances * tolerance_m)) return {};
  return fmt::format("; note: the body is {:.2g} m large, and {} of {:.2g} m is coarse for that",
                     size_m, request.name_of("options.interval_tolerance_m"), tolerance_m);
}

std::string note_of_scale(const PlanResult& result, const geometry::Box& scene_W) {
  const bool inside = std::ranges::any_of(result.keyframes, [&](const motion::Keyframe& keyframe) {
    return scene_W.contains(keyframe.pose.position);
  });
  if (inside || scene_W.isEmpty()) return {};
  return "; note: no keyframe lies within the bounds of the scene, check its scale and axes";
}

std::string note_of_keyframe_limit(const PlanRequest& request, const PlanResult& result,
                                   std::optional<std::size_t> needed) {
  const std::int32_t most = request.options.max_inserted_keyframes;
  if (result.collisions.empty()) return {};
  const std::string field = request.name_of("options.max_inserted_keyframes");
  if (most == 0) return fmt::format("; nothing was corrected, as {} asks for", field);
  // Keyframe insertion does not report how many keyframes it needs.
  const bool is_used_up = std::cmp_greater_equal(inserted_keyframes(result), most);
  if (!needed && !is_used_up) return {};
  if (!needed) return fmt::format("; {} allows {}", field, most);
  return fmt::format("; {} allows {}, the corrections that were found need {}", field, most,
                     *needed);
}

std::string note_of_times(const PlanResult& result, bool slowed_everywhere) {
  if (result.time_scale == 1.0) return {};
  return fmt::format("; slowed {} to meet the limits, {:.4g} times as long",
                     slowed_everywhere ? "all the way" : "in part", result.time_scale);
}

std::string why_too_fast(const PlanRequest& request, const LimitBreach& breach,
                         const motion::TimeOrigin& origin) {
  const std::string others =
      breach.parts > 1 ? fmt::format(" and at {}", counted(breach.parts - 1, "other time")) : "";
  return fmt::format(
      "{}: the path is free, but too fast from {} s to {} s{}: {}; allow {}, or give later "
      "times",
      request.name_of("options.limits"), time_text(origin.sent_s(breach.t_begin_s)),
      time_text(origin.sent_s(breach.t_end_s)), others, breach.rate,
      request.name_of("options.limits.retime"));
}

std::string deadline_text(const PlanRequest& request) {
  // The other half is for smaller cameras (`plan_with_shrinking`).
  return fmt::format("{}the deadline of {} s was reached", may_shrink(request) ? "half of " : "",
                     request.options.deadline_s);
}

const KeyframeFault& fault_to_name(const std::vector<KeyframeFault>& faults,
                                   const PlanRequest& request) {
  const auto lost = std::ranges::find_if(faults, [&](const KeyframeFault& fault) {
    return request.options.repair_keyframes && !fault.free_pose;
  });
  return lost == faults.end() ? faults.front() : *lost;
}

namespace {

/// Returns the rule that the body breaks at the keyframe, as a part of a sentence.
std::string rule_broken(const KeyframeFault& fault, double clearance_m, double surface_error_m) {
  if (fault.leaves_bounds) return "leaves the bounds";
  const std::string error =
      surface_error_m > 0.0
          ? fmt::format("the {:.2g} m of error of its smooth surfaces", surface_error_m)
          : "";
  if (clearance_m > 0.0) {
    return fmt::format("is nearer to the scene than the clearance of {:.3g} m that was asked for{}",
                       clearance_m, error.empty() ? "" : " and " + error);
  }
  return error.empty() ? "collides with the scene" : "is nearer to the scene than " + error;
}

}  // namespace

std::string why_refused(const std::vector<KeyframeFault>& faults, const PlanRequest& request,
                        double surface_error_m, bool timed_out, bool are_all) {
  const KeyframeFault& first = fault_to_name(faults, request);
  const std::string rule = rule_broken(first, request.options.clearance_m, surface_error_m);
  std::string message =
      fmt::format("keyframes[{}]: the {} {} there", first.keyframe,
                  moving_camera(request) != nullptr ? "near quadrilateral" : "body", rule);
  if (first.depth_m > 0.0) message += fmt::format(", by about {:.3g} m", first.depth_m);
  const bool may_repair = request.options.repair_keyframes;
  if (first.free_pose) {
    const geometry::Vec3& to = first.free_pose->position;
    message +=
        fmt::format("; it would be free at ({:.4g}, {:.4g}, {:.4g})", to.x(), to.y(), to.z());
  } else {
    message += may_repair ? "; it could not be repaired: " : "; ";
    message += timed_out ? deadline_text(request) + " before a free pose was found"
                         : "no free pose was found near it";
  }
  const bool are_too_many = faults.size() >= kMostKeyframeFaults;
  if (faults.size() > 1) {
    message += fmt::format("; {}{} keyframes are at fault",
                           are_all && !are_too_many ? "" : "at least ", faults.size());
  }
  if (are_too_many && may_repair) message += ", too many to be repaired";
  if (request.frame) {
    message += "; note: keyframes of an answer are surely free only if its path is certified";
  }
  return message;
}

std::string why_infeasible(const Infeasibility& proof, bool may_shrink) {
  if (!proof.cage) {
    return fmt::format(
        "no path exists: keyframe {} is inside a closed surface of {} of the scene, keyframe {} "
        "outside",
        proof.keyframe_inside, counted(proof.triangles.size(), "triangle"), proof.keyframe_outside);
  }
  const geometry::Vec3 center = proof.cage->orientation * geometry::Vec3(proof.cage->box.center());
  const geometry::Vec3 size_m = proof.cage->box.sizes();
  const std::string place =
      fmt::format("of {:.3g} x {:.3g} x {:.3g} m about ({:.4g}, {:.4g}, {:.4g})", size_m.x(),
                  size_m.y(), size_m.z(), center.x(), center.y(), center.z());
  const std::string camera =
      fmt::format("the camera's near quadrilateral ({:.3g} m{})", proof.cage->shortest_chord_m,
                  may_shrink ? " at its smallest" : "");
  const std::string holes =
      proof.cage->widest_hole_m > 0.0
          ? fmt::format("whose holes ({:.3g} m at most) are too narrow for {}",
                        proof.cage->widest_hole_m, camera)
          : "without holes";
  return fmt::format("no path exists: keyframe {} is inside a box {} {}, keyframe {} outside",
                     proof.keyframe_inside, place, holes, proof.keyframe_outside);
}

}  // namespace camway::planning
