// SPDX-License-Identifier: MIT
#include "daemon/correction/path/closeness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "daemon/base/largest_value.h"
#include "daemon/motion/path/bezier.h"
#include "daemon/motion/path/quaternion.h"

namespace camway::correction {

namespace {

using geometry::Vec3;
using geometry::Vec4;
using motion::CubicPath;
using motion::CubicPiece;

constexpr int kSamplesAPiece = 6;                       // of the shift; even, for Simpson's rule
constexpr double kBestSpacing = 12.0;                   // from the derivative of the cost of a bump
constexpr double kPercentile = 0.99;                    // of the acceleration
constexpr int kAccelerationSamples = 8;                 // in a piece
constexpr double kLeastAcceleration_m_per_s2 = 1e-150;  // the least whose square is far above 0

/// Second derivative of a cubic Bézier curve at u.
template <class Point>
Point second_derivative(const std::array<Point, 4>& points, double duration_s, double u) {
  const Point first = points[0] - 2.0 * points[1] + points[2];
  const Point last = points[1] - 2.0 * points[2] + points[3];
  return 6.0 / (duration_s * duration_s) * ((1.0 - u) * first + u * last);
}

bool is_same(const CubicPiece& a, const CubicPiece& b) {
  return a.t0_s == b.t0_s && a.t1_s == b.t1_s && a.position == b.position && a.image == b.image;
}

/// The part of a piece over the time of `of`, which lies in it.
CubicPiece part_of(const CubicPiece& piece, const CubicPiece& of) {
  if (piece.t0_s == of.t0_s && piece.t1_s == of.t1_s) return piece;
  const double duration_s = piece.t1_s - piece.t0_s;
  const double u0 = std::clamp((of.t0_s - piece.t0_s) / duration_s, 0.0, 1.0);
  const double u1 = std::clamp((of.t1_s - piece.t0_s) / duration_s, 0.0, 1.0);
  return {of.t0_s, of.t1_s, motion::bezier::sub_curve(piece.position, u0, u1),
          motion::bezier::sub_curve(piece.image, u0, u1)};
}

/// Calls `use(piece, before)` for each piece of `path` that differs from `before`, the part of
/// `original` at the same time.
template <class Use>
void for_each_pair(const CubicPath& path, const CubicPath& original, const Use& use) {
  std::size_t k = 0;
  for (const CubicPiece& piece : path.pieces) {
    const double middle_s = 0.5 * (piece.t0_s + piece.t1_s);
    while (k + 1 < original.pieces.size() && original.pieces[k].t1_s <= middle_s) ++k;
    const CubicPiece before = part_of(original.pieces[k], piece);
    if (!is_same(piece, before)) use(piece, before);
  }
}

double turn_rad(const Vec4& image, const Vec4& other) {
  using motion::quaternion::multiply;
  const Vec4 a = multiply(image, image).normalized();
  const Vec4 b = multiply(other, other).normalized();
  const double apart = std::min((a - b).norm(), (a + b).norm());
  return 4.0 * std::asin(std::min(1.0, 0.5 * apart));
}

/// The change of a piece from the one that it replaces: Bézier curves, too.
struct Change {
  std::array<Vec3, 4> moved_m;
  std::array<Vec4, 4> of_image;
  double duration_s;

  Change(const CubicPiece& now, const CubicPiece& before) : duration_s(now.t1_s - now.t0_s) {
    for (std::size_t i = 0; i < 4; ++i) {
      moved_m[i] = now.position[i] - before.position[i];
      of_image[i] = now.image[i] - before.image[i];
    }
  }

  /// Squared second derivative at u, with images by their lever.
  [[nodiscard]] double squared_acceleration(double u, const Closeness& closeness) const {
    const double lever_m = 4.0 * closeness.turn_lever_m;
    return second_derivative(moved_m, duration_s, u).squaredNorm() +
           lever_m * lever_m * second_derivative(of_image, duration_s, u).squaredNorm();
  }
};

double simpson_weight(int i, int steps) {
  return i == 0 || i == steps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
}

/// The shift of a piece, which takes the place of the piece `before` of the original path.
class PieceShift {
 public:
  /// `reference`: that of both paths.
  PieceShift(const CubicPiece& now, const CubicPiece& before, const Vec4& reference,
             const Closeness& closeness)
      : now_(now),
        before_(before),
        reference_(reference),
        closeness_(closeness),
        change_(now, before),
        turns_(now.image != before.image),
        swings_(turns_ && !closeness.center_C.isZero(0.0)) {}

  /// Returns the shift at u. [Units: radians]
  [[nodiscard]] double at(double u) const {
    using motion::bezier::value_at;
    Vec3 moved_m = value_at(change_.moved_m, u);
    if (swings_) moved_m += center_at(now_, u) - center_at(before_, u);
    const double turned_rad =
        turns_ ? turn_rad(value_at(now_.image, u), value_at(before_.image, u)) : 0.0;
    return (moved_m.norm() + closeness_.turn_lever_m * turned_rad) / closeness_.viewing_distance_m;
  }

