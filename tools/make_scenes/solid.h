// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

/// The generator of the scenes in `scenes/`. Geometry is integer arithmetic in micrometres, and
/// poses use only operations that IEEE 754 rounds correctly (+, -, *, /, sqrt), so that the files
/// have the same bytes wherever they are made. Standard library only.
namespace camway::make_scenes {

/// A length in micrometres.
using Um = std::int64_t;

/// Returns the metres of `value`, exactly: "-0.000125".
std::string metres(Um value);
constexpr Um mm(std::int64_t millimetres) { return millimetres * 1000; }

/// A point of the scene: y up, right-handed.
using Point = std::array<Um, 3>;
using Triangle = std::array<Point, 3>;

/// A rotation about the y axis with rational sine and cosine, so that it stays integer arithmetic.
struct Turn {
  std::int64_t cosine = 1;
  std::int64_t sine = 0;
  std::int64_t denominator = 1;
};
constexpr Turn kTurn0{1, 0, 1};
constexpr Turn kTurn90{0, 1, 1};
constexpr Turn kTurn180{-1, 0, 1};
constexpr Turn kTurn270{0, -1, 1};
constexpr Turn kTurn37{4, 3, 5};    // 36.9 degrees
constexpr Turn kTurn23{12, 5, 13};  // 22.6 degrees
constexpr Turn kTurnMinus28{15, -8, 17};

/// Returns the rotation by `first`, then by `second`.
Turn compose(const Turn& first, const Turn& second);

/// The placement of a piece of furniture: a rotation about its own origin, then a translation.
struct Placement {
  Point origin{};
  Turn turn = kTurn0;

  [[nodiscard]] Point operator()(const Point& local) const;
};

/// A list of triangles, grouped into named objects. Every vertex of an object is written once.
class Scene {
 public:
  struct Object {
    std::string name;
    std::size_t first_triangle = 0;
  };

  /// Begins an object, to which the next triangles belong.
  void begin_object(const std::string& name);

  void add_triangle(const Point& a, const Point& b, const Point& c);
  /// Adds two triangles that share the diagonal from `a` to `c`.
  void add_quad(const Point& a, const Point& b, const Point& c, const Point& d);
  /// Adds a closed box between two corners in the frame of `placement`.
  void add_box(const Placement& placement, const Point& low, const Point& high);
  /// Adds a closed upright prism over a regular polygon. Requires `sides` to divide 24.
  void add_prism(const Placement& placement, const Point& base, Um radius, Um height, int sides);

  [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }
  [[nodiscard]] const std::vector<Object>& objects() const { return objects_; }

  /// Returns the scene as Wavefront OBJ in metres with six decimals, one `o` for each object.
  [[nodiscard]] std::string obj(const std::string& title) const;
  /// Returns the scene in the UniGrafix language: a definition and an instance for each object.
  /// Requires that the names of objects are identifiers.
  [[nodiscard]] std::string unigrafix(const std::string& title) const;

 private:
  /// An object with each of its vertices once, in the order of their first use.
  struct Part {
    std::string name;
    std::vector<Point> vertices;
    std::vector<std::array<std::size_t, 3>> triangles;
  };
  [[nodiscard]] std::vector<Part> parts() const;

  std::vector<Triangle> triangles_;
  std::vector<Object> objects_;
};

/// Returns point `index` of 24 on a circle of `radius` about the y axis, from +x towards -z.
Point on_circle(Um radius, int index);

/// A rectangle cut out of a wall or slab, in its own two coordinates.
struct Opening {
  Um u0, u1, v0, v1;
};

/// An upright wall of real thickness along x, from x0 to x1: `u` of an opening is x, `v` is y.
struct WallAlongX {
  Um x0, x1, y0, y1, z0, z1;
};
void add_wall(Scene& scene, const WallAlongX& wall, const std::vector<Opening>& openings = {});

/// An upright wall along z: `u` of an opening is z, `v` is y.
struct WallAlongZ {
  Um z0, z1, y0, y1, x0, x1;
};
void add_wall(Scene& scene, const WallAlongZ& wall, const std::vector<Opening>& openings = {});

/// A horizontal slab: `u` of an opening is x, `v` is z.
struct Slab {
  Um x0, x1, z0, z1, y0, y1;
};
void add_slab(Scene& scene, const Slab& slab, const std::vector<Opening>& openings = {});

/// A pseudo-random generator with the same numbers on every machine: SplitMix64 (Steele et al.
/// 2014).
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed) {}
  /// Returns a number in [0, count).
  std::int64_t below(std::int64_t count);

 private:
  std::uint64_t state_;
};

}  // namespace camway::make_scenes
