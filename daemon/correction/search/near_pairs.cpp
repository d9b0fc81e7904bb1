// SPDX-License-Identifier: MIT
#include "daemon/correction/search/near_pairs.h"

#include <algorithm>
#include <cstdint>

namespace camway::correction {

namespace {

using geometry::Box;
using geometry::Triangle;
using geometry::Vec3;

/// Collects the pairs of features of two triangles.
class PairCollector {
 public:
  PairCollector(double keep_m, double horizon_m) : keep_m_(keep_m), reach_m_(keep_m + horizon_m) {}

  [[nodiscard]] double reach_m() const { return reach_m_; }
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

/// The triangles of the body that may be near a box, in the camera frame.
class PartFinder {
 public:
  explicit PartFinder(const motion::Body& body) : body_(body) {}

  /// Calls `use(number)` for each triangle whose box, or that of a leaf about it, meets `box_C`.
  template <class Use>
  void for_each_near(const Box& box_C, const Use& use) {
    if (body_.tree() == nullptr) {
      for (std::uint32_t i = 0; i < body_.triangles_C().size(); ++i) {
        if (geometry::bounds(body_.triangles_C()[i]).intersects(box_C)) use(i);
      }
      return;
    }
    const geometry::TriangleTree& tree = *body_.tree();
    waiting_ = {0};
    while (!waiting_.empty()) {
      const std::uint32_t number = waiting_.back();
      waiting_.pop_back();
      const geometry::TriangleTree::Node& node = tree.nodes()[number];
      if (!Box(node.center - node.half, node.center + node.half).intersects(box_C)) continue;
      if (node.is_leaf()) {
        for (std::uint32_t i = node.begin; i < node.end; ++i) use(tree.order()[i]);
      } else {
        waiting_.push_back(node.second_child);
        waiting_.push_back(number + 1);
      }
    }
  }

 private:
  const motion::Body& body_;
  std::vector<std::uint32_t> waiting_;
};

Vec3 to_world(const motion::Pose& pose, const Vec3& point_C) {
  return pose.position + pose.orientation * point_C;
}

/// The triangles of the scene that may be within `reach_m` of the body, each once.
std::vector<std::uint32_t> near_obstacles(const FreeSpace& space, const motion::Pose& pose,
                                          double reach_m) {
  const Box& box_C = space.body().box_C();
  const Vec3 half = pose.orientation.toRotationMatrix().cwiseAbs() * (0.5 * box_C.sizes()) +
                    Vec3::Constant(reach_m);
  const Vec3 center_W = to_world(pose, box_C.center());
  std::vector<std::uint32_t> obstacles;
  space.obstacles().index.for_each_touching(Box(center_W - half, center_W + half),
                                            [&](std::uint32_t index) {
                                              obstacles.push_back(index);
                                              return true;
                                            });
  std::ranges::sort(obstacles);
  const auto repeated = std::ranges::unique(obstacles);
  obstacles.erase(repeated.begin(), repeated.end());
  return obstacles;
}

}  // namespace

std::vector<NearPair> near_pairs(FreeSpace& space, const motion::Pose& pose, double horizon_m) {
  PairCollector collector(space.keep_m(), horizon_m);
  PartFinder finder(space.body());
  const Vec3 reach = Vec3::Constant(collector.reach_m());
  for (const std::uint32_t index : near_obstacles(space, pose, collector.reach_m())) {
    const Triangle obstacle = space.obstacles().index.triangle(index);
    Box box_C;
    for (const Vec3& vertex : obstacle) {
      box_C.extend(Vec3(pose.orientation.conjugate() * (vertex - pose.position)));
    }
    finder.for_each_near(Box(box_C.min() - reach, box_C.max() + reach), [&](std::uint32_t number) {
      Triangle part = space.body().triangles_C()[number];
      for (Vec3& vertex : part) vertex = to_world(pose, vertex);
      collector.add(part, obstacle);
    });
  }
  std::vector<NearPair>& pairs = collector.pairs();
  std::ranges::stable_sort(pairs, {}, &NearPair::gap_m);
  if (pairs.size() > kMostPairs) pairs.resize(kMostPairs);
  return std::move(pairs);
}

}  // namespace camway::correction
