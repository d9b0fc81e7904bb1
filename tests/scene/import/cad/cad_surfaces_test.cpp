// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <utility>
#include <variant>
#include <vector>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <GeomAPI_ProjectPointOnSurf.hxx>
#include <Geom_BSplineSurface.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>

#include "tests/scene/import/cad/cad_scene.h"
#include "tests/scene/import/surfaces/triangle_distance.h"
#include "tests/support/random.h"

namespace camway::scene {
namespace {

constexpr std::uint64_t kCadSeed = 77031;
constexpr double kMillimetre = 1e-3;

/// A bound that is more than this times what was measured is of no use.
constexpr double kUsefulRatio = 20.0;

using camway::testing::NearTriangles;
using camway::testing::Random;
using geometry::Vec3;

/// A point of the half-plane beside an axis: distance from the axis, height along it.
using Flat = std::array<double, 2>;

struct Line {
  Flat from;
  Flat to;
};
struct Arc {
  Flat centre;
  double radius;
  double from;  ///< angle, counter-clockwise to `to`
  double to;
};

double flat_distance(const Flat& a, const Flat& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }

Flat flat_point(const Line& line, double t) {
  return {(1 - t) * line.from[0] + t * line.to[0], (1 - t) * line.from[1] + t * line.to[1]};
}
Flat flat_point(const Arc& arc, double t) {
  const double angle = (1 - t) * arc.from + t * arc.to;
  return {arc.centre[0] + arc.radius * std::cos(angle),
          arc.centre[1] + arc.radius * std::sin(angle)};
}
double flat_distance(const Line& line, const Flat& p) {
  const Flat d = {line.to[0] - line.from[0], line.to[1] - line.from[1]};
  const double along = (p[0] - line.from[0]) * d[0] + (p[1] - line.from[1]) * d[1];
  const double t = std::clamp(along / (d[0] * d[0] + d[1] * d[1]), 0.0, 1.0);
  return flat_distance(p, flat_point(line, t));
}
double flat_distance(const Arc& arc, const Flat& p) {
  double angle = std::atan2(p[1] - arc.centre[1], p[0] - arc.centre[0]);
  while (angle < arc.from) angle += 2.0 * std::numbers::pi;
  if (angle <= arc.to) return std::abs(flat_distance(p, arc.centre) - arc.radius);
  return std::min(flat_distance(p, flat_point(arc, 0.0)), flat_distance(p, flat_point(arc, 1.0)));
}

/// A surface of revolution in closed form (m): an oracle that shares no code.
struct Revolved {
  Vec3 origin;
  Vec3 axis;
  std::vector<std::variant<Line, Arc>> profile;

  [[nodiscard]] double distance(const Vec3& p) const {
    const double height = (p - origin).dot(axis);
    const Flat flat = {(p - origin - height * axis).norm(), height};
    double least = std::numeric_limits<double>::infinity();
    for (const auto& part : profile) {
      least = std::min(
          least, std::visit([&](const auto& shape) { return flat_distance(shape, flat); }, part));
    }
    return least;
  }
  [[nodiscard]] Vec3 random_point(Random& random) const {
    const auto& part =
        profile[static_cast<std::size_t>(random.integer(0, static_cast<int>(profile.size()) - 1))];
    const double t = random.uniform(0.0, 1.0);
    const Flat flat = std::visit([&](const auto& shape) { return flat_point(shape, t); }, part);
    const Vec3 x = axis.unitOrthogonal();
    const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
    return origin + flat[1] * axis +
           flat[0] * (std::cos(angle) * x + std::sin(angle) * axis.cross(x));
  }
};

/// Random points of triangles, some for each.
template <class Visit>
void for_points_of(const Mesh& mesh, Random& random, const Visit& visit) {
  constexpr std::size_t kPoints = 20000;
  const int each = static_cast<int>(1 + kPoints / mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto t = mesh.triangle(i);
    for (int k = 0; k < each; ++k) {
      const double a = random.uniform(0.0, 1.0);
      const double b = random.uniform(0.0, 1.0 - a);
      visit(Vec3(a * t[0] + b * t[1] + (1.0 - a - b) * t[2]));
    }
  }
}

NearTriangles near_triangles_of(const Mesh& mesh, double reach) {
  NearTriangles near(reach);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto t = mesh.triangle(i);
    near.add(t[0], t[1], t[2]);
  }
  return near;
}

/// Edges that another number of triangles than two has.
int open_edges(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++uses[std::minmax(t[k], t[(k + 1) % 3])];
  }
  return static_cast<int>(
      std::ranges::count_if(uses, [](const auto& use) { return use.second != 2; }));
}

