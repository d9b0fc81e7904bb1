// SPDX-License-Identifier: MIT
#include "tools/camway/replay/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace camway::tools {
namespace {

using motion::Path;
using motion::Segment;

/// Samples between two joins, where a path is a smooth curve of low degree.
constexpr int kSamplesPerPiece = 32;

bool same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

template <typename Vector>
bool same_vector(const Vector& a, const Vector& b) {
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    if (!same(a[i], b[i])) return false;
  }
  return true;
}

bool same_segment(const Segment& a, const Segment& b) {
  return same(a.t0_s, b.t0_s) && same(a.t1_s, b.t1_s) &&
         std::equal(a.position.begin(), a.position.end(), b.position.begin(),
                    same_vector<geometry::Vec3>) &&
         std::equal(a.orientation.begin(), a.orientation.end(), b.orientation.begin(),
                    same_vector<geometry::Vec4>);
}

bool same_keyframe(const motion::Keyframe& a, const motion::Keyframe& b) {
  return same(a.time_s, b.time_s) && a.origin == b.origin && a.is_repaired == b.is_repaired &&
         same_vector(a.pose.position, b.pose.position) &&
         same_vector(geometry::wxyz(a.pose.orientation), geometry::wxyz(b.pose.orientation));
}

/// Compares witnesses except for the number of the feature: answers have its name.
bool same_witness(const std::optional<collision::Witness>& a,
                  const std::optional<collision::Witness>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return same(a->time_s, b->time_s) && a->triangle == b->triangle && same(a->depth_m, b->depth_m) &&
         same_vector(a->point_W, b->point_W);
}

bool same_interval(const collision::CollisionInterval& a, const collision::CollisionInterval& b) {
  return same(a.t_begin_s, b.t_begin_s) && same(a.t_end_s, b.t_end_s) &&
         same_witness(a.witness, b.witness);
}

/// Returns the names of a witness; empty ones if it has none.
bool same_names(std::vector<planning::WitnessNames> a, std::vector<planning::WitnessNames> b) {
  const std::size_t count = std::max(a.size(), b.size());
  a.resize(count);
  b.resize(count);
  return a == b;
}

/// Compares corrections except for the witness, which is part of the collision.
bool same_correction(const correction::Correction& a, const correction::Correction& b) {
  return same(a.interval.t_begin_s, b.interval.t_begin_s) &&
         same(a.interval.t_end_s, b.interval.t_end_s) && a.kind == b.kind &&
         same(a.t_begin_s, b.t_begin_s) && same(a.t_end_s, b.t_end_s) &&
         same(a.moved_m, b.moved_m) && same(a.turned_rad, b.turned_rad);
}

bool same_measures(const std::optional<motion::PathMeasures>& a,
                   const std::optional<motion::PathMeasures>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return same(a->clearance_lower_bound_m, b->clearance_lower_bound_m) &&
         same(a->length_m, b->length_m) && same(a->largest_deviation_m, b->largest_deviation_m) &&
         same(a->bending_energy_m2_per_s3, b->bending_energy_m2_per_s3) &&
         same(a->largest_speed_m_per_s, b->largest_speed_m_per_s) &&
         same(a->largest_acceleration_m_per_s2, b->largest_acceleration_m_per_s2) &&
         same(a->largest_turn_rate_rad_per_s, b->largest_turn_rate_rad_per_s) &&
         same(a->largest_turn_acceleration_rad_per_s2, b->largest_turn_acceleration_rad_per_s2);
}

bool same_fault(const planning::KeyframeFault& a, const planning::KeyframeFault& b) {
  if (a.keyframe != b.keyframe || !same(a.depth_m, b.depth_m)) return false;
  if (!a.free_pose || !b.free_pose) return a.free_pose.has_value() == b.free_pose.has_value();
  return same_vector(a.free_pose->position, b.free_pose->position) &&
         same_vector(geometry::wxyz(a.free_pose->orientation),
                     geometry::wxyz(b.free_pose->orientation));
}

bool same_slowed(const planning::SlowedStretch& a, const planning::SlowedStretch& b) {
  return same(a.t_begin_s, b.t_begin_s) && same(a.t_end_s, b.t_end_s) &&
         same(a.given_t_begin_s, b.given_t_begin_s) && same(a.given_t_end_s, b.given_t_end_s);
}

bool same_cage(const std::optional<correction::CageBox>& a,
               const std::optional<correction::CageBox>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return same_vector(geometry::wxyz(a->orientation), geometry::wxyz(b->orientation)) &&
         same_vector(a->box.min(), b->box.min()) && same_vector(a->box.max(), b->box.max()) &&
         same(a->widest_hole_m, b->widest_hole_m) && same(a->shortest_chord_m, b->shortest_chord_m);
}

bool same_proof(const std::optional<planning::Infeasibility>& a,
                const std::optional<planning::Infeasibility>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->keyframe_inside == b->keyframe_inside && a->keyframe_outside == b->keyframe_outside &&
         a->triangles == b->triangles && same_cage(a->cage, b->cage);
}

