// SPDX-License-Identifier: MIT
#include "tests/collision/precise_pose.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace camway::testing {

namespace {

using RealVec4 = Eigen::Matrix<Real, 4, 1>;

template <class Value, std::size_t N>
Value de_casteljau(std::array<Value, N> points, Real u) {
  for (std::size_t count = N - 1; count > 0; --count) {
    for (std::size_t i = 0; i < count; ++i) {
      points[i] = Value((1 - u) * points[i] + u * points[i + 1]);
    }
  }
  return points[0];
}

std::array<RealVec3, 4> positions(const motion::Segment& segment) {
  std::array<RealVec3, 4> points;
  for (std::size_t i = 0; i < 4; ++i) points[i] = segment.position[i].cast<Real>();
  return points;
}

std::array<RealVec4, 7> orientations(const motion::Segment& segment) {
  std::array<RealVec4, 7> points;
  for (std::size_t i = 0; i < 7; ++i) points[i] = segment.orientation[i].cast<Real>();
  return points;
}

template <std::size_t N, class Value>
Real longest(const std::array<Value, N>& points) {
  Real length = 0;
  for (const Value& point : points) length = std::max(length, point.norm());
  return length;
}

// A polynomial on [0, 1] by its Bernstein coefficients.
using Polynomial = std::vector<Real>;

// Pascal's triangle, exact.
constexpr std::size_t kHighestDegree = 15;
constexpr auto kChoose = [] {
  std::array<std::array<Real, kHighestDegree + 1>, kHighestDegree + 1> table{};
  for (std::size_t n = 0; n <= kHighestDegree; ++n) {
    table[n][0] = 1;
    for (std::size_t k = 1; k <= n; ++k) table[n][k] = table[n - 1][k - 1] + table[n - 1][k];
  }
  return table;
}();

Polynomial times(const Polynomial& a, const Polynomial& b) {
  const std::size_t p = a.size() - 1;
  const std::size_t q = b.size() - 1;
  Polynomial product(p + q + 1, Real(0));
  for (std::size_t i = 0; i <= p; ++i) {
    const Real scaled = kChoose[p][i] * a[i];
    for (std::size_t j = 0; j <= q; ++j) product[i + j] += scaled * (kChoose[q][j] * b[j]);
  }
  for (std::size_t k = 0; k <= p + q; ++k) product[k] /= kChoose[p + q][k];
  return product;
}

void add(Polynomial& sum, Real factor, const Polynomial& other) {
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += factor * other[i];
}

// The reach of one corner along a direction on one segment, as `excess / weight`.
struct CornerReach {
  Polynomial numerator;  // normal·((P - origin)·W + N), degree 15
  Polynomial weight;     // W, elevated to degree 15

  [[nodiscard]] Polynomial excess_over(Real level_m) const {
    Polynomial excess = numerator;
    add(excess, -level_m, weight);
    return excess;
  }
};

// normal·(Q v Q̄) is a quadratic form in the coefficients of Q; this is its matrix, from the
// rotation matrix of a quaternion that is not normalised.
Eigen::Matrix<Real, 4, 4> turned_form(const RealVec3& normal, const RealVec3& v) {
  const RealVec3 cross = v.cross(normal);
  Eigen::Matrix<Real, 4, 4> form;
  form(0, 0) = normal.dot(v);
  form.template block<3, 1>(1, 0) = cross;
  form.template block<1, 3>(0, 1) = cross.transpose();
  form.template block<3, 3>(1, 1) = normal * v.transpose() + v * normal.transpose() -
                                    normal.dot(v) * Eigen::Matrix<Real, 3, 3>::Identity();
  return form;
}

CornerReach corner_reach(const motion::Segment& segment, const geometry::Vec3& corner_C,
                         const RealVec3& normal, const RealVec3& origin) {
  const std::array<RealVec4, 7> q = orientations(segment);
  std::array<Polynomial, 4> component;
  for (Eigen::Index k = 0; k < 4; ++k) {
    for (const RealVec4& point : q) component[std::size_t(k)].push_back(point[k]);
  }
  const Eigen::Matrix<Real, 4, 4> form = turned_form(normal, corner_C.cast<Real>());
  Polynomial turned(13, Real(0));
  Polynomial weight(13, Real(0));
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i; j < 4; ++j) {
      const Polynomial product = times(component[i], component[j]);
      add(turned, (i == j ? 1 : 2) * form(Eigen::Index(i), Eigen::Index(j)), product);
      if (i == j) add(weight, 1, product);
    }
  }
  Polynomial along;
  for (const RealVec3& point : positions(segment)) along.push_back(normal.dot(point - origin));
  const Polynomial one(4, Real(1));
  CornerReach reach{times(along, weight), times(weight, one)};
  add(reach.numerator, 1, times(turned, one));
  return reach;
}