double volume(const Mesh& mesh) {
  double sum = 0.0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto t = mesh.triangle(i);
    sum += t[0].dot(t[1].cross(t[2])) / 6.0;
  }
  return sum;
}

class CadSurfaces : public CadScene {
 protected:
  /// Checks the error both ways. Returns how far the triangles are off.
  double expect_within_error(const ImportResult& result, const Revolved& exact) {
    Random random(kCadSeed);
    const double error = result.report.surface_error_m;
    double farthest = 0.0;
    for_points_of(*result.mesh, random,
                  [&](const Vec3& p) { farthest = std::max(farthest, exact.distance(p)); });
    NearTriangles near = near_triangles_of(*result.mesh, 4.0 * error);
    for (int i = 0; i < 4000; ++i) {
      farthest = std::max(farthest, near.distance(exact.random_point(random)));
    }
    EXPECT_LE(farthest, error);
    EXPECT_LE(error, 1e-3 * 0.5 * result.report.bounds_m.sizes().norm());
    return farthest;
  }

  /// Reads a shape from STEP and from IGES.
  void expect_good(const TopoDS_Shape& shape, const Revolved& exact, double volume_m3) {
    {
      SCOPED_TRACE("STEP");
      const ImportResult result = read(write_step(shape));
      const double farthest = expect_within_error(result, exact);
      EXPECT_LE(result.report.surface_error_m, kUsefulRatio * farthest) << "the bound is of no use";
      EXPECT_EQ(open_edges(*result.mesh), 0);
      EXPECT_NEAR(volume(*result.mesh), volume_m3, 0.01 * volume_m3) << "outside is outside";
      EXPECT_EQ(result.report.dropped_freeform, 0U);
      EXPECT_EQ(result.report.degenerate_triangles, 0U);
    }
    SCOPED_TRACE("IGES");
    const ImportResult result = read(write_iges(shape));
    const double farthest = expect_within_error(result, exact);
    EXPECT_LE(result.report.surface_error_m, kUsefulRatio * farthest) << "the bound is of no use";
    EXPECT_NEAR(volume(*result.mesh), volume_m3, 0.01 * volume_m3) << "outside is outside";
  }
};

constexpr double kPi = std::numbers::pi;

TEST_F(CadSurfaces, ASphere) {
  const TopoDS_Shape sphere = BRepPrimAPI_MakeSphere(gp_Pnt(10, 20, 30), 100).Shape();
  expect_good(sphere,
              {Vec3(0.01, 0.02, 0.03), Vec3::UnitZ(), {Arc{{0, 0}, 0.1, -kPi / 2, kPi / 2}}},
              4.0 / 3.0 * kPi * 1e-3);
}

TEST_F(CadSurfaces, ATorus) {
  const TopoDS_Shape torus =
      BRepPrimAPI_MakeTorus(gp_Ax2(gp_Pnt(0, 5, 0), gp_Dir(1, 0, 0)), 100, 30).Shape();
  expect_good(torus, {Vec3(0, 0.005, 0), Vec3::UnitX(), {Arc{{0.1, 0}, 0.03, -kPi, kPi}}},
              2.0 * kPi * 0.1 * kPi * 0.03 * 0.03);
}

TEST_F(CadSurfaces, ACylinder) {
  const TopoDS_Shape cylinder = BRepPrimAPI_MakeCylinder(50, 200).Shape();
  const Line side{{0.05, 0}, {0.05, 0.2}};
  const Line bottom{{0, 0}, {0.05, 0}};
  const Line top{{0, 0.2}, {0.05, 0.2}};
  expect_good(cylinder, {Vec3::Zero(), Vec3::UnitZ(), {side, bottom, top}},
              kPi * 0.05 * 0.05 * 0.2);
}

TEST_F(CadSurfaces, AConeWithAnApex) {
  const TopoDS_Shape cone = BRepPrimAPI_MakeCone(60, 0, 150).Shape();
  const Line side{{0.06, 0}, {0, 0.15}};
  const Line bottom{{0, 0}, {0.06, 0}};
  expect_good(cone, {Vec3::Zero(), Vec3::UnitZ(), {side, bottom}}, kPi / 3.0 * 0.06 * 0.06 * 0.15);
}

