// SPDX-License-Identifier: MIT
#include "daemon/scene/import/surfaces/edge_refinement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "daemon/scene/import/surfaces/nurbs_surface.h"
#include "daemon/scene/import/surfaces/surface_points.h"

namespace camway::scene::surfaces {
namespace {

/// How often a side is halved. A side of which a millionth still slides has a fault that halving
/// does not mend.
constexpr int kMostRounds = 20;

/// Two nodes, in the direction of a triangle, or the smaller index first.
using Side = std::array<std::uint32_t, 2>;

Side sorted(const Side& side) { return {std::min(side[0], side[1]), std::max(side[0], side[1])}; }

/// Parts of a side at which its slide is measured. A side that bends to both sides alike does not
/// slide in its middle.
constexpr std::array<double, 3> kSlideParts = {0.25, 0.5, 0.75};

template <std::size_t N>
std::array<double, N> between(const std::array<double, N>& a, const std::array<double, N>& b,
                              double part) {
  std::array<double, N> result;
  for (std::size_t k = 0; k < N; ++k) result[k] = (1.0 - part) * a[k] + part * b[k];
  return result;
}

double gap_between(const Point& a, const Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// A node, which the mesh need not have yet.
struct SplitNode {
  Parameters at{};
  Point point{};
  double off = 0.0;          ///< distance of the point from the surface
  std::uint32_t number = 0;  ///< in the mesh, once it is there
};

/// A triangle by places: 0 to 2 are the corners, 3 + k is the middle of the side that begins at
/// corner k.
using Places = std::array<std::size_t, 3>;

/// A way to divide a triangle, and the sides that are new and whose slide depends on the way.
struct Template {
  std::vector<Places> triangles;
  std::vector<std::array<std::size_t, 2>> sides;
};

/// The ways to divide a triangle whose sides with `is_split` are split.
std::vector<Template> templates_of(const std::array<bool, 3>& is_split) {
  const auto splits = std::ranges::count(is_split, true);
  std::vector<Template> result;
  if (splits == 3) {
    result.push_back({{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}, {{3, 4}, {4, 5}, {5, 3}}});
  }
  for (std::size_t k = 0; k < 3; ++k) {
    // Corners a, b, c, and the middles of the sides ab, bc, ca.
    const std::array<std::size_t, 3> turned = {k, (k + 1) % 3, (k + 2) % 3};
    const auto [a, b, c] = turned;
    const std::size_t ab = 3 + a;
    const std::size_t bc = 3 + b;
    const std::size_t ca = 3 + c;
    if (splits == 3) {
      result.push_back(
          {{{ab, b, bc}, {bc, c, ca}, {a, ab, bc}, {a, bc, ca}}, {{ab, bc}, {bc, ca}, {a, bc}}});
    } else if (splits == 2 && !is_split[c]) {
      result.push_back({{{ab, b, bc}, {a, ab, bc}, {a, bc, c}}, {{ab, bc}, {a, bc}}});
      result.push_back({{{ab, b, bc}, {a, ab, c}, {ab, bc, c}}, {{ab, bc}, {ab, c}}});
    } else if (splits == 1 && is_split[a]) {
      result.push_back({{{a, ab, c}, {ab, b, c}}, {{ab, c}}});
    }
  }
  return result;
}

/// The data that the faces of a part have in common.
struct SharedEdges {
  const EdgePoints& points;
  std::set<EdgePiece> wanted;  ///< to be split in this round
  std::set<EdgePiece> held;    ///< never to be split
  std::map<EdgePiece, Point> middles;

  [[nodiscard]] bool splits(const EdgePiece& piece) const {
    return wanted.contains(piece) && !held.contains(piece);
  }
  /// The same point for all faces, even if their parameters were rounded differently.
  Point middle(const EdgePiece& piece, double parameter) {
    const auto found = middles.find(piece);
    if (found != middles.end()) return found->second;
    return middles.emplace(piece, points(piece.edge, parameter)).first->second;
  }
};

/// Refines the triangles of one face.
class FaceRefiner {
 public:
  explicit FaceRefiner(RefinableFace& face) : face_(face), surface_(face.surface) {
    const ParametricMesh& mesh = face.mesh;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
      off_.push_back(gap_between(surface_.point(mesh.parameters[i]), mesh.points[i]));
    }
    take_boundary();
  }

  [[nodiscard]] const RefinableFace& face() const { return face_; }

  /// Looks for sides that slide, of triangles that no round has seen.
  void find_wanted(double tolerance, SharedEdges& edges) {
    const auto& triangles = face_.mesh.triangles;
    for (std::size_t i = seen_; i < triangles.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Side side = {triangles[i][k], triangles[i][(k + 1) % 3]};
        const auto found = boundary_.find(side);
        if (found != boundary_.end()) {
          find_wanted_piece(found->second, tolerance, edges);
        } else if (side[0] < side[1] && slide(side) > tolerance) {  // else seen from beyond
          wanted_.insert(side);
        }
      }
    }
    seen_ = triangles.size();
  }

