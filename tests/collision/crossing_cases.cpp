// SPDX-License-Identifier: MIT
#include "tests/collision/crossing_cases.h"

#include <algorithm>
#include <cmath>

#include "tests/collision/crossing_paths.h"
#include "tests/collision/crossing_shapes.h"

namespace camway::testing {

namespace {

using geometry::Vec3;

// Returns a bound on the rounding of poses and distances in doubles, with a margin of a factor of a
// thousand. Tolerances and clearances of the campaign are larger.
double rounding_floor_m(double largest_coordinate_m) { return 1e-9 + 1e-12 * largest_coordinate_m; }

constexpr double kMostPathSize_m = 100.0;

// Size of a flat obstacle, in the size of the camera's path: it covers the whole path.
constexpr double kWide = 3.0;

// One attempt at a case. Each `make_*` returns false if the truth could not be certified; then the
// whole case is drawn again.
class CaseMaker {
 public:
  CaseMaker(Random& random, CrossingFamily family) : random_(random) {
    case_.family = family;
    case_.camera = random_camera(random);
    corners_C_ = motion::near_corners_C(case_.camera);
    radius_m_ = motion::body_radius_m(corners_C_);
    half_width_m_ = corners_C_[0].x();
    half_height_m_ = corners_C_[0].y();
    size_m_ = std::min(kMostPathSize_m, radius_m_ * random.log_uniform(0.1, 1000.0));
    place_W_ = random_place(random);
    case_.with_field = random.chance(0.1);
    floor_m_ = rounding_floor_m(place_W_.norm() + 4.0 * size_m_);
  }

  bool make() {
    switch (case_.family) {
      case CrossingFamily::kThinWall:
      case CrossingFamily::kZeroPlate:
      case CrossingFamily::kPole:
      case CrossingFamily::kInterior:
      case CrossingFamily::kParallel:
        return make_through();
      case CrossingFamily::kOnPiece:
        return make_on_piece();
      case CrossingFamily::kSwing:
        return make_swing();
      case CrossingFamily::kGrazeFace:
      case CrossingFamily::kGrazeTip:
      case CrossingFamily::kSpin:
        return make_graze();
      case CrossingFamily::kFreeFace:
      case CrossingFamily::kFreeTip:
      case CrossingFamily::kFreeSpin:
        return make_free();
      case CrossingFamily::kFreeSlot:
        return make_slot();
    }
    return false;
  }

  [[nodiscard]] CrossingCase& result() { return case_; }

 private:
  // --- Obstacles through a point of the quadrilateral at an instant ---

  bool make_through() {
    constexpr std::array<PathKind, 4> kKinds{PathKind::kStraight, PathKind::kSpin,
                                             PathKind::kSmooth, PathKind::kFree};
    case_.path =
        random_path(random_, kKinds[std::size_t(random_.integer(0, 3))], place_W_, size_m_);
    choose_instant();
    const RealVec3 point_W = pose_.to_world(choose_point());
    switch (case_.family) {
      case CrossingFamily::kThinWall:
        add_wall(point_W);
        break;
      case CrossingFamily::kZeroPlate:
        add_thin_plate(point_W, random_.direction().cast<Real>());
        break;
      case CrossingFamily::kPole:
        add_pole(point_W);
        break;
      case CrossingFamily::kInterior:
        add_speck(point_W);
        break;
      default:
        add_parallel_plate(point_W);
        break;
    }
    return finish_colliding();
  }

  // Picks an instant; half of the time one at which a detector that halves segments would split.
  void choose_instant() {
    segment_ = std::size_t(random_.integer(0, int(case_.path.segments().size()) - 1));
    if (random_.chance(0.5)) {
      const int parts = 1 << random_.integer(1, 12);
      u_ = double(random_.integer(1, parts - 1)) / parts;
    } else {
      u_ = on_grid(random_.uniform(0.001, 0.999));
    }
    look();
  }

  void look() { pose_ = precise_pose(case_.path.segments()[segment_], u_, radius_m_); }

