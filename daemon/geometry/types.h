// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>

#include <Eigen/Core>
#include <Eigen/Geometry>

/// The basic types of all other folders. Lengths are metres, the frame is right-handed.
namespace camway::geometry {

using Vec3 = Eigen::Vector3d;
using Vec4 = Eigen::Vector4d;
/// Hamilton quaternion. Eigen stores and prints (x, y, z, w); in our files and messages the order
/// is [w, x, y, z] (see `wxyz` and `from_wxyz`).
using Quat = Eigen::Quaterniond;
/// Axis-aligned box; `isEmpty()` for a default-constructed one.
using Box = Eigen::AlignedBox3d;

/// A triangle of points in one frame, metres. May be degenerate.
using Triangle = std::array<Vec3, 3>;

/// A straight segment of points in one frame, metres. May have length zero.
struct LineSegment {
  Vec3 from;
  Vec3 to;
};

/// Coefficients of `q` in the order of our files and messages.
inline Vec4 wxyz(const Quat& q) { return {q.w(), q.x(), q.y(), q.z()}; }

/// The inverse of `wxyz`. Does not normalise.
inline Quat from_wxyz(const Vec4& c) { return {c[0], c[1], c[2], c[3]}; }

/// Whether `a` comes before `b`: by x, then y, then z.
inline bool precedes(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

/// The smallest box that holds `triangle`.
inline Box bounds(const Triangle& triangle) {
  Box box(triangle[0]);
  box.extend(triangle[1]);
  box.extend(triangle[2]);
  return box;
}

}  // namespace camway::geometry
