// SPDX-License-Identifier: MIT
#include "tests/messages/plan_samples.h"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "daemon/planning/request/option_table.h"

namespace camway::testing {
namespace {

double number(Random& random) { return std::uniform_real_distribution<double>(-50, 50)(random); }

motion::Keyframe keyframe(double time_s, Random& random) {
  motion::Keyframe keyframe;
  keyframe.time_s = time_s;
  for (double& value : keyframe.pose.position) value = number(random);
  for (double& value : keyframe.pose.orientation.coeffs()) value = number(random);
  return keyframe;
}

motion::Segment segment(double t0_s, double t1_s, Random& random) {
  motion::Segment segment;
  segment.t0_s = t0_s;
  segment.t1_s = t1_s;
  for (geometry::Vec3& point : segment.position) {
    for (double& value : point) value = number(random);
  }
  for (geometry::Vec4& point : segment.orientation) {
    for (double& value : point) value = number(random);
  }
  return segment;
}

geometry::Vec3 point(Random& random) { return {number(random), number(random), number(random)}; }

geometry::Vec4 four(Random& random) {
  return {number(random), number(random), number(random), number(random)};
}

/// A frame, and images of the keyframes that belong to it. Some keyframes have none.
motion::PathFrame add_frame(std::vector<motion::Keyframe>& keyframes, Random& random) {
  for (motion::Keyframe& keyframe : keyframes) {
    if (below(random, 4) != 0) keyframe.image = four(random);
  }
  return {four(random), {point(random), four(random)}, {point(random), four(random)}};
}

collision::Witness witness(double time_s, Random& random) {
  return {.time_s = time_s,
          .triangle = static_cast<std::uint32_t>(below(random, 100'000)),
          .depth_m = number(random),
          .point_W = point(random)};
}

/// Gives about half of the options a random value of their range.
struct OptionFiller {
  Random& random;

  template <class Member>
  void operator()(const planning::FieldSpec& spec, Member& member) const {
    if (below(random, 2) == 0) fill(spec, member);
  }

 private:
  /// Returns a number between the ends of a range. Angles are a number of degrees, so that they
  /// survive in a file bit for bit.
  [[nodiscard]] double inside(const planning::FieldSpec& spec) const {
    constexpr double kRadians = std::numbers::pi / 180.0;
    const double unit = spec.is_angle() ? kRadians : 1.0;
    const double least = spec.range.least / unit;
    const double most = std::isfinite(spec.range.most) ? spec.range.most / unit : least + 50.0;
    return (least + (most - least) * static_cast<double>(1 + below(random, 999)) / 1000.0) * unit;
  }
  void fill(const planning::FieldSpec& spec, double& value) const { value = inside(spec); }
  void fill(const planning::FieldSpec& spec, std::optional<double>& value) const {
    value = inside(spec);
  }
  void fill(const planning::FieldSpec&, bool& value) const { value = below(random, 2) == 0; }
  template <std::integral Number>
  void fill(const planning::FieldSpec& spec, Number& value) const {
    constexpr auto kMost = static_cast<Number>(std::min<std::uint64_t>(
        std::numeric_limits<Number>::max(), std::numeric_limits<std::int64_t>::max()));
    value = static_cast<Number>(static_cast<Number>(spec.range.least) +
                                static_cast<Number>(random() % static_cast<std::uint64_t>(kMost)));
  }
  template <base::NamedEnum Enum>
  void fill(const planning::FieldSpec&, Enum& value) const {
    value = static_cast<Enum>(below(random, names_of(Enum{}).size()));
  }
  void fill(const planning::FieldSpec&, geometry::Bounds& bounds) const {
    if (below(random, 2) == 0) bounds.min_W = {-1.5, 0.0, -2.5};
    if (below(random, 2) == 0) bounds.max_W.y() = 3.25;
  }
  void fill(const planning::FieldSpec&, correction::MotionLimits& limits) const {
    planning::visit_table(*this, limits);
  }
  /// Only the members that the policy uses are sent.
  void fill(const planning::FieldSpec& spec, correction::OrientationPolicy& policy) const {
    fill(spec, policy.rule);
    const geometry::Vec3 any = point(random);
    if (policy.rule == correction::OrientationRule::kLevel) {
      policy.up_W = planning::direction_of(any);
    }
    if (policy.rule == correction::OrientationRule::kTarget) {
      policy.target_W = any;
      fill(planning::option::kCone, policy.cone_rad);
    }
    (*this)(planning::option::kMaxTurn, policy.max_turn_rad);
  }
};

motion::PathMeasures measures(Random& random) {
  return {number(random), number(random), number(random), number(random), number(random),
          number(random), number(random), number(random), number(random), number(random)};
}

correction::Correction corrected(const collision::CollisionInterval& interval, Random& random) {
  correction::Correction correction;
  correction.interval = {interval.t_begin_s, interval.t_end_s};
  correction.kind = static_cast<correction::CorrectionKind>(below(random, 5));
  correction.t_begin_s = number(random);
  correction.t_end_s = number(random);
  correction.moved_m = number(random);
  correction.turned_rad = number(random);
  correction.shift = {number(random), number(random)};
  const auto count = [&] { return static_cast<std::int32_t>(below(random, 100'000)); };
  correction.tried = {count(), count(), count(), count()};
  return correction;
}

void add_report(planning::PlanResult& result, Random& random) {
  for (const collision::CollisionInterval& interval : result.collisions) {
    result.corrections.push_back(corrected(interval, random));
  }
  if (below(random, 2) == 0) result.measures_before = measures(random);
  if (below(random, 2) == 0) result.measures = measures(random);
  if (below(random, 2) == 0) result.viewing_distance_m = random.uniform(1.0, 10.0);
  result.bounds.max_W.y() = 2.5;
  result.near_scale = 0.75;
  result.time_scale = 1.25;
  result.deadline_reached = true;
  for (std::size_t i = 0; i < below(random, 5); ++i)
    result.slowed.push_back({number(random), number(random), number(random), number(random)});
  for (std::size_t i = 0; i < below(random, 5); ++i)
    result.clearance_profile.push_back({number(random), number(random), number(random)});
  for (std::size_t i = 0; i < below(random, 5); ++i) {
    planning::KeyframeFault& fault = result.keyframe_faults.emplace_back();
    fault.keyframe = i;
    fault.depth_m = number(random);
    if (below(random, 2) == 0) fault.free_pose = keyframe(0.0, random).pose;
  }
  planning::Infeasibility& proof = result.infeasibility.emplace();
  proof.keyframe_inside = 3;
  proof.keyframe_outside = 1;
  if (below(random, 2) == 0) {
    correction::CageBox& cage = proof.cage.emplace();
    cage.box = geometry::Box(geometry::Vec3(1, 2, 3), geometry::Vec3(4, 6, 8));
    cage.orientation = keyframe(0.0, random).pose.orientation;
    cage.widest_hole_m = number(random);
    cage.shortest_chord_m = number(random);
  }
  for (std::uint32_t i = 0; i < 60 * result.collisions.size(); ++i)
    proof.triangles.push_back(2 * i);
}

}  // namespace

planning::PlanOptions sample_options(Random& random) {
  planning::PlanOptions options;
  planning::visit_table(OptionFiller{random}, options);
  return options;
}

planning::PlanRequest sample_request(std::size_t keyframes, Random& random) {
  planning::PlanRequest request;
  request.scene = "room";
  request.camera = {1.5, 1.0, 0.1};
  request.has_times = below(random, 2) == 0;
  request.options = sample_options(random);
  // The service's tests plan it: neither for long nor with the paper's method.
  request.options.method = planning::Method::kLadder;
  request.options.deadline_s = 3.25;
  request.options.chord_error_m = 0.0078125;
  request.options.interval_tolerance_m = 1e-5;
  request.options.clearance_m = 0.0625;
  request.options.max_shrink = 0.375;
  request.options.max_inserted_keyframes = below(random, 2) == 0 ? 17 : 0;
  if (request.has_times) request.options.default_speed_m_per_s.reset();
  for (std::size_t i = 0; i < keyframes; ++i) {
    request.keyframes.push_back(keyframe(0.5 * static_cast<double>(i), random));
  }
  if (request.has_times && below(random, 2) == 0) {
    request.frame = add_frame(request.keyframes, random);
  }
  return request;
}

std::vector<std::optional<motion::BodyShape>> sample_bodies(Random& random) {
  const auto points = [&](std::size_t count) {
    std::vector<geometry::Vec3> list(count);
    for (geometry::Vec3& p : list) p = point(random);
    return list;
  };
  return {std::nullopt,
          motion::BoxShape{point(random), point(random).cwiseAbs()},
          motion::SphereShape{point(random), 0.25},
          motion::ConvexShape{{points(4), points(1), points(7)}},
          motion::MeshShape{points(4), {{0, 1, 2}, {0, 2, 3}}},
          motion::MeshShape{points(4), {{0, 1, 2}, {0, 2, 3}}, /*solid=*/true}};
}

motion::BodyShape largest_body(Random& random) {
  motion::MeshShape mesh;
  for (std::size_t i = 0; i < motion::kMaxBodyVertices; ++i) {
    mesh.vertices_C.push_back(point(random));
  }
  constexpr auto kVertices = static_cast<std::uint32_t>(motion::kMaxBodyVertices);
  for (std::uint32_t i = 0; i < motion::kMaxBodyTriangles; ++i) {
    mesh.triangles.push_back({i % kVertices, (i + 1) % kVertices, (i + 2) % kVertices});
  }
  return mesh;
}

planning::PlanResult sample_result(std::size_t segments, Random& random) {
  planning::PlanResult result;
  result.status = planning::Status::kPartial;
  result.message = "2 of the path's collisions remain";
  std::vector<motion::Segment> path;
  for (std::size_t i = 0; i < segments; ++i) {
    const double t0_s = 0.1 * static_cast<double>(i);
    path.push_back(segment(t0_s, 0.1 * static_cast<double>(i + 1), random));
    for (const motion::KeyframeOrigin origin :
         {motion::KeyframeOrigin::kGiven, motion::KeyframeOrigin::kInserted}) {
      result.keyframes.push_back(keyframe(t0_s, random));
      result.keyframes.back().origin = origin;
      result.keyframes.back().is_repaired = below(random, 2) == 0;
    }
    result.collisions.push_back({t0_s, t0_s + 0.01});
    result.collision_names.emplace_back();
    if (below(random, 3) == 0) continue;
    result.collisions.back().witness = witness(t0_s, random);
    result.collision_names.back() = {"object " + std::string(below(random, 20), 'x'), "edge 2"};
  }
  if (!path.empty()) result.path = motion::Path(std::move(path));
  result.remaining_collisions = {{0.125, 0.25}, {0.5, 0.5, witness(0.5, random)}};
  result.remaining_names = {{"", ""}, {"chair", "corner 0"}};
  result.certificate = {true, 0.0123};
  result.timing = {0.0, 1.5, 2.5, 3.5, 4.5, 12.0};
  add_report(result, random);
  if (below(random, 2) == 0) result.frame = add_frame(result.keyframes, random);
  return result;
}

std::shared_ptr<const scene::Snapshot> empty_scene(std::string name) {
  auto snapshot = std::make_shared<scene::Snapshot>();
  snapshot->name = std::move(name);
  snapshot->revision = 7;
  snapshot->digest = "0123456789abcdef0123456789abcdef";
  return snapshot;
}

}  // namespace camway::testing