  // Returns a point of the filled quadrilateral in the camera frame, sometimes very close to its
  // outline.
  RealVec3 choose_point() {
    const double margin = random_.log_uniform(1e-5, 0.5);
    const auto coordinate = [&](double half_m) {
      const double from_border = random_.chance(0.5) ? margin : random_.uniform(0.1, 1.0);
      return Real((random_.chance(0.5) ? 1.0 : -1.0) * (1.0 - from_border) * half_m);
    };
    const Real x = coordinate(half_width_m_);
    return {x, coordinate(half_height_m_), -Real(case_.camera.near_m)};
  }

  [[nodiscard]] RealVec3 quad_normal() const { return pose_.orientation * RealVec3(0, 0, 1); }

  // Returns the approximate direction of motion at the instant; any direction for a pure rotation.
  RealVec3 heading() {
    const motion::Segment& segment = case_.path.segments()[segment_];
    const RealVec3 step = precise_pose(segment, std::min(1.0, u_ + 1e-4), radius_m_).position -
                          precise_pose(segment, std::max(0.0, u_ - 1e-4), radius_m_).position;
    const RealVec3 any = random_.direction().cast<Real>();
    return step.norm() > Real(1e-6 * radius_m_) ? RealVec3(step.normalized()) : any;
  }

  void add_wall(const RealVec3& point_W) {
    const RealVec3 normal = random_.chance(0.7) ? heading() : random_.direction().cast<Real>();
    const Real thickness_m = random_.log_uniform(1e-4, 1e-2) * std::min(1.0, 10.0 * radius_m_);
    const auto [e, f] = across(random_, normal);
    const Real a_m = radius_m_ * random_.log_uniform(0.1, 30.0);
    const Real b_m = radius_m_ * random_.log_uniform(0.1, 30.0);
    const RealVec3 center = point_W + thickness_m / 2 * normal +
                            random_.uniform(-0.5, 0.5) * a_m * e +
                            random_.uniform(-0.5, 0.5) * b_m * f;
    add_slab(case_.obstacle, center, thickness_m / 2 * normal, a_m * e, b_m * f);
  }

  void add_thin_plate(const RealVec3& point_W, const RealVec3& normal) {
    const auto [e, f] = across(random_, normal);
    const Real a_m = radius_m_ * random_.log_uniform(0.05, 30.0);
    const Real b_m = radius_m_ * random_.log_uniform(0.05, 30.0);
    add_plate(case_.obstacle,
              point_W + random_.uniform(-0.5, 0.5) * a_m * e + random_.uniform(-0.5, 0.5) * b_m * f,
              a_m * e, b_m * f);
  }

  // The tilt is so small that quadrilateral and plate meet for an instant, but large enough that
  // rounding the plate's vertices does not separate them.
  void add_parallel_plate(const RealVec3& point_W) {
    const double least =
        std::max(1e-9, 1e3 * 0x1p-53 * place_W_.norm() / std::min(half_width_m_, half_height_m_));
    const Real tilt = random_.log_uniform(std::min(0.01, least), 0.02);
    const RealVec3 sideways = across(random_, quad_normal())[0];
    add_thin_plate(point_W, (quad_normal() + tilt * sideways).normalized());
  }

  RealVec3 direction_through_quad() {
    RealVec3 direction = random_.direction().cast<Real>();
    while (std::abs(direction.dot(quad_normal())) < Real(0.1)) {
      direction = random_.direction().cast<Real>();
    }
    return direction;
  }

  void add_pole(const RealVec3& point_W) {
    const RealVec3 axis = direction_through_quad();
    const Real thickness_m = radius_m_ * random_.log_uniform(1e-4, 1e-2);
    const auto [e, f] = across(random_, axis);
    add_prism(case_.obstacle, point_W - radius_m_ * random_.log_uniform(0.5, 30.0) * axis,
              point_W + radius_m_ * random_.log_uniform(0.5, 30.0) * axis, thickness_m * e,
              thickness_m * f);
  }