  /// Computes where sides are to be split. Returns how many triangles that makes.
  std::size_t find_middles(SharedEdges& edges) {
    middles_.clear();
    for (const Side& side : wanted_) {
      const Parameters at =
          between(face_.mesh.parameters[side[0]], face_.mesh.parameters[side[1]], 0.5);
      middles_[side] = {at, surface_.point(at)};
    }
    for (std::size_t i = 0; i < face_.sources.size(); ++i) {
      const BoundarySource& source = face_.sources[i];
      if (!source.piece || !edges.splits(*source.piece)) continue;
      const double t = 0.5 * (source.from + source.to);
      SplitNode middle{hull_of(face_.curves[source.curve], t, t).front(),
                       edges.middle(*source.piece, t)};
      middle.off = gap_between(surface_.point(middle.at), middle.point);
      middles_[face_.mesh.boundary[i].nodes] = middle;
    }
    std::size_t triangles = face_.mesh.triangles.size();
    for (const auto& triangle : face_.mesh.triangles) {
      triangles += static_cast<std::size_t>(std::ranges::count(splits_of(triangle), true));
    }
    return triangles;
  }

  /// Holds sides whose split would turn a triangle over. Returns whether there are such.
  bool hold_turned(SharedEdges& edges) {
    bool holds = false;
    for (const auto& triangle : face_.mesh.triangles) {
      const std::array<bool, 3> is_split = splits_of(triangle);
      if (std::ranges::count(is_split, true) == 0 || division_of(triangle)) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        if (is_split[k]) hold({triangle[k], triangle[(k + 1) % 3]}, edges);
      }
      holds = true;
    }
    return holds;
  }

  /// Splits the sides with middles. Requires that none turns a triangle over.
  void split() {
    if (middles_.empty()) return;
    for (auto& [side, middle] : middles_) add_node(middle);
    std::vector<std::array<std::uint32_t, 3>> kept;
    std::vector<std::array<std::uint32_t, 3>> made;
    for (const auto& triangle : face_.mesh.triangles) {
      if (std::ranges::count(splits_of(triangle), true) == 0) {
        kept.push_back(triangle);
        continue;
      }
      const auto nodes = nodes_of(triangle);
      const std::optional<Template> division = division_of(triangle);
      for (const auto& [a, b, c] : division->triangles) {
        made.push_back({nodes[a].number, nodes[b].number, nodes[c].number});
      }
    }
    split_boundary();
    seen_ = kept.size();
    kept.insert(kept.end(), made.begin(), made.end());
    face_.mesh.triangles = std::move(kept);
    middles_.clear();
    wanted_.clear();
  }

 private:
  [[nodiscard]] SplitNode node(std::uint32_t number) const {
    return {face_.mesh.parameters[number], face_.mesh.points[number], off_[number], number};
  }

  /// As in the header.
  [[nodiscard]] double slide(const SplitNode& a, const SplitNode& b) const {
    double largest = 0.0;
    for (const double part : kSlideParts) {
      const Point on = surface_.point(between(a.at, b.at, part));
      largest = std::max(largest, gap_between(on, between(a.point, b.point, part)));
    }
    return largest - std::max(a.off, b.off);
  }

