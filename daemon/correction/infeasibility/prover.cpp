// SPDX-License-Identifier: MIT
#include "daemon/correction/infeasibility/prover.h"

namespace camway::correction {

namespace {

using geometry::Vec3;

/// How far the answer's path may be from a keyframe when a client checks it, and so the point of
/// the body: surfaces nearer than this prove nothing.
constexpr double kPointRounding_m = 1e-6;

Vec3 placed(const motion::Pose& pose, const Vec3& point_C) {
  return pose.position + pose.orientation * point_C;
}

std::vector<Vec3> points_W(const std::vector<motion::Pose>& poses, const Vec3& point_C) {
  std::vector<Vec3> points_W;
  for (const motion::Pose& pose : poses) points_W.push_back(placed(pose, point_C));
  return points_W;
}

/// Translates the indices of a proof among the keyframes that it used into those of all keyframes.
template <class Proof>
void name_keyframes(const std::vector<std::size_t>& used, std::optional<Proof>& proof) {
  if (!proof) return;
  proof->inside = used[proof->inside];
  proof->outside = used[proof->outside];
}

}  // namespace

Prover::Prover(const scene::WholeMesh& mesh, const motion::Body& body,
               const std::vector<motion::Keyframe>& keyframes, double max_shrink)
    : mesh_(mesh), body_(body), smallest_(1.0 - max_shrink) {
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    poses_.push_back(keyframes[i].pose);
    if (keyframes[i].is_repaired) continue;
    as_asked_.push_back(i);
    poses_as_asked_.push_back(keyframes[i].pose);
  }
}

bool Prover::is_separated() {
  if (!looked_for_separation_) {
    looked_for_separation_ = true;
    separation_ = separation_of_body();
    name_keyframes(as_asked_, separation_);
  }
  return separation_.has_value();
}

std::optional<Separation> Prover::separation_of_body() {
  // The proof needs a point of the body; the eye is none.
  const Vec3 point_C = body_.point_C();
  std::optional<Separation> found = find_separation(
      *mesh_, mesh_.closed_surfaces(), points_W(poses_as_asked_, point_C), kPointRounding_m);
  if (!found || smallest_ == 1.0) return found;
  const auto way_W = [&](std::size_t keyframe) {
    const motion::Pose& pose = poses_as_asked_[keyframe];
    return geometry::LineSegment{placed(pose, point_C), placed(pose, smallest_ * point_C)};
  };
  if (!keeps_clear(*found, *mesh_, way_W(found->inside), way_W(found->outside), kPointRounding_m)) {
    return std::nullopt;
  }
  return found;
}

bool Prover::is_caged() {
  if (!looked_for_cage_) {
    looked_for_cage_ = true;
    if (body_.is_camera() && !is_separated()) look_for_cage();
  }
  return cage_.has_value();
}

void Prover::look_for_cage() {
  cage_ = cage_of_camera(smallest_, poses_as_asked_);
  name_keyframes(as_asked_, cage_);
  const bool is_same = smallest_ == 1.0 && poses_as_asked_.size() == poses_.size();
  if (!cage_ && !is_same) cage_at_this_size_ = cage_of_camera(1.0, poses_);
}

// The near quadrilateral is a rectangle parallel to two axes of the camera frame.
std::optional<Cage> Prover::cage_of_camera(double smallest,
                                           const std::vector<motion::Pose>& poses) {
  const geometry::Box& rectangle_C = body_.box_C();
  const Vec3 center_C = rectangle_C.center();
  const double side_m = rectangle_C.sizes().head<2>().minCoeff();
  return find_cage(*mesh_, mesh_.closed_surfaces(), points_W(poses, center_C), smallest * side_m,
                   kPointRounding_m + (1.0 - smallest) * center_C.norm());
}

bool Prover::is_caged_off(const Vec3& a_W, const Vec3& b_W) const {
  if (!cage_at_this_size_) return false;
  const CageBox& cage = cage_at_this_size_->box;
  const auto is_inside = [&](const Vec3& center_W) {
    return cage.box.contains(cage.orientation.conjugate() * center_W);
  };
  return is_inside(a_W) != is_inside(b_W);
}

}  // namespace camway::correction
