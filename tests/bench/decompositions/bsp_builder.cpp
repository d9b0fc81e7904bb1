// SPDX-License-Identifier: MIT
#include "tests/bench/decompositions/bsp_builder.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace camway::bench {

using geometry::Box;
using geometry::Triangle;
using geometry::Vec3;

namespace {

constexpr std::size_t kCandidates = 12;  ///< triangles whose planes are tried
constexpr std::size_t kSample = 128;     ///< pieces that a plane is tried on
/// Cost of cutting a piece, in pieces of the larger side.
constexpr double kCutCost = 1.0;
/// Share of the pieces on one side from which on the middle plane is tried.
constexpr double kLopsided = 0.75;

/// The step that picks about `count` of `size` items.
std::size_t step_for(std::size_t size, std::size_t count) {
  return std::max<std::size_t>(1, size / count);
}

}  // namespace

BspBuilder::BspBuilder(BspTree& tree, const BspOptions& options)
    : tree_(tree),
      options_(options),
      in_plane_m_(kInPlaneUnits * geometry::kUnitRoundoff * largest_m(tree.bounds_) +
                  geometry::kSmallestNormal) {}

void BspBuilder::build() {
  const scene::Mesh& mesh = *tree_.mesh_;
  Pieces all;
  all.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle t = mesh.triangle(i);
    all.push_back({static_cast<std::uint32_t>(i), {t.begin(), t.end()}});
  }
  const double budget = options_.max_duplication * static_cast<double>(all.size());
  tree_.root_ = build_child(std::move(all), budget, 0);
}

std::uint32_t BspBuilder::build_child(Pieces pieces, double budget, std::uint32_t depth) {
  if (pieces.empty()) return BspTree::kNothing;
  tree_.depth_ = std::max(tree_.depth_, depth);
  if (pieces.size() <= options_.threshold || depth >= options_.max_depth) return add_leaf(pieces);
  const std::optional<BspPlane> plane = plane_for(pieces);
  if (!plane) return add_leaf(pieces);
  const Shares shares = shares_of(*plane, pieces);
  const std::size_t after = shares.behind + shares.in_front + 2 * shares.cut;
  if (shares.larger() == pieces.size() || static_cast<double>(after) > budget) {
    return add_leaf(pieces);
  }
  Division division = divided(*plane, std::move(pieces));
  const auto id = static_cast<std::uint32_t>(tree_.nodes_.size());
  tree_.nodes_.push_back({.plane = *plane, .in_plane = add_references(division.in_plane)});
  const double each = after > 0 ? budget / static_cast<double>(after) : 0.0;
  const double budget_behind = each * static_cast<double>(division.behind.size());
  const double budget_in_front = each * static_cast<double>(division.in_front.size());
  const std::uint32_t behind = build_child(std::move(division.behind), budget_behind, depth + 1);
  tree_.nodes_[id].behind = behind;
  const std::uint32_t in_front =
      build_child(std::move(division.in_front), budget_in_front, depth + 1);
  tree_.nodes_[id].in_front = in_front;
  return id;
}

std::uint32_t BspBuilder::add_leaf(const Pieces& pieces) {
  std::vector<std::uint32_t> triangles;
  triangles.reserve(pieces.size());
  for (const Piece& piece : pieces) triangles.push_back(piece.triangle);
  const auto id = static_cast<std::uint32_t>(tree_.leaves_.size());
  tree_.leaves_.push_back(add_references(triangles));
  return id | BspTree::kLeafBit;
}

BspTree::Range BspBuilder::add_references(const std::vector<std::uint32_t>& triangles) {
  const auto begin = static_cast<std::uint32_t>(tree_.references_.size());
  tree_.references_.insert(tree_.references_.end(), triangles.begin(), triangles.end());
  return {begin, static_cast<std::uint32_t>(tree_.references_.size())};
}

std::optional<BspPlane> BspBuilder::plane_for(const Pieces& pieces) const {
  Pieces sample;
  for (std::size_t i = 0; i < pieces.size(); i += step_for(pieces.size(), kSample)) {
    sample.push_back(pieces[i]);
  }
  std::optional<BspPlane> best;
  double best_cost = 0.0;
  const auto consider = [&](const BspPlane& plane) {
    const Shares shares = shares_of(plane, sample);
    const double cost =
        static_cast<double>(shares.larger()) + kCutCost * static_cast<double>(shares.cut);
    if (best && cost >= best_cost) return;
    best = plane;
    best_cost = cost;
  };
  for (std::size_t i = 0; i < pieces.size(); i += step_for(pieces.size(), kCandidates)) {
    if (const std::optional<BspPlane> plane = plane_of(pieces[i])) consider(*plane);
  }
  const bool is_lopsided = !best || static_cast<double>(shares_of(*best, sample).larger()) >
                                        kLopsided * static_cast<double>(sample.size());
  if (is_lopsided) consider(middle_plane(pieces));
  return best;
}

