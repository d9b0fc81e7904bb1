// SPDX-License-Identifier: MIT
#include <algorithm>

#include "daemon/geometry/rounding.h"
#include "daemon/scene/index/node_splitter.h"

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
  EntryBounds below;
  EntryBounds above;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3& a = triangle[i];
    const Vec3& b = triangle[(i + 1) % 3];
    const std::array<double, 4> from = {a[0], a[1], a[2], 0.0};
    if (a[axis] <= at) below.extend(from, from);
    if (a[axis] >= at) above.extend(from, from);
    if ((a[axis] < at && b[axis] > at) || (a[axis] > at && b[axis] < at)) {
      const double t = (at - a[axis]) / (b[axis] - a[axis]);
      const Vec3 p = a + t * (b - a);
      const std::array<double, 4> on_plane = {p[0], p[1], p[2], 0.0};
      below.extend(on_plane, on_plane);
      above.extend(on_plane, on_plane);
    }
  }
  low = high = entry;
  below.clip(low, error_m_);
  above.clip(high, error_m_);
  const auto k = static_cast<std::size_t>(axis);
  low.high_m[k] = std::min(low.high_m[k], at);
  high.low_m[k] = std::max(high.low_m[k], at);
}

double half_area_m2(const Box& box) {
  if (box.isEmpty()) return 0.0;
  const Vec3 size = box.sizes();
  constexpr double kThin = 0x1p-10;
  return size.x() * size.y() + size.y() * size.z() + size.z() * size.x() +
         kThin * size.squaredNorm();
}

}  // namespace camway::scene
