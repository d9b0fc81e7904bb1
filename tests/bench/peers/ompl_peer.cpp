// SPDX-License-Identifier: MIT
#include "tests/bench/peers/ompl_peer.h"

#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/spaces/SE3StateSpace.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <cmath>

#include "daemon/motion/path/straight_motion.h"
#include "tests/bench/measure.h"

namespace camway::bench {

namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;
using State = ob::SE3StateSpace::StateType;

// Margin around the scene's bounds, because a way around the outermost walls may leave them.
constexpr double kMargin_m = 1.0;

// A state space whose motions are sampled so that no corner moves by more than the step between two
// samples.
class CameraSpace : public ob::SE3StateSpace {
 public:
  explicit CameraSpace(double radius_m) : radius_m_(radius_m) {}

  unsigned validSegmentCount(const ob::State* a, const ob::State* b) const override {
    const auto* from = a->as<State>();
    const auto* to = b->as<State>();
    const double moved_m =
        std::hypot(to->getX() - from->getX(), to->getY() - from->getY(), to->getZ() - from->getZ());
    // The library's distance of rotations is half of the angle.
    const double turned_rad =
        2.0 * as<ob::SO3StateSpace>(1)->distance(&from->rotation(), &to->rotation());
    const double steps = (moved_m + radius_m_ * turned_rad) / OmplPeer::kStep_m;
    return static_cast<unsigned>(std::max(1.0, std::ceil(steps)));
  }

 private:
  double radius_m_;
};

motion::Pose to_pose(const ob::State* state) {
  const auto* s = state->as<State>();
  const auto& r = s->rotation();
  return {{s->getX(), s->getY(), s->getZ()}, {r.w, r.x, r.y, r.z}};
}

void set(ob::ScopedState<ob::SE3StateSpace>& state, const motion::Pose& pose) {
  state->setXYZ(pose.position.x(), pose.position.y(), pose.position.z());
  state->rotation().x = pose.orientation.x();
  state->rotation().y = pose.orientation.y();
  state->rotation().z = pose.orientation.z();
  state->rotation().w = pose.orientation.w();
}

ob::StateSpacePtr make_space(const geometry::Box& bounds, const motion::Camera& camera) {
  const double radius_m = motion::body_radius_m(motion::near_corners_C(camera));
  const auto space = std::make_shared<CameraSpace>(radius_m);
  ob::RealVectorBounds limits(3);
  for (unsigned k = 0; k < 3; ++k) {
    limits.setLow(k, bounds.min()[k] - kMargin_m);
    limits.setHigh(k, bounds.max()[k] + kMargin_m);
  }
  space->setBounds(limits);
  return space;
}

ob::PlannerPtr make_planner(const ob::SpaceInformationPtr& information, OmplPeer::Planner planner) {
  if (planner == OmplPeer::Planner::kRrtConnect) {
    return std::make_shared<og::RRTConnect>(information);
  }
  return std::make_shared<og::BITstar>(information);
}

// Returns a condition on processor time, in which everything is measured.
ob::PlannerTerminationCondition until(double end_s) {
  return ob::PlannerTerminationCondition([end_s] { return thread_seconds() > end_s; });
}

// Appends the poses after `from` up to `to`. Returns false if no way was found.
bool connect(og::SimpleSetup& setup, OmplPeer::Planner planner, const motion::Pose& from,
             const motion::Pose& to, double end_s, std::vector<motion::Pose>& poses) {
  ob::ScopedState<ob::SE3StateSpace> start(setup.getStateSpace());
  ob::ScopedState<ob::SE3StateSpace> goal(setup.getStateSpace());
  set(start, from);
  set(goal, to);
  if (setup.getSpaceInformation()->checkMotion(start.get(), goal.get())) {
    poses.push_back(to);
    return true;
  }
  setup.clear();
  setup.setStartAndGoalStates(start, goal);
  // Stop at the first solution; BIT* would use all the time otherwise.
  const auto objective =
      std::make_shared<ob::PathLengthOptimizationObjective>(setup.getSpaceInformation());
  objective->setCostThreshold(objective->infiniteCost());
  setup.setOptimizationObjective(objective);
  setup.setPlanner(make_planner(setup.getSpaceInformation(), planner));
  if (setup.solve(until(end_s)) != ob::PlannerStatus::EXACT_SOLUTION) return false;
  setup.simplifySolution(until(std::min(end_s, thread_seconds() + OmplPeer::kSimplify_s)));
  const auto& states = setup.getSolutionPath().getStates();
  for (std::size_t i = 1; i < states.size(); ++i) poses.push_back(to_pose(states[i]));
  return true;
}

geometry::Box with_margin_for(const geometry::Box& bounds,
                              std::span<const motion::Keyframe> keyframes) {
  geometry::Box box = bounds;
  for (const motion::Keyframe& keyframe : keyframes) box.extend(keyframe.pose.position);
  return box;
}

// Sets the random seed once, before the library makes its first generator.
void fix_seed() {
  static const bool once = [] {
    ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    ompl::RNG::setSeed(1);
    return true;
  }();
  static_cast<void>(once);
}

}  // namespace

OmplPeer::OmplPeer(const FclPeer& fcl, const scene::Mesh& mesh, const motion::Camera& camera)
    : fcl_(fcl), camera_(camera), bounds_(mesh.bounds()) {
  fix_seed();
}

std::optional<PolylineWay> OmplPeer::plan(std::span<const motion::Keyframe> keyframes,
                                          Planner planner, double deadline_s) const {
  const double end_s = thread_seconds() + deadline_s;
  og::SimpleSetup setup(make_space(with_margin_for(bounds_, keyframes), camera_));
  setup.setStateValidityChecker(
      [this](const ob::State* state) { return !fcl_.collides(to_pose(state)); });
  setup.getSpaceInformation()->setup();
  PolylineWay way{{keyframes.front().pose}, {0}};
  for (std::size_t i = 1; i < keyframes.size(); ++i) {
    const motion::Pose& from = keyframes[i - 1].pose;
    if (!connect(setup, planner, from, keyframes[i].pose, end_s, way.poses)) return std::nullopt;
    way.at_keyframe.push_back(way.poses.size() - 1);
  }
  return way;
}

motion::Path straight_path(std::span<const motion::Pose> poses) {
  // Within a segment, the angle of the chord's point differs from that of the arc by less than a
  // hundredth of the cube of the segment's angle.
  constexpr double kPart_rad = 0.05;
  std::vector<motion::Segment> segments;
  geometry::Quat turned = poses.front().orientation.normalized();
  for (std::size_t i = 1; i < poses.size(); ++i) {
    geometry::Quat to = poses[i].orientation.normalized();
    if (turned.dot(to) < 0.0) to.coeffs() *= -1.0;
    const int parts = 1 + static_cast<int>(turned.angularDistance(to) / kPart_rad);
    motion::SignedPose begin{poses[i - 1].position, geometry::wxyz(turned)};
    for (int k = 1; k <= parts; ++k) {
      const double share = static_cast<double>(k) / parts;
      const geometry::Vec3 way = share * (poses[i].position - poses[i - 1].position);
      const motion::SignedPose end{poses[i - 1].position + way,
                                   geometry::wxyz(turned.slerp(share, to))};
      motion::Segment segment = motion::straight_motion(begin, end);
      segment.t0_s = segments.empty() ? 0.0 : segments.back().t1_s;
      segment.t1_s = static_cast<double>(i - 1) + share;
      segments.push_back(segment);
      begin = end;
    }
    turned = to;
  }
  return motion::Path(std::move(segments));
}

}  // namespace camway::bench
