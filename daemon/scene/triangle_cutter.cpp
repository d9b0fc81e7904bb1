// SPDX-License-Identifier: MIT
#include <algorithm>

#include "daemon/geometry/rounding.h"
#include "daemon/scene/index_dealer.h"

namespace camway::scene {

using geometry::Box;
using geometry::Triangle;
using geometry::Vec3;

TriangleCutter::TriangleCutter(const Mesh& mesh, const Box& bounds) : mesh_(mesh) {
  const double largest = bounds.min().cwiseAbs().cwiseMax(bounds.max().cwiseAbs()).maxCoeff();
  error_m_ = kCutErrorUnits * geometry::kUnitRoundoff * largest + geometry::kSmallestNormal;
}

void TriangleCutter::cut(const IndexEntry& entry, int axis, double at, IndexEntry& low,
                         IndexEntry& high) const {
  const Triangle triangle = mesh_.triangle(entry.triangle);
  Box below;
  Box above;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3& a = triangle[i];
    const Vec3& b = triangle[(i + 1) % 3];
    if (a[axis] <= at) below.extend(a);
    if (a[axis] >= at) above.extend(a);
    if ((a[axis] < at && b[axis] > at) || (a[axis] > at && b[axis] < at)) {
      const double t = (at - a[axis]) / (b[axis] - a[axis]);
      const Vec3 on_plane = a + t * (b - a);
      below.extend(on_plane);
      above.extend(on_plane);
    }
  }
  const Vec3 error = Vec3::Constant(error_m_);
  low.triangle = high.triangle = entry.triangle;
  low.box = Box(below.min() - error, below.max() + error).intersection(entry.box);
  high.box = Box(above.min() - error, above.max() + error).intersection(entry.box);
  low.box.max()[axis] = std::min(low.box.max()[axis], at);
  high.box.min()[axis] = std::max(high.box.min()[axis], at);
}

double half_area_m2(const Box& box) {
  if (box.isEmpty()) return 0.0;
  const Vec3 size = box.sizes();
  constexpr double kThin = 0x1p-10;
  return size.x() * size.y() + size.y() * size.z() + size.z() * size.x() +
         kThin * size.squaredNorm();
}

}  // namespace camway::scene