TEST_F(CadSurfaces, ABoxWithARoundHole) {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(-50, -40, 0), gp_Pnt(50, 40, 20)).Shape();
  const TopoDS_Shape drill =
      BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 0, -5), gp_Dir(0, 0, 1)), 20, 30).Shape();
  const ImportResult result = read(write_step(BRepAlgoAPI_Cut(box, drill).Shape()));
  const double error = result.report.surface_error_m;
  const auto distance = [](const Vec3& p) {
    const double rho = std::hypot(p.x(), p.y());
    const double wall = std::abs(rho - 0.02);
    const double sides =
        std::min(std::abs(std::abs(p.x()) - 0.05), std::abs(std::abs(p.y()) - 0.04));
    const double face = std::min(std::abs(p.z()), std::abs(p.z() - 0.02));
    return std::min({wall, sides, std::hypot(face, std::max(0.0, 0.02 - rho))});
  };
  Random random(kCadSeed);
  double farthest = 0.0;
  for_points_of(*result.mesh, random,
                [&](const Vec3& p) { farthest = std::max(farthest, distance(p)); });
  NearTriangles near = near_triangles_of(*result.mesh, 4.0 * error);
  for (int i = 0; i < 4000; ++i) {
    const double angle = random.uniform(0.0, 2.0 * kPi);
    const double rho = random.chance(0.5) ? 0.02 : random.uniform(0.02, 0.022);
    const double z = rho == 0.02 ? random.uniform(0.0, 0.02) : 0.02;
    farthest =
        std::max(farthest, near.distance(Vec3(rho * std::cos(angle), rho * std::sin(angle), z)));
  }
  EXPECT_LE(farthest, error);
  EXPECT_LE(error, kUsefulRatio * farthest);
  EXPECT_LE(error, 1e-3 * 0.5 * result.report.bounds_m.sizes().norm());
  EXPECT_EQ(open_edges(*result.mesh), 0);
  EXPECT_NEAR(volume(*result.mesh), 0.1 * 0.08 * 0.02 - kPi * 0.02 * 0.02 * 0.02, 1e-6);
}

TEST_F(CadSurfaces, ASphereTrimmedByAPlaneAslant) {
  // The trim curve is no line of the sphere's parameters.
  const gp_Dir axis(1, 2, 2);
  const TopoDS_Shape sphere = BRepPrimAPI_MakeSphere(100).Shape();
  const gp_Ax2 above(gp_Pnt(axis.XYZ() * 60.0), axis);
  const TopoDS_Shape knife = BRepPrimAPI_MakeCylinder(above, 300, 300).Shape();
  const Vec3 n(axis.X(), axis.Y(), axis.Z());
  const Revolved exact{
      Vec3::Zero(), n, {Arc{{0, 0}, 0.1, -kPi / 2, std::asin(0.6)}, Line{{0, 0.06}, {0.08, 0.06}}}};
  const double cap = kPi * 0.04 * 0.04 * (0.3 - 0.04) / 3.0;
  expect_good(BRepAlgoAPI_Cut(sphere, knife).Shape(), exact, 4.0 / 3.0 * kPi * 1e-3 - cap);
}

/// A rational surface of degrees 3 and 2.
Handle(Geom_BSplineSurface) wavy_surface(Random& random) {
  TColgp_Array2OfPnt poles(1, 6, 1, 4);
  TColStd_Array2OfReal weights(1, 6, 1, 4);
  for (int i = 1; i <= 6; ++i) {
    for (int j = 1; j <= 4; ++j) {
      poles(i, j) = gp_Pnt(20.0 * i, 25.0 * j, random.uniform(-8.0, 8.0));
      weights(i, j) = random.uniform(0.5, 2.0);
    }
  }
  TColStd_Array1OfReal u_knots(1, 4);
  TColStd_Array1OfInteger u_counts(1, 4);
  TColStd_Array1OfReal v_knots(1, 3);
  TColStd_Array1OfInteger v_counts(1, 3);
  for (int i = 1; i <= 4; ++i) u_knots(i) = 0.5 * i * i;
  for (int j = 1; j <= 3; ++j) v_knots(j) = j;
  for (int i = 1; i <= 4; ++i) u_counts(i) = i == 1 || i == 4 ? 4 : 1;
  for (int j = 1; j <= 3; ++j) v_counts(j) = j == 2 ? 1 : 3;
  return new Geom_BSplineSurface(poles, weights, u_knots, v_knots, u_counts, v_counts, 3, 2);
}