  void add_speck(const RealVec3& point_W) {
    const RealVec3 inside_C(Real(random_.uniform(-0.7, 0.7) * half_width_m_),
                            Real(random_.uniform(-0.7, 0.7) * half_height_m_),
                            -Real(case_.camera.near_m));
    const Real size_m = std::min(half_width_m_, half_height_m_) * random_.log_uniform(1e-3, 0.1);
    const RealVec3 axis = direction_through_quad();
    const RealVec3 center = random_.chance(0.9) ? pose_.to_world(inside_C) : point_W;
    const RealVec3 side = across(random_, axis)[0];
    add_face(case_.obstacle, center - size_m * axis, center + size_m * axis,
             center + size_m * side);
  }

  // Moves straight at a plate that faces the camera. This is the tightest case for the motion
  // bound: half a stretch in front of the plate and half a stretch behind it, the distance equals
  // the motion of the camera.
  bool make_on_piece() {
    const motion::Pose from{place_W_, random_.rotation()};
    const Vec3 step_scale = from.orientation * Vec3(0.0, 0.0, random_.chance(0.5) ? -1.0 : 1.0);
    case_.path = uniform_path(from, place_W_ + size_m_ * step_scale);
    choose_instant();
    add_parallel_plate(pose_.to_world(choose_point()));
    return finish_colliding();
  }

  // The tightest case for rotation: each corner moves exactly by the bound of a rotation, and no
  // point of the quadrilateral is nearer to the wedge than the corner.
  bool make_swing() {
    const std::size_t corner = std::size_t(random_.integer(0, 3));
    const Vec3& corner_C = corners_C_[corner];
    const Vec3 outwards(corner_C.x(), corner_C.y(), 0.0);
    const Vec3 heading_C =
        (outwards - outwards.dot(corner_C) / corner_C.squaredNorm() * corner_C).normalized();
    case_.path = turning_path({place_W_, random_.rotation()},
                              corner_C.cross(heading_C).normalized(), random_.uniform(0.3, 3.0));
    choose_instant();
    normal_ = (pose_.orientation * heading_C.cast<Real>()).normalized();
    corner_W_ = pose_.to_world(corner_C.cast<Real>());
    const double least_m = 10.0 * floor_m_;
    depth_m_ = random_.log_uniform(least_m, std::max(2.0 * least_m, 1e-3 * radius_m_));
    add_wedge_behind_corner();
    return finish_colliding();
  }

  bool finish_colliding() {
    if (random_.chance(0.25)) add_dust(place_W_.cast<Real>(), size_m_);
    case_.collides = true;
    case_.known_s = static_cast<double>(segment_) + u_;
    case_.tolerance_m = std::max(floor_m_, radius_m_ * random_.log_uniform(1e-4, 0.1));
    for (std::size_t i = 0; i < case_.obstacle.triangles.size(); ++i) {
      if (certainly_touches(pose_, corners_C_, case_.obstacle.triangle(i))) return true;
    }
    return false;
  }

  // Adds other triangles, so that the index has something to divide.
  void add_dust(const RealVec3& center, double spread_m) {
    for (int i = 0; i < 40; ++i) {
      const RealVec3 at = center + (spread_m * random_.normal_vector(1.0)).cast<Real>();
      const auto corner = [&] {
        return RealVec3(at + (0.05 * radius_m_ * random_.normal_vector(1.0)).cast<Real>());
      };
      const RealVec3 a = corner();
      const RealVec3 b = corner();
      add_face(case_.obstacle, a, b, corner());
    }
  }

  // --- Obstacles that the camera's furthest reach passes by a known amount ---

  // Finds the reach along a random direction. Returns false if it cannot be proved to
  // `depth_m_`/1000.
  bool choose_reach(PathKind kind) {
    case_.path = random_path(random_, kind, place_W_, size_m_);
    const double least_m = std::max({1e-6, 10.0 * floor_m_, 1e-7 * size_m_});
    depth_m_ = random_.log_uniform(least_m, std::max(2.0 * least_m, 0.3 * radius_m_));
    normal_ = random_.direction().cast<Real>().normalized();
    const std::optional<Reach> reach =
        furthest_reach(case_.path, corners_C_, normal_, Real(depth_m_) / 1000);
    if (!reach) return false;
    reach_ = *reach;
    segment_ = reach_.segment;
    u_ = reach_.u;
    look();
    corner_W_ = pose_.to_world(corners_C_[reach_.corner].cast<Real>());
    return true;
  }