template <typename List, typename Same>
std::string differing(const char* name, const List& a, const List& b, Same same_item) {
  if (a.size() != b.size()) return fmt::format("{} {} -> {}", name, a.size(), b.size());
  const bool equal = std::equal(a.begin(), a.end(), b.begin(), same_item);
  return equal ? std::string() : std::string(name);
}

double pose_distance_m(const motion::Body& body, const motion::Pose& a, const motion::Pose& b) {
  const geometry::Vec3 moved = b.position - a.position;
  const Eigen::Matrix3d turned =
      b.orientation.toRotationMatrix() - a.orientation.toRotationMatrix();
  double largest = moved.norm();
  for (const geometry::Triangle& triangle : body.triangles_C()) {
    for (const geometry::Vec3& corner_C : triangle) {
      const geometry::Vec3 apart = moved + turned * corner_C;
      largest = std::max(largest, apart.norm());
    }
  }
  return largest;
}

double path_distance_m(const Path& a, const Path& b, const motion::Body& body) {
  if (same_bits(a, b)) return 0.0;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (a.empty() || b.empty()) return kInfinity;
  if (a.begin_s() != b.begin_s() || a.end_s() != b.end_s()) return kInfinity;
  std::vector<double> joins{a.begin_s()};
  for (const Path* path : {&a, &b}) {
    for (const Segment& segment : path->segments()) joins.push_back(segment.t1_s);
  }
  std::sort(joins.begin(), joins.end());
  double largest = 0.0;
  for (std::size_t i = 1; i < joins.size(); ++i) {
    for (int k = 0; k <= kSamplesPerPiece; ++k) {
      const double time_s = joins[i - 1] + (joins[i] - joins[i - 1]) * k / kSamplesPerPiece;
      const double distance_m = pose_distance_m(body, a.pose(time_s), b.pose(time_s));
      // A pose with NaN must not count as no difference.
      largest = distance_m >= 0.0 ? std::max(largest, distance_m) : kInfinity;
    }
  }
  // Different bits can round to the same samples, but only equal bits may give 0.
  return std::max(largest, std::numeric_limits<double>::denorm_min());
}

/// Returns the first difference of the answers' fields about correction.
std::string report_difference(const planning::PlanResult& a, const planning::PlanResult& b) {
  std::string text = differing("corrections", a.corrections, b.corrections, same_correction);
  if (text.empty()) {
    text = differing("keyframe faults", a.keyframe_faults, b.keyframe_faults, same_fault);
  }
  if (!text.empty()) return text;
  if (!same_measures(a.measures_before, b.measures_before)) return "measures before correction";
  if (!same_measures(a.measures, b.measures)) return "measures";
  if (!(a.bounds == b.bounds)) return "bounds";
  if (!same(a.near_scale, b.near_scale)) return "near scale";
  if (!same(a.time_scale, b.time_scale)) return "time scale";
  const std::string slowed = differing("slowed stretches", a.slowed, b.slowed, same_slowed);
  if (!slowed.empty()) return slowed;
  return same_proof(a.infeasibility, b.infeasibility) ? "" : "proof that there is no path";
}

std::string first_difference(const planning::PlanResult& a, const planning::PlanResult& b) {
  if (a.status != b.status) {
    return fmt::format("status {} -> {}", planning::to_string(a.status),
                       planning::to_string(b.status));
  }
  if (a.keyframe != b.keyframe) return "keyframe at fault";
  std::string text = differing("keyframes", a.keyframes, b.keyframes, same_keyframe);
  if (text.empty()) {
    text = differing("segments", a.path.segments(), b.path.segments(), same_segment);
  }
  if (text.empty()) text = differing("collisions", a.collisions, b.collisions, same_interval);
  if (text.empty()) {
    text = differing("remaining collisions", a.remaining_collisions, b.remaining_collisions,
                     same_interval);
  }
  const bool same_words = same_names(a.collision_names, b.collision_names) &&
                          same_names(a.remaining_names, b.remaining_names);
  if (text.empty() && !same_words) text = "names of what collides";
  const bool same_certificate =
      a.certificate.certified == b.certificate.certified &&
      same(a.certificate.clearance_lower_bound_m, b.certificate.clearance_lower_bound_m);
  if (text.empty() && !same_certificate) text = "certificate";
  return text.empty() ? report_difference(a, b) : text;
}

}  // namespace

bool same_bits(const Path& a, const Path& b) {
  return std::equal(a.segments().begin(), a.segments().end(), b.segments().begin(),
                    b.segments().end(), same_segment);
}

Difference compare(const planning::PlanResult& recorded, const planning::PlanResult& now,
                   const motion::Body& body) {
  return {path_distance_m(recorded.path, now.path, body), first_difference(recorded, now)};
}

}  // namespace camway::tools
