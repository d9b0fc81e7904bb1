// SPDX-License-Identifier: MIT
#include "tests/bench/peers/fcl_peer.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/continuous_collision.h>

namespace camway::bench {

namespace {

using Model = fcl::BVHModel<fcl::OBBRSSd>;

fcl::Transform3d transform(const motion::Pose& pose) {
  fcl::Transform3d X_WC = fcl::Transform3d::Identity();
  X_WC.linear() = pose.orientation.toRotationMatrix();
  X_WC.translation() = pose.position;
  return X_WC;
}

}  // namespace

struct FclPeer::Models {
  Model scene;
  std::unique_ptr<Model> quad;
};

FclPeer::FclPeer(const scene::Mesh& mesh) : models_(std::make_unique<Models>()) {
  std::vector<fcl::Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  models_->scene.beginModel(static_cast<int>(mesh.triangles.size()),
                            static_cast<int>(mesh.vertices.size()));
  models_->scene.addSubModel(mesh.vertices, triangles);
}

FclPeer::~FclPeer() = default;

void FclPeer::build() {
  models_->scene.endModel();
  models_->scene.computeLocalAABB();
}

// The library only prints its memory (`memUsage`), so this adds up the nodes and the copies of
// vertices, triangles and their order.
std::size_t FclPeer::memory_bytes() const {
  const Model& scene = models_->scene;
  return static_cast<std::size_t>(scene.getNumBVs()) * sizeof(fcl::BVNode<fcl::OBBRSSd>) +
         static_cast<std::size_t>(scene.num_vertices) * sizeof(fcl::Vector3d) +
         static_cast<std::size_t>(scene.num_tris) * (sizeof(fcl::Triangle) + sizeof(unsigned));
}

void FclPeer::set_camera(const motion::Camera& camera) {
  const motion::Corners corners_C = motion::near_corners_C(camera);
  models_->quad = std::make_unique<Model>();
  models_->quad->beginModel(2, 4);
  models_->quad->addSubModel(std::vector<fcl::Vector3d>(corners_C.begin(), corners_C.end()),
                             {fcl::Triangle(0, 1, 2), fcl::Triangle(0, 2, 3)});
  models_->quad->endModel();
  models_->quad->computeLocalAABB();
}

bool FclPeer::collides(const motion::Pose& pose) const {
  const fcl::CollisionRequestd request(/*num_max_contacts_=*/1, /*enable_contact_=*/false);
  fcl::CollisionResultd result;
  return fcl::collide(models_->quad.get(), transform(pose), &models_->scene,
                      fcl::Transform3d::Identity(), request, result) > 0;
}

bool FclPeer::collides_between(const motion::Pose& from, const motion::Pose& to,
                               Continuous solver) const {
  // The library's defaults (10 iterations, 1e-4), except for the solver and a motion with rotation.
  fcl::ContinuousCollisionRequestd request;
  request.ccd_solver_type =
      solver == Continuous::kNaive ? fcl::CCDC_NAIVE : fcl::CCDC_CONSERVATIVE_ADVANCEMENT;
  request.ccd_motion_type = fcl::CCDM_LINEAR;
  fcl::ContinuousCollisionResultd result;
  fcl::continuousCollide(models_->quad.get(), transform(from), transform(to), &models_->scene,
                         fcl::Transform3d::Identity(), fcl::Transform3d::Identity(), request,
                         result);
  return result.is_collide;
}

}  // namespace camway::bench