  [[nodiscard]] double slide(const Side& side) const { return slide(node(side[0]), node(side[1])); }

  void find_wanted_piece(std::size_t i, double tolerance, SharedEdges& edges) {
    const BoundarySource& source = face_.sources[i];
    if (!source.piece) return;
    const TrimPiece& piece = face_.mesh.boundary[i];
    if (slide(piece.nodes) > tolerance || sag_of(face_.surface, face_.mesh, piece) > tolerance) {
      edges.wanted.insert(*source.piece);
    }
  }

  [[nodiscard]] Side key_of(const Side& side) const {
    return boundary_.contains(side) ? side : sorted(side);
  }

  [[nodiscard]] std::array<bool, 3> splits_of(const std::array<std::uint32_t, 3>& triangle) const {
    std::array<bool, 3> result{};
    if (middles_.empty()) return result;
    for (std::size_t k = 0; k < 3; ++k) {
      result[k] = middles_.contains(key_of({triangle[k], triangle[(k + 1) % 3]}));
    }
    return result;
  }

  /// Corners and middles, by their places.
  [[nodiscard]] std::array<SplitNode, 6> nodes_of(
      const std::array<std::uint32_t, 3>& triangle) const {
    std::array<SplitNode, 6> result;
    for (std::size_t k = 0; k < 3; ++k) {
      result[k] = node(triangle[k]);
      const auto middle = middles_.find(key_of({triangle[k], triangle[(k + 1) % 3]}));
      if (middle != middles_.end()) result[3 + k] = middle->second;
    }
    return result;
  }

  /// The best way to divide a triangle; empty if every way turns a part over.
  [[nodiscard]] std::optional<Template> division_of(
      const std::array<std::uint32_t, 3>& triangle) const {
    const std::array<SplitNode, 6> nodes = nodes_of(triangle);
    std::optional<Template> best;
    double least = std::numeric_limits<double>::infinity();
    for (Template& way : templates_of(splits_of(triangle))) {
      const bool turns = std::ranges::any_of(way.triangles, [&](const Places& part) {
        return has_turned({nodes[part[0]].at, nodes[part[1]].at, nodes[part[2]].at});
      });
      if (turns) continue;
      double most = 0.0;
      for (const auto& [a, b] : way.sides) most = std::max(most, slide(nodes[a], nodes[b]));
      if (best && !(most < least)) continue;
      best = std::move(way);
      least = most;
    }
    return best;
  }

  void hold(const Side& side, SharedEdges& edges) {
    const auto found = boundary_.find(side);
    if (found == boundary_.end()) {
      wanted_.erase(sorted(side));
    } else if (face_.sources[found->second].piece) {
      edges.held.insert(*face_.sources[found->second].piece);
    }
  }

  void add_node(SplitNode& middle) {
    middle.number = static_cast<std::uint32_t>(face_.mesh.points.size());
    face_.mesh.parameters.push_back(middle.at);
    face_.mesh.points.push_back(middle.point);
    off_.push_back(middle.off);
  }

  void split_boundary() {
    std::vector<TrimPiece> pieces;
    std::vector<BoundarySource> sources;
    for (std::size_t i = 0; i < face_.sources.size(); ++i) {
      const auto middle = middles_.find(face_.mesh.boundary[i].nodes);
      if (middle == middles_.end()) {
        pieces.push_back(std::move(face_.mesh.boundary[i]));
        sources.push_back(face_.sources[i]);
        continue;
      }
      const Side nodes = face_.mesh.boundary[i].nodes;
      const std::uint32_t middle_node = middle->second.number;
      std::array<BoundarySource, 2> halves = {face_.sources[i], face_.sources[i]};
      halves[0].to = halves[1].from = 0.5 * (halves[0].from + halves[0].to);
      const bool is_reversed = halves[0].from > halves[1].to;
      for (std::size_t k = 0; k < 2; ++k) {
        halves[k].piece->path = 2 * halves[k].piece->path + ((k == 1) != is_reversed ? 1 : 0);
        const auto [low, high] = std::minmax(halves[k].from, halves[k].to);
        pieces.push_back({k == 0 ? Side{nodes[0], middle_node} : Side{middle_node, nodes[1]},
                          hull_of(face_.curves[halves[k].curve], low, high)});
        sources.push_back(halves[k]);
      }
    }
    face_.mesh.boundary = std::move(pieces);
    face_.sources = std::move(sources);
    take_boundary();
  }

