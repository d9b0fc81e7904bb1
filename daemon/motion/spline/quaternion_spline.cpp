// SPDX-License-Identifier: MIT
#include "daemon/motion/spline/quaternion_spline.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include "daemon/motion/path/bezier.h"
#include "daemon/motion/path/quaternion.h"
#include "daemon/motion/spline/cubic_spline.h"
#include "daemon/motion/spline/reference_frame.h"

namespace camway::motion {
namespace {

using geometry::Vec3;
using geometry::Vec4;
using quaternion::conjugate;
using quaternion::multiply;

/// A point that x(t) interpolates.
struct Knot {
  double t_s;
  std::size_t keyframe;  ///< at it, or between it and the next
  Vec4 q;                ///< on S³, signs aligned
  Vec4 x;                ///< in the spline's space, unit length, sign free until `align_images`
};

/// The map from keyframes to points of R⁴.
struct Image {
  Vec4 reference;
  std::vector<Knot> knots;  ///< at the keyframes
};

/// Angle between two unit vectors; accurate for small angles too.
double angle_rad(const Vec4& a, const Vec4& b) {
  return 2.0 * std::atan2((a - b).norm(), (a + b).norm());
}

/// Angle between the lines that two unit vectors span.
double line_angle_rad(const Vec4& a, const Vec4& b) {
  return a.dot(b) < 0.0 ? angle_rad(a, Vec4(-b)) : angle_rad(a, b);
}

/// The root of the unit quaternion `u` that has no negative real part; sign arbitrary at u = -1.
Vec4 square_root(const Vec4& u) {
  Vec4 root = u;
  // 1 + w, without cancellation near w = -1.
  root[0] = u[0] >= 0.0 ? 1.0 + u[0] : u.tail<3>().squaredNorm() / (1.0 - u[0]);
  const double length = root.norm();
  if (!(length > 0.0)) return {0.0, 1.0, 0.0, 0.0};
  return root / length;
}

/// The axis of a half turn points to the side that has this sense: +1 or -1.
double half_turn_sense(const Vec3& axis) {
  // A unit vector has a component above 1/√3. Comparing with a little less makes the choice robust
  // where components are equal, as they often are in hand-made data.
  constexpr double kLeading = 0.43;
  for (const double component : {axis.x(), axis.y(), axis.z()}) {
    if (std::abs(component) > kLeading) return component > 0.0 ? 1.0 : -1.0;
  }
  return 1.0;
}

/// Knots with images on the great circle through all orientations, or nothing if there is none.
std::optional<Image> one_axis_image(std::span<const double> times_s, std::span<const Vec4> q) {
  const Vec4 inverse = conjugate(q[0]);
  Vec3 axis = Vec3::Zero();
  for (const Vec4& other : q) {
    const Vec3 turn = multiply(inverse, other).tail<3>();
    if (turn.squaredNorm() > axis.squaredNorm()) axis = turn;
  }
  if (axis.norm() > 0.0) axis.normalize();

  Image image{q[0], {}};
  for (std::size_t i = 0; i < q.size(); ++i) {
    const Vec4 turn = multiply(inverse, q[i]);
    const double along = axis.dot(turn.tail<3>());
    if ((turn.tail<3>() - along * axis).norm() > kOneAxisRounding) return std::nullopt;
    // Whole turns change only the sign of x, which is chosen afterwards: no angle grows large.
    const double half_rad = std::atan2(along, turn[0]) / 2.0;
    Vec4 x;
    x << std::cos(half_rad), std::sin(half_rad) * axis;
    image.knots.push_back({times_s[i], i, q[i], x});
  }
  return image;
}

Image general_image(std::span<const double> times_s, std::span<const Vec4> q) {
  Image image{reference_frame(q), {}};
  const Vec4 inverse = conjugate(image.reference);
  for (std::size_t i = 0; i < q.size(); ++i)
    image.knots.push_back({times_s[i], i, q[i], square_root(multiply(inverse, q[i]))});
  return image;
}

/// Knots with auxiliary ones where neighbours are too far apart.
class KnotRefinement {
 public:
  KnotRefinement(const Image& image, bool one_axis, const TimeOrigin& origin)
      : inverse_(conjugate(image.reference)), one_axis_(one_axis), origin_(origin) {
    knots_.push_back(image.knots.front());
    for (std::size_t i = 1; i < image.knots.size(); ++i) {
      add_between(image.knots[i - 1], image.knots[i], kMaxKnotHalvings);
      knots_.push_back(image.knots[i]);
    }
  }
  [[nodiscard]] std::vector<Knot> knots() && { return std::move(knots_); }