  [[nodiscard]] PathKind curved_path() {
    if (case_.family == CrossingFamily::kSpin || case_.family == CrossingFamily::kFreeSpin) {
      return PathKind::kSpin;
    }
    return random_.chance(0.5) ? PathKind::kSmooth : PathKind::kFree;
  }

  [[nodiscard]] bool of_a_face() const {
    return case_.family == CrossingFamily::kGrazeFace || case_.family == CrossingFamily::kFreeFace;
  }

  void add_wide_plate(const RealVec3& center, const RealVec3& normal) {
    const auto [e, f] = across(random_, normal);
    const Real half_m = kWide * 4.0 * (size_m_ + radius_m_);
    add_plate(case_.obstacle, center, half_m * e, half_m * f);
  }

  // Adds a triangle with its tip at `tip` that widens along `normal`, in the plane of `normal` and
  // `side`.
  void add_wedge(const RealVec3& tip, const RealVec3& side, Real slope) {
    const Real length_m = radius_m_ * random_.log_uniform(0.1, 10.0);
    add_face(case_.obstacle, tip, tip + length_m * (normal_ + slope * side),
             tip + length_m * (normal_ - slope * side));
  }

  bool make_graze() {
    if (!choose_reach(curved_path())) return false;
    if (of_a_face()) {
      add_wide_plate(corner_W_ - Real(depth_m_) * normal_, normal_);
      return finish_colliding();
    }
    add_wedge_behind_corner();
    return finish_colliding();
  }

  // Cuts the corner off just behind its tip, across the line to the centre.
  void add_wedge_behind_corner() {
    const RealVec3 inwards = pose_.to_world(RealVec3(0, 0, -Real(case_.camera.near_m))) - corner_W_;
    const RealVec3 side = normal_.cross(inwards).normalized();
    const Real slope = random_.log_uniform(0.05, 20.0);
    const Real behind =
        std::min(Real(1e-2), Real(0.05) * std::min(Real(1), slope) * depth_m_ / inwards.norm());
    add_wedge(corner_W_ + behind * inwards - Real(depth_m_) * normal_, side, slope);
  }

  bool make_free() {
    if (!choose_reach(curved_path())) return false;
    const RealVec3 nearest = corner_W_ + Real(depth_m_) * normal_;
    if (of_a_face()) {
      add_wide_plate(nearest, normal_);
    } else {
      add_wedge(nearest, across(random_, normal_)[0], random_.log_uniform(0.05, 20.0));
    }
    const Real below_m = of_a_face() ? highest_along_normal() - normal_.dot(corner_W_)
                                     : (vertex(0) - corner_W_).norm();
    if (random_.chance(0.25)) {
      add_dust(corner_W_ + Real(depth_m_ + 6.0 * size_m_ + 2.0 * radius_m_) * normal_, size_m_);
    }
    return finish_free(lowest_along_normal() - reach_.value_m, below_m);
  }

