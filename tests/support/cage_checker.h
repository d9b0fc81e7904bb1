// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include "daemon/correction/infeasibility/cage_box.h"
#include "daemon/scene/mesh/mesh.h"

/// Checks whether a box and some triangles of a mesh prove that the centre of a flat body cannot
/// leave the box. Uses only these and the position of the centre, and shares no code with the
/// search for cages: it computes in fractions, in an exactly rotated frame. It cuts each face at
/// every vertex and decides each cell on its own; the width of a hole is the largest distance of
/// its corners, not the size of its bounds. For solids parallel to the frame the result is exact,
/// for their union, too. A slanted solid covers only the cells that it fills completely.
namespace camway::testing {

class CageChecker {
 public:
  using Number = boost::multiprecision::cpp_rational;
  using Point = std::array<Number, 3>;

  CageChecker(const scene::Mesh& mesh, const std::vector<std::uint32_t>& triangles,
              const correction::CageBox& cage)
      : cage_(cage) {
    set_frame(cage.orientation);
    std::map<Point, std::size_t> points;
    std::set<std::set<std::size_t>> known;
    for (const std::uint32_t t : triangles) {
      std::array<std::size_t, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) {
        const Point p = seen(mesh.vertices.at(mesh.triangles.at(t)[k]));
        corners[k] = points.emplace(p, points.size()).first->second;
      }
      // A copy of a triangle adds no obstacle.
      if (known.insert({corners[0], corners[1], corners[2]}).second) triangles_.push_back(corners);
    }
    points_.resize(points.size());
    for (const auto& [point, i] : points) points_[i] = point;
    find_solids();
  }