  /// Returns ∫ shift dt. [Units: radian seconds]
  [[nodiscard]] double integral() const {
    double sum = 0.0;
    for (int i = 0; i <= kSamplesAPiece; ++i) {
      sum += simpson_weight(i, kSamplesAPiece) * at(static_cast<double>(i) / kSamplesAPiece);
    }
    return sum * change_.duration_s / (3.0 * kSamplesAPiece);
  }

  /// Returns the largest shift: between samples lies up to a thirtieth more. [Units: radians]
  [[nodiscard]] double largest() const {
    std::array<double, kSamplesAPiece + 1> places;
    for (int i = 0; i <= kSamplesAPiece; ++i) {
      places[static_cast<std::size_t>(i)] = static_cast<double>(i) / kSamplesAPiece;
    }
    return base::largest_value(places, [this](double u) { return at(u); });
  }

 private:
  /// Returns the way from the eye to the centre, in the world frame.
  [[nodiscard]] Vec3 center_at(const CubicPiece& piece, double u) const {
    const Vec4 image = motion::bezier::value_at(piece.image, u);
    return motion::pose_of(reference_, {Vec3::Zero(), image}).orientation * closeness_.center_C;
  }

  const CubicPiece& now_;
  const CubicPiece& before_;
  const Vec4& reference_;
  const Closeness& closeness_;
  const Change change_;
  const bool turns_;
  const bool swings_;  ///< turning moves the centre relative to the eye
};

}  // namespace

double Closeness::best_spacing_s(double height_m) const {
  const double product = kBestSpacing * kAccelerationWeight_rad * height_m * viewing_distance_m;
  return std::pow(product, 0.25) / std::sqrt(acceleration_m_per_s2);
}

Shift shift_of(const CubicPath& path, const CubicPath& original, const Closeness& closeness) {
  Shift shift;
  for_each_pair(path, original, [&](const CubicPiece& now, const CubicPiece& before) {
    const PieceShift piece(now, before, path.reference, closeness);
    shift.mean_rad += piece.integral();
    shift.largest_rad = std::max(shift.largest_rad, piece.largest());
  });
  shift.mean_rad /= path.end_s() - path.begin_s();
  return shift;
}

double closeness_cost(const CubicPath& path, const CubicPath& original,
                      const Closeness& closeness) {
  double cost = 0.0;
  const double a = closeness.acceleration_m_per_s2;
  for_each_pair(path, original, [&](const CubicPiece& now, const CubicPiece& before) {
    cost += PieceShift(now, before, path.reference, closeness).integral();
    // The offset's second derivative is linear: Simpson's rule is exact for its square.
    const Change change(now, before);
    const double squares = change.squared_acceleration(0.0, closeness) +
                           4.0 * change.squared_acceleration(0.5, closeness) +
                           change.squared_acceleration(1.0, closeness);
    cost += kAccelerationWeight_rad * squares * (now.t1_s - now.t0_s) / 6.0 / (a * a);
  });
  return cost;
}

double reference_acceleration_m_per_s2(const CubicPath& interpolated, double viewing_distance_m) {
  struct Sample {
    double acceleration;
    double duration_s;
  };
  std::vector<Sample> samples;
  double length_m = 0.0;
  double turned_rad = 0.0;
  for (const CubicPiece& piece : interpolated.pieces) {
    const double duration_s = piece.t1_s - piece.t0_s;
    turned_rad += turn_rad(piece.image.front(), piece.image.back());
    for (int i = 0; i < 3; ++i) {
      length_m += (piece.position[static_cast<std::size_t>(i) + 1] -
                   piece.position[static_cast<std::size_t>(i)])
                      .norm();
    }
    for (int i = 0; i < kAccelerationSamples; ++i) {
      const double u = (i + 0.5) / kAccelerationSamples;
      samples.push_back({second_derivative(piece.position, duration_s, u).norm(),
                         duration_s / kAccelerationSamples});
    }
  }
  const double whole_s = interpolated.end_s() - interpolated.begin_s();
  std::ranges::sort(samples, {}, &Sample::acceleration);
  double so_far_s = 0.0;
  double percentile = 0.0;
  for (const Sample& sample : samples) {
    percentile = sample.acceleration;
    so_far_s += sample.duration_s;
    if (so_far_s >= kPercentile * whole_s) break;
  }
  const double turned_m = kTurningShare * viewing_distance_m * turned_rad;
  const double speed_m_per_s = std::max(length_m, turned_m) / whole_s;
  const double least =
      std::max(speed_m_per_s * speed_m_per_s / viewing_distance_m, kLeastAcceleration_m_per_s2);
  return std::max(percentile, least);
}

}  // namespace camway::correction
