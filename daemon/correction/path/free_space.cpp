// SPDX-License-Identifier: MIT
#include "daemon/correction/path/free_space.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "daemon/collision/detect.h"
#include "daemon/collision/witness.h"
#include "daemon/correction/path/orientation_rule.h"
#include "daemon/geometry/triangle_distance.h"
#include "daemon/motion/path/stretch.h"
#include "daemon/scene/field/clearance_field.h"
#include "daemon/scene/voxels/voxel_map.h"

namespace camway::correction {

namespace {

using geometry::Triangle;
using geometry::Vec3;
using motion::SignedPose;

constexpr double kNearestShare = 0.8;

}  // namespace

FreeSpace::FreeSpace(const collision::Query& query, const OrientationPolicy& policy,
                     const Closeness& closeness)
    : query_(query),
      policy_(policy),
      closeness_(closeness),
      probe_(query.obstacles, query.body, query.options.clearance_m) {
  center_C_ = query.body.center_C();
  ball_radius_m_ = query.body.center_radius_m() + query.body.ball_radius_m();
}

bool FreeSpace::is_free(const motion::Pose& pose, double margin_m) {
  return probe_.is_free(pose, margin_m);
}

double FreeSpace::gap_m(const motion::Pose& pose, double up_to_m) {
  constexpr double kExact = 1.0;  // a body that is barely too close must not count as free
  const collision::ProbeResult seen =
      probe_.check_refined(motion::standing_at(pose), up_to_m, kExact);
  return seen.free ? up_to_m : std::min(seen.gap_m, up_to_m);
}

std::optional<scene::Nearest> FreeSpace::nearest(const motion::Pose& pose, double up_to_m) {
  const motion::Stretch standing = motion::standing_at(pose);
  if (probe_.at_least_m(standing) >= up_to_m) return std::nullopt;
  probe_.place(standing);
  std::optional<scene::Nearest> found =
      probe_.nearest_in_scene(up_to_m + probe_.required_distance_m(), kNearestShare);
  if (found) found->distance_m -= probe_.required_distance_m();
  const std::optional<collision::VertexAtSide> vertex = probe_.least_deep_vertex();
  if (vertex && vertex->gap_m < (found ? found->distance_m : up_to_m))
    return scene::Nearest{vertex->gap_m, collision::Obstacles::number_of_side(vertex->side)};
  return found;
}

collision::Query FreeSpace::with_margin(double margin_m) const {
  collision::Query query = query_;
  collision::DetectOptions& options = query.options;
  options.clearance_m += margin_m;
  // A search does not need the exact place of the obstacle.
  options.tolerance_m = std::max(options.tolerance_m, 0.5 * margin_m);
  options.joining_distance_m = std::max(options.joining_distance_m, options.tolerance_m);
  // The required clearance does not apply to the bounds.
  query.obstacles.bounds = query.obstacles.bounds.shrunk_by(margin_m);
  return query;
}

std::optional<double> FreeSpace::first_hit(const SignedPose& from, const SignedPose& to,
                                           double margin_m) const {
  const motion::Path path({motion::straight_motion(from, to)});
  const collision::FirstCollision found =
      collision::first_contact(with_margin(margin_m), path, 0.0, 1.0, base::Deadline::never());
  if (!found.interval) return std::nullopt;
  return found.interval->t_begin_s;
}

bool FreeSpace::passes(const SignedPose& from, const SignedPose& to, double margin_m) const {
  const motion::Path path({motion::straight_motion(from, to)});
  return !collision::any_collision(with_margin(margin_m), path, 0.0, 1.0, base::Deadline::never())
              .interval;
}

double FreeSpace::ball_gap_m(const Vec3& point_W, double radius_m, double up_to_m) const {
  const double keep_m = radius_m + query_.required_clearance_m();
  const double inside_m = query_.obstacles.bounds.depth_m(point_W) - radius_m;
  if (inside_m <= 0.0) return inside_m;
  up_to_m = std::min(up_to_m, inside_m);
  if (query_.obstacles.solids != nullptr && query_.obstacles.solids->hold(point_W)) return -keep_m;
  if (query_.obstacles.field != nullptr) {
    const double at_least_m = query_.obstacles.field->clearance_at_least_m(point_W) - keep_m;
    if (at_least_m >= up_to_m) return up_to_m;
  }
  const std::array<Triangle, 1> point = {Triangle{point_W, point_W, point_W}};
  const double horizon_m = keep_m + up_to_m;
  const std::optional<scene::Nearest> nearest =
      query_.obstacles.index.near(point, horizon_m, keep_m, kBallShare);
  if (!nearest) return up_to_m;
  return std::min(up_to_m, nearest->distance_m - keep_m);
}

bool FreeSpace::ball_passes(const Vec3& from_W, const Vec3& to_W, double radius_m) const {
  std::optional<std::uint32_t> met;
  return ball_passes(from_W, to_W, radius_m, met);
}

bool FreeSpace::ball_passes(const Vec3& from_W, const Vec3& to_W, double radius_m,
                            std::optional<std::uint32_t>& met) const {
  const double inside_m =
      std::min(query_.obstacles.bounds.depth_m(from_W), query_.obstacles.bounds.depth_m(to_W));
  if (!(inside_m > radius_m)) return false;
  const scene::SceneIndex& index = query_.obstacles.index;
  const std::array<Triangle, 1> way = {Triangle{from_W, to_W, to_W}};
  const double keep_m = radius_m + query_.required_clearance_m();
  if (met) {
    // Nearer by more than the error of distances: the search cannot miss it.
    const double near_m = keep_m - 2.0 * index.nearest_error_m(way);
    if (geometry::triangle_distance(way[0], index.triangle(*met), near_m) < near_m) return false;
  }
  const std::optional<scene::Nearest> found = index.any_within(way, keep_m);
  if (found) met = found->triangle;
  return !found;
}

double FreeSpace::way_gap_m(const Vec3& from_W, const Vec3& to_W, double up_to_m) const {
  const double inside_m =
      std::min(query_.obstacles.bounds.depth_m(from_W), query_.obstacles.bounds.depth_m(to_W));
  const std::array<Triangle, 1> way = {Triangle{from_W, to_W, to_W}};
  const std::optional<scene::Nearest> nearest =
      query_.obstacles.index.nearest(way, up_to_m + query_.required_clearance_m());
  return std::min(inside_m,
                  nearest ? nearest->distance_m - query_.required_clearance_m() : up_to_m);
}

motion::Pose FreeSpace::within_bounds(const motion::Pose& pose, double margin_m) {
  const geometry::Bounds inner =
      query_.obstacles.bounds.shrunk_by(margin_m).shrunk_by(query_.body.ball_radius_m());
  probe_.place(motion::standing_at(pose));
  const geometry::Box box = probe_.vertex_box();
  const Vec3 below = (inner.min_W - box.min()).cwiseMax(0.0);
  const Vec3 above = (box.max() - inner.max_W).cwiseMax(0.0);
  if (below.isZero(0.0) && above.isZero(0.0)) return pose;
  return {pose.position + below - above, pose.orientation};
}

std::optional<collision::Witness> FreeSpace::contact(const motion::Pose& pose, double beyond_m) {
  return collision::deepest_contact(probe_, motion::standing_at(pose), beyond_m);
}

SignedPose FreeSpace::allowed(const SignedPose& wanted, const motion::Pose& interpolated) const {
  if (!is_limited(policy_)) return wanted;
  const motion::Pose pose = motion::unsigned_pose(wanted);
  const motion::Pose turned = allowed_pose(policy_, pose, interpolated, center_C_);
  if (turned.orientation.coeffs() == pose.orientation.coeffs()) return wanted;
  return motion::signed_like(turned, wanted);
}

double FreeSpace::distance_m(const SignedPose& a, const SignedPose& b) const {
  // |a - b| = 2 sin(theta/4) on S3 for a turn by theta.
  const double quarter_sine = 0.5 * (a.orientation - b.orientation).norm();
  const double turn_rad = 4.0 * std::asin(std::min(1.0, quarter_sine));
  return (a.position - b.position).norm() + ball_radius_m_ * turn_rad;
}

}  // namespace camway::correction