  void take_boundary() {
    boundary_.clear();
    for (std::size_t i = 0; i < face_.mesh.boundary.size(); ++i) {
      boundary_[face_.mesh.boundary[i].nodes] = i;
    }
  }

  RefinableFace& face_;
  SurfacePoints surface_;
  std::vector<double> off_;               ///< of each node
  std::map<Side, std::size_t> boundary_;  ///< directed sides
  std::set<Side> wanted_;                 ///< sides inside, sorted
  std::map<Side, SplitNode> middles_;     ///< by `key_of`
  std::size_t seen_ = 0;                  ///< triangles whose sides were looked at
};

/// Whether each side of a triangle is either a piece of the boundary or a side of one other
/// triangle, and each piece of the boundary is such a side.
bool fits_together(const ParametricMesh& mesh) {
  std::set<Side> boundary;
  for (const TrimPiece& piece : mesh.boundary) {
    if (!boundary.insert(piece.nodes).second) return false;
  }
  std::set<Side> sides;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!sides.insert({triangle[k], triangle[(k + 1) % 3]}).second) return false;
    }
  }
  if (!std::ranges::includes(sides, boundary)) return false;
  return std::ranges::all_of(sides, [&](const Side& side) {
    const Side back = {side[1], side[0]};
    const bool has_other = sides.contains(back);
    return boundary.contains(side) ? boundary.contains(back) == has_other
                                   : has_other && !boundary.contains(back);
  });
}

/// Holds the pieces that faces do not have alike, and those of faces that stay as they are.
class PieceCheck {
 public:
  void add(const RefinableFace& face, bool stays, std::set<EdgePiece>& held) {
    for (std::size_t i = 0; i < face.sources.size(); ++i) {
      const BoundarySource& source = face.sources[i];
      if (!source.piece) continue;
      Side nodes = face.mesh.boundary[i].nodes;
      if (source.from > source.to) std::swap(nodes[0], nodes[1]);
      const Ends ends = {face.mesh.points[nodes[0]], face.mesh.points[nodes[1]]};
      const auto [found, is_new] = ends_.try_emplace(*source.piece, ends);
      if (stays || (!is_new && found->second != ends)) held.insert(*source.piece);
    }
  }

 private:
  using Ends = std::array<Point, 2>;
  std::map<EdgePiece, Ends> ends_;
};

/// One round. Returns whether a side was split.
bool refine_once(std::vector<FaceRefiner>& faces, SharedEdges& edges, double tolerance,
                 std::size_t most_triangles) {
  std::size_t before = 0;
  edges.wanted.clear();
  for (FaceRefiner& face : faces) {
    face.find_wanted(tolerance, edges);
    before += face.face().mesh.triangles.size();
  }
  std::size_t after = 0;
  bool holds = true;
  while (holds) {
    after = 0;
    holds = false;
    for (FaceRefiner& face : faces) after += face.find_middles(edges);
    for (FaceRefiner& face : faces) holds = face.hold_turned(edges) || holds;
  }
  if (after == before || after > most_triangles) return false;
  for (FaceRefiner& face : faces) face.split();
  return true;
}

}  // namespace

void refine_sides(std::span<RefinableFace* const> faces, const EdgePoints& edges, double tolerance,
                  std::size_t most_triangles) {
  SharedEdges shared{edges, {}, {}, {}};
  PieceCheck check;
  std::vector<FaceRefiner> refiners;
  for (RefinableFace* face : faces) {
    const bool stays = !fault_of(face->surface.surface).empty() || !fits_together(face->mesh);
    check.add(*face, stays, shared.held);
    if (!stays) refiners.emplace_back(*face);
  }
  for (int round = 0; round < kMostRounds; ++round) {
    if (!refine_once(refiners, shared, tolerance, most_triangles)) return;
  }
}

}  // namespace camway::scene::surfaces