  bool make_slot() {
    // Half of the time the path is straight between the plates: the camera has this clearance all
    // the way, and the proof takes a probe for every clearance of travel.
    const bool straight = random_.chance(0.5);
    if (!choose_reach(straight ? PathKind::kStraight : curved_path())) return false;
    if (straight) {
      const RealVec3 along =
          (case_.path.segments()[0].position[3] - case_.path.segments()[0].position[0])
              .cast<Real>();
      normal_ = across(random_, along.normalized())[0];
      depth_m_ = std::max(depth_m_, 0.02 * size_m_);
    }
    const Real slack_m = Real(depth_m_) / 1000;
    const std::optional<Reach> there = furthest_reach(case_.path, corners_C_, normal_, slack_m);
    const RealVec3 opposite = -normal_;
    const std::optional<Reach> back = furthest_reach(case_.path, corners_C_, opposite, slack_m);
    if (!there || !back) return false;
    segment_ = there->segment;
    u_ = there->u;
    look();
    corner_W_ = pose_.to_world(corners_C_[there->corner].cast<Real>());
    add_wide_plate(corner_W_ + Real(depth_m_) * normal_, normal_);
    const Real above_m = lowest_along_normal() - there->value_m;
    const Real below_m = highest_along_normal() - normal_.dot(corner_W_);
    const Real other_m = Real(depth_m_) * random_.uniform(1.01, 3.0);
    const std::size_t first = case_.obstacle.vertices.size();
    add_wide_plate(corner_W_ + (there->value_m - normal_.dot(corner_W_)) * normal_ +
                       (there->value_m + back->value_m + other_m) * opposite,
                   normal_);
    Real other_above_m = other_m;
    for (std::size_t i = first; i < case_.obstacle.vertices.size(); ++i) {
      other_above_m = std::min(other_above_m, opposite.dot(vertex(i)) - back->value_m);
    }
    return finish_free(std::min(above_m, other_above_m), below_m);
  }

  [[nodiscard]] RealVec3 vertex(std::size_t i) const {
    return case_.obstacle.vertices[i].cast<Real>();
  }
  [[nodiscard]] Real lowest_along_normal() const {
    Real lowest = std::numeric_limits<Real>::max();
    for (std::size_t i = 0; i < case_.obstacle.vertices.size(); ++i) {
      lowest = std::min(lowest, normal_.dot(vertex(i)));
    }
    return lowest;
  }
  [[nodiscard]] Real highest_along_normal() const {
    Real highest = std::numeric_limits<Real>::lowest();
    for (std::size_t i = 0; i < case_.obstacle.vertices.size(); ++i) {
      highest = std::max(highest, normal_.dot(vertex(i)));
    }
    return highest;
  }

  bool finish_free(Real above_m, Real below_m) {
    // The rounding of a dot product of coordinates of this size, and of the path's point in it.
    const Real error_m =
        pose_.error_m + 64 * kRealRoundoff * Real(place_W_.norm() + 20.0 * (size_m_ + radius_m_));
    case_.collides = false;
    case_.known_s = static_cast<double>(segment_) + u_;
    case_.clearance_above_m = double(above_m - error_m) * (1.0 - 0x1p-50);
    case_.clearance_below_m = double(below_m + error_m) * (1.0 + 0x1p-50);
    case_.tolerance_m = case_.clearance_above_m * random_.uniform(0.3, 0.9);
    return case_.clearance_above_m > 2.0 * floor_m_;
  }

  Random& random_;
  CrossingCase case_;
  motion::Corners corners_C_;
  double radius_m_ = 0.0;
  double half_width_m_ = 0.0;
  double half_height_m_ = 0.0;
  double size_m_ = 0.0;
  double floor_m_ = 0.0;
  Vec3 place_W_;

  std::size_t segment_ = 0;
  double u_ = 0.0;
  PrecisePose pose_{};
  double depth_m_ = 0.0;
  RealVec3 normal_;
  RealVec3 corner_W_;
  Reach reach_{};
};

}  // namespace

std::string_view to_string(CrossingFamily family) {
  constexpr std::array<std::string_view, kCrossingFamilies> kNames{
      "thin wall",  "zero plate", "pole", "interior",  "parallel", "on piece",  "swing",
      "graze face", "graze tip",  "spin", "free face", "free tip", "free spin", "free slot"};
  return kNames[static_cast<std::size_t>(family)];
}

CrossingCase make_crossing_case(std::uint64_t seed, std::uint64_t index) {
  Random random = Random::of_case(seed, index);
  const auto family = static_cast<CrossingFamily>(index % kCrossingFamilies);
  for (int redrawn = 0;; ++redrawn) {
    CaseMaker maker(random, family);
    if (!maker.make()) continue;
    maker.result().redrawn = redrawn;
    return maker.result();
  }
}

}  // namespace camway::testing