TEST_F(CadSurfaces, ARationalSplineFace) {
  Random random(kCadSeed);
  const Handle(Geom_BSplineSurface) surface = wavy_surface(random);
  const TopoDS_Shape face = BRepBuilderAPI_MakeFace(surface, 1e-6).Shape();
  for (const bool is_step : {true, false}) {
    SCOPED_TRACE(is_step);
    const ImportResult result = read(is_step ? write_step(face) : write_iges(face));
    const double error = result.report.surface_error_m;
    EXPECT_LE(error, 1e-3 * 0.5 * result.report.bounds_m.sizes().norm());
    double u0 = 0;
    double u1 = 0;
    double v0 = 0;
    double v1 = 0;
    surface->Bounds(u0, u1, v0, v1);
    NearTriangles near = near_triangles_of(*result.mesh, 4.0 * error);
    double farthest = 0.0;
    for (int i = 0; i < 4000; ++i) {
      const gp_Pnt p = surface->Value(random.uniform(u0, u1), random.uniform(v0, v1));
      farthest = std::max(farthest, near.distance(kMillimetre * Vec3(p.X(), p.Y(), p.Z())));
    }
    EXPECT_LE(farthest, error);
    EXPECT_LE(error, kUsefulRatio * farthest) << "the bound is of no use";
    double back = 0.0;
    int number = 0;
    for_points_of(*result.mesh, random, [&](const Vec3& p) {
      if (++number % 256 != 0) return;  // a projection takes a millisecond
      const gp_Pnt at(p.x() / kMillimetre, p.y() / kMillimetre, p.z() / kMillimetre);
      const GeomAPI_ProjectPointOnSurf nearest(at, surface);
      if (nearest.NbPoints() > 0) back = std::max(back, kMillimetre * nearest.LowerDistance());
    });
    EXPECT_GT(back, 0.0);
    EXPECT_LE(back, error);
  }
}

/// Two saddles side by side, with weights: all their edges are straight in space, and the
/// parameters of the edges run unevenly.
TopoDS_Shape saddles() {
  BRepBuilderAPI_Sewing sewing(1e-6);
  for (const int first : {0, 3}) {
    TColgp_Array2OfPnt poles(1, 4, 1, 4);
    TColStd_Array2OfReal weights(1, 4, 1, 4);
    for (int i = 1; i <= 4; ++i) {
      for (int j = 1; j <= 4; ++j) {
        const double x = 100.0 * (first + i - 1);
        const double y = 100.0 * (j - 1);
        poles(i, j) = gp_Pnt(x, y, 2e-3 * x * y);
        weights(i, j) = 1.0 + 0.1 * ((first + i + j) % 3);
      }
    }
    TColStd_Array1OfReal knots(1, 2);
    knots(1) = 0.0;
    knots(2) = 1.0;
    TColStd_Array1OfInteger counts(1, 2);
    counts.Init(4);
    const Handle(Geom_BSplineSurface) saddle =
        new Geom_BSplineSurface(poles, weights, knots, knots, counts, counts, 3, 3);
    sewing.Add(BRepBuilderAPI_MakeFace(saddle, 1e-6).Face());
  }
  sewing.Perform();
  return sewing.SewedShape();
}

TEST_F(CadSurfaces, StraightEdgesWithUnevenParametersCostLittle) {
  const TopoDS_Shape shape = saddles();
  for (const bool is_step : {true, false}) {
    SCOPED_TRACE(is_step);
    const ImportResult result = read(is_step ? write_step(shape) : write_iges(shape));
    EXPECT_LE(result.report.surface_error_m, 1e-3 * 0.5 * result.report.bounds_m.sizes().norm());
    EXPECT_LE(result.report.triangles, 5000U);
    // In metres z is 2 x y, for every point of the saddles. The gradient is less than 2.
    Random random(kCadSeed);
    for_points_of(*result.mesh, random, [&](const Vec3& p) {
      EXPECT_LE(std::abs(p.z() - 2.0 * p.x() * p.y()) / 2.0, result.report.surface_error_m);
    });
    if (is_step) {
      // Only the outline of the two has sides of one triangle, and it is a rectangle.
      std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
      for (const auto& t : result.mesh->triangles) {
        for (std::size_t k = 0; k < 3; ++k) ++uses[std::minmax(t[k], t[(k + 1) % 3])];
      }
      double outline = 0.0;
      for (const auto& [side, count] : uses) {
        const Vec3 along = result.mesh->vertices[side.first] - result.mesh->vertices[side.second];
        if (count == 1) outline += std::hypot(along.x(), along.y());
      }
      EXPECT_NEAR(outline, 2.0 * (0.6 + 0.3), 1e-5);
    }
  }
}

}  // namespace
}  // namespace camway::scene