void split(const Polynomial& whole, Polynomial& left, Polynomial& right) {
  Polynomial points = whole;
  left.clear();
  right.assign(whole.size(), Real(0));
  for (std::size_t count = whole.size(); count > 0; --count) {
    left.push_back(points.front());
    right[count - 1] = points[count - 1];
    for (std::size_t i = 0; i + 1 < count; ++i) points[i] = (points[i] + points[i + 1]) / 2;
  }
}

// Limits of the work for a bound: a reach that is constant over a time range needs endless
// splitting.
constexpr int kMostSplits = 400;
constexpr int kDeepest = 40;

enum class Verdict { kBelow, kAbove, kUnknown };

// Returns whether `excess` is negative on all of [u0, u1]. If it is positive in the middle of a
// part, sets `where`.
Verdict stays_below(const Polynomial& excess, Real error, double u0, double u1, int depth,
                    int& splits, double& where) {
  if (*std::max_element(excess.begin(), excess.end()) < -error) return Verdict::kBelow;
  if (depth == kDeepest || ++splits > kMostSplits) return Verdict::kUnknown;
  Polynomial left;
  Polynomial right;
  split(excess, left, right);
  const double middle = 0.5 * (u0 + u1);
  if (right.front() > error) {
    where = middle;
    return Verdict::kAbove;
  }
  const Verdict first = stays_below(left, error, u0, middle, depth + 1, splits, where);
  if (first != Verdict::kBelow) return first;
  return stays_below(right, error, middle, u1, depth + 1, splits, where);
}

// The search for the reach of one path along one direction.
class ReachSearch {
 public:
  ReachSearch(const motion::Path& path, const motion::Corners& corners_C, const RealVec3& normal)
      : path_(path), corners_C_(corners_C), normal_(normal) {
    // Coordinates relative to a point of the path, so that a path far away loses no precision.
    origin_ = path.segments().front().position[0].cast<Real>();
    radius_m_ = motion::body_radius_m(corners_C);
  }

  std::optional<Reach> run(Real slack_m) {
    sample();
    constexpr int kRestarts = 8;
    for (int restart = 0; restart < kRestarts; ++restart) {
      climb();
      const Verdict verdict = prove(best_.reached_m + slack_m);
      if (verdict == Verdict::kUnknown) return std::nullopt;
      if (verdict == Verdict::kBelow) {
        best_.value_m = best_.reached_m + slack_m + normal_.dot(origin_);
        best_.reached_m += normal_.dot(origin_);
        return best_;
      }
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] Real at(std::size_t segment, double u, std::size_t corner) const {
    const PrecisePose pose = precise_pose(path_.segments()[segment], u, radius_m_);
    const RealVec3 point =
        pose.position - origin_ + pose.orientation * corners_C_[corner].cast<Real>();
    return normal_.dot(point);
  }

  void sample() {
    constexpr int kSamples = 12;
    best_.reached_m = -std::numeric_limits<Real>::max();
    for (std::size_t segment = 0; segment < path_.segments().size(); ++segment) {
      for (int i = 0; i <= kSamples; ++i) {
        for (std::size_t corner = 0; corner < 4; ++corner) {
          consider(segment, double(i) / kSamples, corner);
        }
      }
    }
  }

  void consider(std::size_t segment, double u, std::size_t corner) {
    const double rounded = on_grid(u);
    const Real value_m = at(segment, rounded, corner);
    if (value_m > best_.reached_m) best_ = {0, value_m, segment, rounded, corner};
  }

  // Climbs to a local maximum on the present segment and corner, with decreasing steps.
  void climb() {
    for (double step = 0.05; step > kGrid; step *= 0.6) {
      const double u = best_.u;
      consider(best_.segment, std::min(1.0, u + step), best_.corner);
      consider(best_.segment, std::max(0.0, u - step), best_.corner);
    }
  }

  // Proves that the level is never exceeded. If it is exceeded somewhere, moves the best point
  // there.
  Verdict prove(Real level_m) {
    for (std::size_t s = 0; s < path_.segments().size(); ++s) {
      for (std::size_t corner = 0; corner < 4; ++corner) {
        const CornerReach reach =
            corner_reach(path_.segments()[s], corners_C_[corner], normal_, origin_);
        const Real largest_weight = *std::max_element(reach.weight.begin(), reach.weight.end());
        Real size_m = std::abs(level_m) + radius_m_;
        for (const RealVec3& point : positions(path_.segments()[s])) {
          size_m = std::max(size_m, (point - origin_).norm() + radius_m_);
        }
        // Some hundred roundings of products that are at most this large.
        const Real error = 1024 * kRealRoundoff * size_m * largest_weight;
        int splits = 0;
        double where = 0.0;
        const Verdict verdict =
            stays_below(reach.excess_over(level_m), error, 0.0, 1.0, 0, splits, where);
        if (verdict == Verdict::kAbove) consider(s, where, corner);
        if (verdict != Verdict::kBelow) return verdict;
      }
    }
    return Verdict::kBelow;
  }

  const motion::Path& path_;
  const motion::Corners& corners_C_;
  RealVec3 normal_;
  RealVec3 origin_;
  double radius_m_ = 0.0;
  Reach best_{};
};

// Returns six times the signed volume of (a, b, c, d).
Real volume(const RealVec3& a, const RealVec3& b, const RealVec3& c, const RealVec3& d) {
  return (b - a).cross(c - a).dot(d - a);
}

// Returns whether the segment passes through the inside of the triangle, with every volume beyond
// `error`.
bool pierces(const RealVec3& from, const RealVec3& to, const std::array<RealVec3, 3>& t,
             Real error) {
  const Real below = volume(t[0], t[1], t[2], from);
  const Real above = volume(t[0], t[1], t[2], to);
  if (std::min(std::abs(below), std::abs(above)) <= error || (below > 0) == (above > 0)) {
    return false;
  }
  const Real sign = below > 0 ? 1 : -1;
  for (std::size_t i = 0; i < 3; ++i) {
    if (sign * volume(from, to, t[i], t[(i + 1) % 3]) >= -error) return false;
  }
  return true;
}

}  // namespace