/// Returns nothing for a triangle that is a segment or a point.
std::optional<BspPlane> BspBuilder::plane_of(const Piece& piece) const {
  const Triangle t = tree_.mesh_->triangle(piece.triangle);
  const Vec3 across = (t[1] - t[0]).cross(t[2] - t[0]);
  const double length = across.norm();
  if (!std::isnormal(length)) return std::nullopt;
  const Vec3 normal = across / length;
  return BspPlane{normal, normal.dot(t[0])};
}

BspPlane BspBuilder::middle_plane(const Pieces& pieces) {
  Box box;
  for (const Piece& piece : pieces) {
    for (const Vec3& corner : piece.corners) box.extend(corner);
  }
  Eigen::Index longest = 0;
  box.sizes().maxCoeff(&longest);
  return {Vec3::Unit(longest), 0.5 * box.min()[longest] + 0.5 * box.max()[longest]};
}

BspBuilder::Heights BspBuilder::heights_of(const BspPlane& plane, const Piece& piece) {
  Heights heights{std::numeric_limits<double>::infinity(),
                  -std::numeric_limits<double>::infinity()};
  for (const Vec3& corner : piece.corners) {
    const double height_m = plane.height_m(corner);
    heights.low_m = std::min(heights.low_m, height_m);
    heights.high_m = std::max(heights.high_m, height_m);
  }
  return heights;
}

BspBuilder::Shares BspBuilder::shares_of(const BspPlane& plane, const Pieces& pieces) const {
  Shares shares;
  for (const Piece& piece : pieces) {
    const Heights heights = heights_of(plane, piece);
    const bool is_behind = heights.high_m <= in_plane_m_;
    const bool is_in_front = heights.low_m >= -in_plane_m_;
    if (is_behind && is_in_front) continue;
    ++(is_behind ? shares.behind : is_in_front ? shares.in_front : shares.cut);
  }
  return shares;
}

BspBuilder::Division BspBuilder::divided(const BspPlane& plane, Pieces pieces) const {
  Division division;
  for (Piece& piece : pieces) {
    const Heights heights = heights_of(plane, piece);
    const bool is_behind = heights.high_m <= in_plane_m_;
    const bool is_in_front = heights.low_m >= -in_plane_m_;
    if (is_behind && is_in_front) {
      division.in_plane.push_back(piece.triangle);
    } else if (is_behind) {
      division.behind.push_back(std::move(piece));
    } else if (is_in_front) {
      division.in_front.push_back(std::move(piece));
    } else {
      std::array<Piece, 2> halves = cut(plane, piece);
      division.behind.push_back(std::move(halves[0]));
      division.in_front.push_back(std::move(halves[1]));
    }
  }
  return division;
}

/// The parts behind and in front of the plane. Requires that the piece has corners on both sides.
std::array<BspBuilder::Piece, 2> BspBuilder::cut(const BspPlane& plane, const Piece& piece) {
  std::array<Piece, 2> halves{Piece{piece.triangle, {}}, Piece{piece.triangle, {}}};
  for (std::size_t i = 0; i < piece.corners.size(); ++i) {
    const Vec3& a = piece.corners[i];
    const Vec3& b = piece.corners[(i + 1) % piece.corners.size()];
    const double at_a_m = plane.height_m(a);
    const double at_b_m = plane.height_m(b);
    if (at_a_m <= 0.0) halves[0].corners.push_back(a);
    if (at_a_m >= 0.0) halves[1].corners.push_back(a);
    if ((at_a_m < 0.0 && at_b_m > 0.0) || (at_a_m > 0.0 && at_b_m < 0.0)) {
      const Vec3 at_plane = a + at_a_m / (at_a_m - at_b_m) * (b - a);
      halves[0].corners.push_back(at_plane);
      halves[1].corners.push_back(at_plane);
    }
  }
  return halves;
}

}  // namespace camway::bench