 private:
  void add_between(const Knot& from, const Knot& to, int halvings) {
    const double apart_rad = std::max(angle_rad(from.q, to.q), line_angle_rad(from.x, to.x));
    const double t_s = origin_.nearest_s(from.t_s + (to.t_s - from.t_s) / 2.0);
    if (apart_rad <= kLargestKnotAngle_rad || halvings == 0) return;
    if (!(from.t_s < t_s && t_s < to.t_s)) return;
    const Knot middle{t_s, from.keyframe, (from.q + to.q).normalized(), image_between(from, to)};
    add_between(from, middle, halvings - 1);
    knots_.push_back(middle);
    add_between(middle, to, halvings - 1);
  }

  [[nodiscard]] Vec4 image_between(const Knot& from, const Knot& to) const {
    const double sign = from.x.dot(to.x) < 0.0 ? -1.0 : 1.0;
    if (one_axis_) return (from.x + sign * to.x).normalized();
    return square_root(multiply(inverse_, (from.q + to.q).normalized()));
  }

  Vec4 inverse_;
  bool one_axis_;
  TimeOrigin origin_;
  std::vector<Knot> knots_;
};

/// Signs of x such that the spline never has to turn by more than 90° between knots.
void align_images(std::vector<Knot>& knots) {
  for (std::size_t i = 1; i < knots.size(); ++i) {
    if (knots[i].x.dot(knots[i - 1].x) < 0.0) knots[i].x = -knots[i].x;
  }
}

}  // namespace

std::array<Vec4, 7> orientation_of(const Vec4& reference, const std::array<Vec4, 4>& image) {
  std::array<Vec4, 7> q = bezier::product(image, image, multiply);
  for (Vec4& coefficient : q) coefficient = multiply(reference, coefficient);
  return q;
}

Vec4 image_of(const Vec4& reference, const Vec4& orientation, const Vec4& near) {
  const Vec4 x = square_root(multiply(conjugate(reference), orientation));
  return x.dot(near) < 0.0 ? Vec4(-x) : x;
}

std::vector<Vec4> aligned_orientations(std::span<const Vec4> orientations) {
  std::vector<Vec4> aligned;
  aligned.reserve(orientations.size());
  for (const Vec4& given : orientations) {
    Vec4 q = given.normalized();
    if (!aligned.empty()) {
      const Vec4 turn = multiply(conjugate(aligned.back()), q);
      const double sense =
          std::abs(turn[0]) > kHalfTurnRounding ? turn[0] : half_turn_sense(turn.tail<3>());
      if (sense < 0.0) q = -q;
    }
    aligned.push_back(q);
  }
  return aligned;
}

ImageSpline quaternion_spline(std::span<const double> times_s, std::span<const Vec4> orientations,
                              const TimeOrigin& origin) {
  assert(times_s.size() == orientations.size() && times_s.size() >= 2);
  const std::vector<Vec4> q = aligned_orientations(orientations);
  const std::optional<Image> one_axis = one_axis_image(times_s, q);
  const Image image = one_axis ? *one_axis : general_image(times_s, q);
  std::vector<Knot> knots = KnotRefinement(image, one_axis.has_value(), origin).knots();
  align_images(knots);

  std::vector<double> t_s;
  std::vector<Vec4> x;
  for (const Knot& knot : knots) {
    t_s.push_back(knot.t_s);
    x.push_back(knot.x);
  }
  const std::vector<Vec4> slopes = spline_slopes<Vec4>(t_s, x, EndCondition::kBessel);
  ImageSpline spline{image.reference, {}};
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    spline.pieces.push_back(
        {t_s[i], t_s[i + 1], knots[i].keyframe, spline_piece<Vec4>(t_s, x, slopes, i)});
  }
  return spline;
}

}  // namespace camway::motion