RealVec3 PrecisePose::to_world(const RealVec3& point_C) const {
  return position + orientation * point_C;
}

RealVec3 PrecisePose::to_camera(const geometry::Vec3& point_W) const {
  return orientation.conjugate() * RealVec3(point_W.cast<Real>() - position);
}

PrecisePose precise_pose(const motion::Segment& segment, double u, double reach_m) {
  const std::array<RealVec4, 7> control = orientations(segment);
  const RealVec4 q = de_casteljau(control, Real(u));
  const Real length = q.norm();
  const RealVec4 unit = q / length;
  const Real error_m = kRealRoundoff * (32 * longest(positions(segment)) +
                                        256 * Real(reach_m) * (longest(control) / length));
  return {de_casteljau(positions(segment), Real(u)),
          Eigen::Quaternion<Real>(unit[0], unit[1], unit[2], unit[3]), error_m};
}

bool certainly_touches(const PrecisePose& pose, const motion::Corners& corners_C,
                       const geometry::Triangle& triangle_W) {
  std::array<RealVec3, 3> triangle;
  std::array<RealVec3, 4> quad;
  Real size_m = 0;
  for (std::size_t i = 0; i < 4; ++i) quad[i] = corners_C[i].cast<Real>();
  for (std::size_t i = 0; i < 3; ++i) triangle[i] = pose.to_camera(triangle_W[i]);
  for (const RealVec3& a : triangle) {
    for (const RealVec3& b : quad) size_m = std::max(size_m, (a - b).norm());
  }
  size_m = std::max({size_m, (triangle[1] - triangle[0]).norm(), (triangle[2] - triangle[0]).norm(),
                     (quad[2] - quad[0]).norm()});
  // A volume is a sum of products of three differences. Each of its four points has the pose's
  // error, plus that of rotating a point at the triangle's distance, which the reach does not
  // cover.
  const Real point_error_m = pose.error_m + 256 * kRealRoundoff * size_m;
  const Real error = 16 * point_error_m * size_m * size_m;
  const std::array<std::array<RealVec3, 3>, 2> halves{
      {{quad[0], quad[1], quad[2]}, {quad[0], quad[2], quad[3]}}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (const std::array<RealVec3, 3>& half : halves) {
      if (pierces(triangle[i], triangle[(i + 1) % 3], half, error)) return true;
    }
  }
  for (std::size_t i = 0; i < 4; ++i) {
    if (pierces(quad[i], quad[(i + 1) % 4], triangle, error)) return true;
  }
  return false;
}

double on_grid(double u) { return std::round(u / kGrid) * kGrid; }

std::optional<Reach> furthest_reach(const motion::Path& path, const motion::Corners& corners_C,
                                    const RealVec3& normal_W, Real slack_m) {
  return ReachSearch(path, corners_C, normal_W).run(slack_m);
}

}  // namespace camway::testing