  /// The parts of a scene, as its maker knows them: closed surfaces, and triangles without overlap.
  struct Parts {
    std::vector<std::vector<std::uint32_t>> solids;
    std::vector<std::uint32_t> flats;
  };
  /// Uses the frame that `turn`, a quaternion of any length, rotates into the world. The frame of
  /// `cage` is rounded.
  CageChecker(const scene::Mesh& mesh, const Parts& parts, const correction::CageBox& cage,
              const geometry::Quat& turn)
      : cage_(cage) {
    set_frame(turn);
    std::map<Point, std::size_t> points;
    const auto add = [&](std::uint32_t t, std::size_t part) {
      std::array<std::size_t, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) {
        const Point p = seen(mesh.vertices.at(mesh.triangles.at(t)[k]));
        corners[k] = points.emplace(p, points.size()).first->second;
      }
      triangles_.push_back(corners);
      part_of_.push_back(part);
      return triangles_.size() - 1;
    };
    for (const std::vector<std::uint32_t>& triangles : parts.solids) {
      Solid solid;
      for (const std::uint32_t t : triangles) solid.triangles.push_back(add(t, solids_.size()));
      solids_.push_back(std::move(solid));
    }
    for (const std::uint32_t t : parts.flats) add(t, solids_.size());
    points_.resize(points.size());
    for (const auto& [point, i] : points) points_[i] = point;
    for (Solid& solid : solids_) measure(solid);
  }

  /// Returns the fault of the proof that the centre cannot get from one point to the other; empty
  /// if the proof holds.
  [[nodiscard]] std::string check(const geometry::Vec3& inside_W, const geometry::Vec3& outside_W) {
    const Point inside = seen(inside_W);
    const Point outside = seen(outside_W);
    if (!is_in_box(inside)) return "the point inside is not in the box";
    if (is_in_box(outside)) return "the point outside is in the box";
    for (Solid& solid : solids_) solid.holds_body = is_odd(solid, inside);
    for (std::size_t axis = 0; axis < 3; ++axis) cut(axis);
    std::array<Face, 6> faces;
    for (std::size_t i = 0; i < 6; ++i) faces[i] = cover(i / 2, i % 2 == 1);
    for (std::size_t i = 0; i < 6; ++i) {
      const std::string wrong = wrong_hole(faces, i);
      if (!wrong.empty()) return wrong;
    }
    return {};
  }

 private:
  using Edge = std::pair<std::size_t, std::size_t>;
  struct Solid {
    std::vector<std::size_t> triangles;
    Point low, high;         ///< bounding box
    bool is_cuboid = false;  ///< whether it is a cuboid parallel to the frame
    bool holds_body = false;
  };
  using Flat = std::array<Number, 2>;
  using Cells = std::vector<std::vector<char>>;  // indexed by the two other axes, in cyclic order
  struct Face {
    Cells covered;
  };

  void set_frame(const geometry::Quat& q) {
    turn_ = {Number(q.w()), -Number(q.x()), -Number(q.y()), -Number(q.z())};
    for (int k = 0; k < 3; ++k) {
      low_[index(k)] = Number(cage_.box.min()[k]);
      high_[index(k)] = Number(cage_.box.max()[k]);
    }
  }

  static std::size_t index(int k) { return static_cast<std::size_t>(k); }

  /// Returns t v t^-1 for the quaternion t, which is exactly a rotation for any length of t.
  [[nodiscard]] Point seen(const geometry::Vec3& v) const {
    const auto& [w, x, y, z] = turn_;
    const Point p = {Number(v.x()), Number(v.y()), Number(v.z())};
    if (x == 0 && y == 0 && z == 0) return p;
    const Number n = w * w + x * x + y * y + z * z;
    return {((w * w + x * x - y * y - z * z) * p[0] + 2 * (x * y - w * z) * p[1] +
             2 * (x * z + w * y) * p[2]) /
                n,
            (2 * (x * y + w * z) * p[0] + (w * w - x * x + y * y - z * z) * p[1] +
             2 * (y * z - w * x) * p[2]) /
                n,
            (2 * (x * z - w * y) * p[0] + 2 * (y * z + w * x) * p[1] +
             (w * w - x * x - y * y + z * z) * p[2]) /
                n};
  }

  [[nodiscard]] bool is_in_box(const Point& p) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (p[k] <= low_[k] || p[k] >= high_[k]) return false;
    }
    return true;
  }

  /// Joins triangles over shared edges. A closed part is a solid; the rest are flat triangles.
  void find_solids() {
    std::map<Edge, std::vector<std::size_t>> uses;
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        uses[std::minmax(triangles_[t][k], triangles_[t][(k + 1) % 3])].push_back(t);
      }
    }
    std::vector<std::size_t> part(triangles_.size());
    std::iota(part.begin(), part.end(), 0U);
    const auto root = [&](std::size_t i) {
      while (part[i] != i) i = part[i];
      return i;
    };
    for (const auto& [edge, list] : uses) {
      for (const std::size_t t : list) part[root(t)] = root(list.front());
    }
    std::set<std::size_t> open;
    for (const auto& [edge, list] : uses) {
      if (list.size() % 2 != 0 && edge.first != edge.second) open.insert(root(list.front()));
    }
    std::map<std::size_t, Solid> solids;
    for (std::size_t t = 0; t < triangles_.size(); ++t) part_of_.push_back(root(t));
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (!open.contains(root(t))) solids[root(t)].triangles.push_back(t);
    }
    for (auto& [name, solid] : solids) {
      measure(solid);
      solids_.push_back(std::move(solid));
    }
  }

  void measure(Solid& solid) const {
    solid.low = solid.high = points_[triangles_[solid.triangles.front()][0]];
    std::set<std::size_t> corners;
    for (const std::size_t t : solid.triangles) {
      for (const std::size_t p : triangles_[t]) {
        corners.insert(p);
        for (std::size_t k = 0; k < 3; ++k) {
          solid.low[k] = std::min(solid.low[k], points_[p][k]);
          solid.high[k] = std::max(solid.high[k], points_[p][k]);
        }
      }
    }
    // A closed surface whose only vertices are the corners of its bounding box is that box.
    solid.is_cuboid = solid.triangles.size() == 12 && corners.size() == 8 &&
                      std::all_of(corners.begin(), corners.end(), [&](std::size_t p) {
                        for (std::size_t k = 0; k < 3; ++k) {
                          const Number& x = points_[p][k];
                          if (x != solid.low[k] && x != solid.high[k]) return false;
                        }
                        return true;
                      });
  }

  void cut(std::size_t axis) {
    std::set<Number> all = {low_[axis], high_[axis]};
    for (const Point& p : points_) all.insert(p[axis]);
    // Coordinates that differ by rounding only are enclosed between two lines.
    const Number near(1e-12);
    std::set<Number> lines = {low_[axis], high_[axis]};
    for (auto from = all.begin(); from != all.end();) {
      auto to = from;
      while (std::next(to) != all.end() && *std::next(to) - *to < near) ++to;
      lines.insert(from == to ? *from : Number(from->convert_to<double>() - 2e-12));
      lines.insert(from == to ? *from : Number(to->convert_to<double>() + 2e-12));
      from = std::next(to);
    }
    std::erase_if(lines, [&](const Number& x) { return x < low_[axis] || x > high_[axis]; });
    lines_[axis].assign(lines.begin(), lines.end());
  }

  [[nodiscard]] Face cover(std::size_t axis, bool at_max) const {
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    const Number at = at_max ? high_[axis] : low_[axis];
    std::vector<std::size_t> solids;
    for (std::size_t i = 0; i < solids_.size(); ++i) {
      const bool meets = solids_[i].low[axis] <= at && at <= solids_[i].high[axis];
      if (meets || solids_[i].holds_body) solids.push_back(i);
    }
    std::vector<std::size_t> flats;
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const auto& c = triangles_[t];
      if (std::all_of(c.begin(), c.end(), [&](std::size_t p) { return points_[p][axis] == at; })) {
        flats.push_back(t);
      }
    }
    Face face;
    face.covered.assign(lines_[u].size() - 1, std::vector<char>(lines_[v].size() - 1, 0));
    for (std::size_t i = 0; i + 1 < lines_[u].size(); ++i) {
      for (std::size_t j = 0; j + 1 < lines_[v].size(); ++j) {
        const std::array<Number, 4> cell = {lines_[u][i], lines_[u][i + 1], lines_[v][j],
                                            lines_[v][j + 1]};
        face.covered[i][j] =
            is_in_solid(solids, axis, at, cell) || is_on_flats(flats, axis, at, cell) ? 1 : 0;
      }
    }
    return face;
  }

  /// Returns whether a solid fills the cell: its surface does not pass through the inside of the
  /// cell, and the body is on the other side of it.
  [[nodiscard]] bool is_in_solid(const std::vector<std::size_t>& solids, std::size_t axis,
                                 const Number& at, const std::array<Number, 4>& cell) const {
    Point middle;
    middle[axis] = at;
    middle[(axis + 1) % 3] = (cell[0] + cell[1]) / 2;
    middle[(axis + 2) % 3] = (cell[2] + cell[3]) / 2;
    for (const std::size_t s : solids) {
      const Solid& solid = solids_[s];
      bool is_beside = false;
      for (std::size_t k = 0; k < 3; ++k) {
        is_beside = is_beside || middle[k] < solid.low[k] || middle[k] > solid.high[k];
      }
      if (is_beside && !solid.holds_body) continue;
      if (solid.is_cuboid && !solid.holds_body)
        return true;  // every side of the cuboid is a border of cells
      const bool passes =
          std::any_of(solid.triangles.begin(), solid.triangles.end(),
                      [&](std::size_t t) { return meets_inside(t, axis, at, cell); });
      if (!passes && is_odd(solid, middle) != solid.holds_body) return true;
    }
    return false;
  }

  /// Returns the polygon in which a triangle meets the plane of the face, clipped to the cell.
  [[nodiscard]] std::vector<Flat> piece(std::size_t t, std::size_t axis, const Number& at,
                                        const std::array<Number, 4>& cell) const {
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    std::vector<Flat> polygon;
    for (std::size_t k = 0; k < 3; ++k) {
      const Point& a = points_[triangles_[t][k]];
      const Point& b = points_[triangles_[t][(k + 1) % 3]];
      const Number da = a[axis] - at;
      const Number db = b[axis] - at;
      if (da == 0) polygon.push_back({a[u], a[v]});
      if (da.sign() * db.sign() < 0) {
        const Number f = da / (da - db);
        polygon.push_back({a[u] + f * (b[u] - a[u]), a[v] + f * (b[v] - a[v])});
      }
    }
    for (std::size_t side = 0; side < 4 && !polygon.empty(); ++side) {
      const std::size_t k = side / 2;
      const auto room = [&](const Flat& p) {
        return side % 2 == 0 ? Number(p[k] - cell[side]) : Number(cell[side] - p[k]);
      };
      std::vector<Flat> cut;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Flat& a = polygon[i];
        const Flat& b = polygon[(i + 1) % polygon.size()];
        const Number ra = room(a);
        const Number rb = room(b);
        if (ra.sign() >= 0) cut.push_back(a);
        if (ra.sign() * rb.sign() < 0) {
          const Number f = ra / (ra - rb);
          cut.push_back({a[0] + f * (b[0] - a[0]), a[1] + f * (b[1] - a[1])});
        }
      }
      polygon = std::move(cut);
    }
    return polygon;
  }

  [[nodiscard]] bool meets_inside(std::size_t t, std::size_t axis, const Number& at,
                                  const std::array<Number, 4>& cell) const {
    const std::vector<Flat> polygon = piece(t, axis, at, cell);
    if (polygon.empty()) return false;
    // A polygon in the cell that is not in one of its sides has a point inside.
    for (std::size_t side = 0; side < 4; ++side) {
      if (std::all_of(polygon.begin(), polygon.end(),
                      [&](const Flat& p) { return p[side / 2] == cell[side]; })) {
        return false;
      }
    }
    return true;
  }

  /// Returns whether connected triangles cover the cell, by their area. Requires triangles without
  /// overlap.
  [[nodiscard]] bool is_on_flats(const std::vector<std::size_t>& flats, std::size_t axis,
                                 const Number& at, const std::array<Number, 4>& cell) const {
    std::map<std::size_t, Number> areas;  // area of each connected part
    for (const std::size_t t : flats) {
      const std::vector<Flat> polygon = piece(t, axis, at, cell);
      Number twice = 0;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Flat& a = polygon[i];
        const Flat& b = polygon[(i + 1) % polygon.size()];
        twice += a[0] * b[1] - a[1] * b[0];
      }
      areas[part_of_[t]] += boost::multiprecision::abs(twice) / 2;
    }
    const Number whole = (cell[1] - cell[0]) * (cell[3] - cell[2]);
    return std::any_of(areas.begin(), areas.end(),
                       [&](const auto& part) { return part.second == whole; });
  }

  /// Returns the parity of the crossings of a ray from `p`. Tries slanted directions until the ray
  /// meets no edge.
  [[nodiscard]] bool is_odd(const Solid& solid, const Point& p) const {
    for (int attempt = 1;; ++attempt) {
      const Point way = {Number(7 * attempt + 3), Number(11 - 5 * attempt),
                         Number(attempt * attempt)};
      bool odd = false;
      bool degenerate = false;
      for (const std::size_t t : solid.triangles) {
        std::array<Point, 3> r;
        for (std::size_t k = 0; k < 3; ++k) {
          for (std::size_t c = 0; c < 3; ++c) r[k][c] = points_[triangles_[t][k]][c] - p[c];
        }
        std::array<int, 3> sign{};
        for (std::size_t k = 0; k < 3; ++k) sign[k] = volume(way, r[k], r[(k + 1) % 3]).sign();
        const auto [least, most] = std::minmax({sign[0], sign[1], sign[2]});
        if (least < 0 && most > 0) continue;
        const int ahead = volume(r[0], r[1], r[2]).sign();
        if (least == 0 && most == 0) {
          degenerate = degenerate || ahead == 0;
          continue;
        }
        if (ahead * (most > 0 ? 1 : -1) < 0) continue;  // behind
        if (least * most == 0 || ahead == 0) degenerate = true;
        odd = !odd;
      }
      if (!degenerate || attempt == 20) return odd && !degenerate;
    }
  }

  static Number volume(const Point& a, const Point& b, const Point& c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
  }

  /// Returns the fault of a hole in face `name`: it is too wide, or reaches the border of the face
  /// where the cell of the next face, around the edge of the box, is open, too.
  [[nodiscard]] std::string wrong_hole(const std::array<Face, 6>& faces, std::size_t name) const {
    const std::size_t axis = name / 2;
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    const auto beyond = [&](std::size_t across, bool at_max, std::size_t along) {
      const Cells& cells = faces[2 * across + (at_max ? 1 : 0)].covered;
      const bool axis_comes_first = (across + 1) % 3 == axis;
      const std::size_t last = (axis_comes_first ? cells.size() : cells[0].size()) - 1;
      const std::size_t edge = name % 2 == 1 ? last : 0;
      return (axis_comes_first ? cells[edge][along] : cells[along][edge]) != 0;
    };
    Cells done = faces[name].covered;
    const std::size_t nu = done.size();
    const std::size_t nv = done[0].size();
    const Number chord(cage_.shortest_chord_m);
    for (std::size_t i0 = 0; i0 < nu; ++i0) {
      for (std::size_t j0 = 0; j0 < nv; ++j0) {
        if (done[i0][j0] != 0) continue;
        std::vector<std::pair<std::size_t, std::size_t>> hole = {{i0, j0}};
        done[i0][j0] = 1;
        std::set<Flat> corners;
        for (std::size_t n = 0; n < hole.size(); ++n) {
          const auto [i, j] = hole[n];
          for (const std::size_t a : {i, i + 1}) {
            for (const std::size_t b : {j, j + 1}) corners.insert({lines_[u][a], lines_[v][b]});
          }
          if ((i == 0 && !beyond(u, false, j)) || (i + 1 == nu && !beyond(u, true, j)) ||
              (j == 0 && !beyond(v, false, i)) || (j + 1 == nv && !beyond(v, true, i))) {
            return "a hole reaches the border of face " + std::to_string(name) + " at " +
                   std::to_string(lines_[u][i].convert_to<double>()) + " " +
                   std::to_string(lines_[v][j].convert_to<double>());
          }
          const auto visit = [&](std::size_t a, std::size_t b) {
            if (a < nu && b < nv && done[a][b] == 0) {
              done[a][b] = 1;
              hole.emplace_back(a, b);
            }
          };
          visit(i + 1, j);
          visit(i, j + 1);
          if (i > 0) visit(i - 1, j);
          if (j > 0) visit(i, j - 1);
        }
        for (const Flat& a : corners) {
          for (const Flat& b : corners) {
            const Number du = a[0] - b[0];
            const Number dv = a[1] - b[1];
            if (du * du + dv * dv >= chord * chord) {
              return "a hole of face " + std::to_string(name) + " is too wide";
            }
          }
        }
      }
    }
    return {};
  }

  correction::CageBox cage_;
  std::array<Number, 4> turn_;
  Point low_;
  Point high_;
  std::vector<Point> points_;
  std::vector<std::array<std::size_t, 3>> triangles_;
  std::vector<std::size_t> part_of_;  ///< connected part of each triangle
  std::vector<Solid> solids_;
  std::array<std::vector<Number>, 3> lines_;
};

}  // namespace camway::testing
