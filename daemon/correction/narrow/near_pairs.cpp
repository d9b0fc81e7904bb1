// SPDX-License-Identifier: MIT
#include "daemon/correction/narrow/near_pairs.h"

#include <algorithm>
#include <compare>
#include <cstdint>
#include <utility>

#include "daemon/geometry/triangle_distance.h"

namespace camway::correction {

namespace {

using geometry::Box;
using geometry::Triangle;
using geometry::Vec3;

/// Pairs of triangles whose features are looked at. Chosen by measurement.
constexpr std::size_t kMostNear = 16'384;

/// Collects the pairs of features of two triangles.
class PairCollector {
 public:
  PairCollector(double keep_m, double horizon_m) : keep_m_(keep_m), reach_m_(keep_m + horizon_m) {}

  [[nodiscard]] std::vector<NearPair>& pairs() { return pairs_; }

  void add(const Triangle& part, const Triangle& obstacle) {
    for (const Vec3& vertex : part) add_over_face(vertex, obstacle, false);
    for (const Vec3& vertex : obstacle) add_over_face(vertex, part, true);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        add_edges(part[i], part[(i + 1) % 3], obstacle[k], obstacle[(k + 1) % 3]);
      }
    }
  }

 private:
  void add_pair(const Vec3& body_W, const Vec3& scene_W) {
    const Vec3 apart_W = body_W - scene_W;
    const double distance_m = apart_W.norm();
    if (!(distance_m > 0.0) || distance_m >= reach_m_) return;
    pairs_.push_back({body_W, apart_W / distance_m, distance_m - keep_m_});
  }

  /// The pair of a vertex and the point of the face straight below it.
  void add_over_face(const Vec3& vertex, const Triangle& face, bool is_face_of_body) {
    const Vec3 normal = (face[1] - face[0]).cross(face[2] - face[0]);
    const double square = normal.squaredNorm();
    if (!(square > 0.0)) return;
    const double height = normal.dot(vertex - face[0]) / square;
    if (height * height * square >= reach_m_ * reach_m_) return;
    const Vec3 below_W = vertex - height * normal;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 inward = normal.cross(face[(i + 1) % 3] - face[i]);
      if (inward.dot(below_W - face[i]) < 0.0) return;
    }
    is_face_of_body ? add_pair(below_W, vertex) : add_pair(vertex, below_W);
  }

  /// The nearest points of two edges.
  void add_edges(const Vec3& p, const Vec3& p_end, const Vec3& q, const Vec3& q_end) {
    const Vec3 along_p = p_end - p;
    const Vec3 along_q = q_end - q;
    const Vec3 between = p - q;
    const double pp = along_p.squaredNorm();
    const double qq = along_q.squaredNorm();
    if (!(pp > 0.0) || !(qq > 0.0)) return;
    const double pq = along_p.dot(along_q);
    const double determinant = pp * qq - pq * pq;
    double on_p = 0.0;
    if (determinant > 0.0) {
      on_p = std::clamp((pq * along_q.dot(between) - qq * along_p.dot(between)) / determinant, 0.0,
                        1.0);
    }
    const double on_q = std::clamp((pq * on_p + along_q.dot(between)) / qq, 0.0, 1.0);
    on_p = std::clamp((pq * on_q - along_p.dot(between)) / pp, 0.0, 1.0);
    add_pair(p + on_p * along_p, q + on_q * along_q);
  }

  const double keep_m_;
  const double reach_m_;
  std::vector<NearPair> pairs_;
};

/// A triangle of the scene and one of the body, by their numbers.
struct Triangles {
  std::uint32_t obstacle;
  std::uint32_t part;

  auto operator<=>(const Triangles&) const = default;
};

Triangle placed(const motion::Body& body, const motion::Pose& pose, std::uint32_t number) {
  Triangle part = body.triangles_C()[number];
  for (Vec3& vertex : part) vertex = pose.position + pose.orientation * vertex;
  return part;
}

struct NearTriangles {
  std::vector<Triangles> pairs;  ///< each once
  bool is_complete = true;       ///< false if the search ended at `kMostNear` of them
};

/// The triangles that are within `reach_m` of one another.
NearTriangles near_triangles(FreeSpace& space, const motion::Pose& pose, double reach_m) {
  const Vec3 reach = Vec3::Constant(reach_m);
  NearTriangles near;
  space.placed(pose).for_each_pair(reach_m, [&](std::uint32_t number, const Triangle& part,
                                                std::uint32_t index, const Triangle& obstacle) {
    const Box box = geometry::bounds(part);
    // The boxes of a slanted triangle overlap those of all about it, at any distance.
    if (Box(box.min() - reach, box.max() + reach).intersects(geometry::bounds(obstacle)) &&
        geometry::triangle_distance(part, obstacle, reach_m) <= reach_m) {
      near.pairs.push_back({index, number});
    }
    near.is_complete = near.pairs.size() < kMostNear;
    return near.is_complete;
  });
  std::ranges::sort(near.pairs);
  // Not std::ranges::unique: Clang 14 cannot compile that of GCC 12's library.
  near.pairs.erase(std::unique(near.pairs.begin(), near.pairs.end()), near.pairs.end());
  return near;
}

}  // namespace

std::vector<NearPair> near_pairs(FreeSpace& space, const motion::Pose& pose, double horizon_m) {
  NearTriangles near = near_triangles(space, pose, space.keep_m() + horizon_m);
  const double least_m = near.is_complete ? 0.0 : space.gap_m(pose, horizon_m);
  while (!near.is_complete && horizon_m > 2.0 * least_m) {
    NearTriangles nearer = near_triangles(space, pose, space.keep_m() + 0.5 * horizon_m);
    if (nearer.pairs.empty()) break;
    near = std::move(nearer);
    horizon_m *= 0.5;
  }
  PairCollector collector(space.keep_m(), horizon_m);
  for (const Triangles& triangles : near.pairs) {
    collector.add(placed(space.body(), pose, triangles.part),
                  space.obstacles().index.triangle(triangles.obstacle));
  }
  std::vector<NearPair>& pairs = collector.pairs();
  std::ranges::stable_sort(pairs, {}, &NearPair::gap_m);
  if (pairs.size() > kMostPairs) pairs.resize(kMostPairs);
  return std::move(pairs);
}

}  // namespace camway::correction
