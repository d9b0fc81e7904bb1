// SPDX-License-Identifier: MIT
#include "daemon/scene/import/cad/part_mesher.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <IMeshTools_Parameters.hxx>
#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Face.hxx>

#include "daemon/scene/import/cad/edge_curves.h"
#include "daemon/scene/import/cad/face_surface.h"
#include "daemon/scene/import/surfaces/edge_refinement.h"
#include "daemon/scene/import/surfaces/parametric_error.h"

namespace camway::scene::cad {
namespace {

using surfaces::FacetedSurface;
using surfaces::Point;

/// Proposals for one part. The error of a proposal is in proportion to what it was asked for, so
/// two or three do.
constexpr int kMostProposals = 6;

/// Proposals that may fail to bound faces; more of them seldom help.
constexpr int kMostFailures = 2;

/// The part of the tolerance by which sides of the first proposal may slide, and at which later
/// proposals aim: the bound of a triangle can be more than the slide of its sides.
constexpr double kAim = 0.6;

/// Sides may slide by this much more than the deflection that the library is asked for. The bound
/// of the sag of a trim curve is up to sqrt(2) times what the library measures (`error_of`), so
/// that most of the library's chords need no split.
constexpr double kSlidePerDeflection = std::numbers::sqrt2;

/// A proposal is finer than the last by these factors at least and at most.
constexpr double kLeastStep = 0.6;
constexpr double kMostStep = 1.0 / 16.0;

/// A proposal that leaves more than this part of the error is the last.
constexpr double kLittle = 0.9;

/// Largest turn of the surface from one node to the next (rad), so that small circles keep nine
/// sides.
constexpr double kLargestTurn = 0.7;

/// A face of the part, made a B-spline.
struct Face {
  TopoDS_Face spline;
  std::string fault;  ///< why it is left out in any case; or empty
};

/// A part whose surfaces are B-splines.
struct SplinePart {
  TopoDS_Shape shape;
  std::vector<Face> faces;
};

std::vector<TopoDS_Face> faces_of(const TopoDS_Shape& shape) {
  std::vector<TopoDS_Face> faces;
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next()) {
    faces.push_back(TopoDS::Face(face.Current()));
  }
  return faces;
}

std::string fault_of_face(const TopoDS_Face& face) {
  const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
  return surface.IsNull() ? "has no surface" : fault_of_form(surface);
}

/// Null if the library cannot.
TopoDS_Shape converted(const TopoDS_Shape& shape) {
  try {
    return BRepBuilderAPI_NurbsConvert(shape).Shape();
  } catch (const Standard_OutOfMemory&) {
    throw;
  } catch (const Standard_Failure&) {
    return {};
  }
}

/// Converts a part as a whole, so that faces go on sharing edges, or else face by face.
SplinePart spline_part(const TopoDS_Shape& part) {
  SplinePart result;
  const std::vector<TopoDS_Face> faces = faces_of(part);
  result.shape = converted(part);
  if (!result.shape.IsNull()) {
    const std::vector<TopoDS_Face> splines = faces_of(result.shape);
    if (splines.size() == faces.size()) {
      for (std::size_t i = 0; i < faces.size(); ++i) {
        result.faces.push_back({splines[i], fault_of_face(faces[i])});
      }
      return result;
    }
  }
  TopoDS_Compound all;
  BRep_Builder().MakeCompound(all);
  for (const TopoDS_Face& face : faces) {
    const TopoDS_Shape spline = converted(face);
    const std::vector<TopoDS_Face> one =
        spline.IsNull() ? std::vector<TopoDS_Face>() : faces_of(spline);
    if (one.size() == 1) {
      BRep_Builder().Add(all, one[0]);
      result.faces.push_back({one[0], fault_of_face(face)});
    } else {
      result.faces.push_back({{}, "could not be made a B-spline surface"});
    }
  }
  result.shape = all;
  return result;
}

/// Half the diagonal, as the library bounds it; nothing if that is of no use.
std::optional<double> size_of(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box, Standard_False);
  if (box.IsVoid() || box.IsOpen()) return std::nullopt;
  const double size = 0.5 * std::sqrt(box.SquareExtent());
  if (!(size > 0.0) || !std::isfinite(size)) return std::nullopt;
  return size;
}

/// Half the diagonal of points.
double size_of(const std::vector<Point>& points) {
  Point low;
  Point high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (const Point& point : points) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], point[k]);
      high[k] = std::max(high[k], point[k]);
    }
  }
  return points.empty() ? 0.0
                        : 0.5 * std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
}

/// Joins the triangles of faces.
class FacetCollector {
 public:
  explicit FacetCollector(FacetedSurface& facets) : facets_(facets) {}

  void add(const FaceMesh& face) {
    std::vector<std::uint32_t> numbers;
    for (const Point& point : face.face.mesh.points) numbers.push_back(number(point));
    for (const auto& triangle : face.face.mesh.triangles) {
      std::array<std::uint32_t, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) corners[k] = numbers[triangle[k]];
      if (face.is_reversed) std::swap(corners[1], corners[2]);
      // A side of the parameters is one point at a pole: such a triangle is a side of others.
      if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0]) {
        facets_.triangles.push_back(corners);
      }
    }
  }

 private:
  std::uint32_t number(Point point) {
    for (double& x : point) x += 0.0;  // -0 becomes 0
    const auto next = static_cast<std::uint32_t>(facets_.points.size());
    const auto [found, is_new] = numbers_.try_emplace(point, next);
    if (is_new) facets_.points.push_back(point);
    return found->second;
  }

  FacetedSurface& facets_;
  std::map<Point, std::uint32_t> numbers_;
};

/// Makes triangles of a part, finer until they are good.
class PartMesher {
 public:
  explicit PartMesher(const TopoDS_Shape& part) : part_(spline_part(part)), edges_(part_.shape) {}

  PartMesh made() {
    const std::optional<double> size = size_of(part_.shape);
    if (!size) return without_any("has no bounds");
    double deflection = kAim / kSlidePerDeflection * surfaces::kRelativeTolerance * *size;
    std::optional<Proposal> best;
    double last_error = std::numeric_limits<double>::infinity();
    int failures = 0;
    for (int i = 0; i < kMostProposals; ++i) {
      Proposal now = proposal(deflection);
      const double tolerance = surfaces::kRelativeTolerance * size_of(now.mesh.facets.points);
      const double error = now.mesh.facets.error;
      const std::size_t triangles = now.mesh.facets.triangles.size();
      if (now.without_bound > 0) ++failures;
      const bool may_fail = now.without_bound > 0 && failures < kMostFailures;
      const bool is_good = error <= tolerance && !may_fail;
      const bool helps = may_fail || error < kLittle * last_error;
      const double step = std::clamp(kAim * tolerance / error, kMostStep, kLeastStep);
      if (!best || is_better(now, *best)) best = std::move(now);
      const bool is_too_fine = static_cast<double>(triangles) / step > kMostPartTriangles;
      if (is_good || !helps || is_too_fine) break;
      last_error = error;
      deflection *= step;
    }
    return std::move(best->mesh);
  }

 private:
  struct Proposal {
    PartMesh mesh;
    std::size_t without_bound = 0;  ///< faces that another proposal may bound
  };

  static bool is_better(const Proposal& a, const Proposal& b) {
    if (a.without_bound != b.without_bound) return a.without_bound < b.without_bound;
    return a.mesh.facets.error < b.mesh.facets.error;
  }

  [[nodiscard]] PartMesh without_any(const std::string& fault) const {
    PartMesh mesh;
    for (const Face& face : part_.faces) ++mesh.left_out[face.fault.empty() ? fault : face.fault];
    return mesh;
  }

  [[nodiscard]] Proposal proposal(double deflection) const {
    BRepTools::Clean(part_.shape);
    IMeshTools_Parameters parameters;
    parameters.Deflection = deflection;
    parameters.Angle = kLargestTurn;
    parameters.InParallel = Standard_False;  // an import process may start no thread
    const BRepMesh_IncrementalMesh mesher(part_.shape, parameters);
    return refined(deflection);
  }

  /// Takes the faces that the library has made triangles of, and refines these.
  [[nodiscard]] Proposal refined(double deflection) const {
    Proposal result;
    std::vector<FaceMesh> meshes;
    for (const Face& face : part_.faces) {
      if (!face.fault.empty()) {
        ++result.mesh.left_out[face.fault];
      } else if (base::Result<FaceMesh> mesh = mesh_of_face(face.spline, edges_)) {
        meshes.push_back(*std::move(mesh));
      } else {
        leave_out(mesh.error, result);
      }
    }
    std::vector<surfaces::RefinableFace*> faces;
    for (FaceMesh& mesh : meshes) faces.push_back(&mesh.face);
    const auto point = [&](std::uint32_t edge, double t) { return edges_.point(edge, t); };
    surfaces::refine_sides(faces, point, kSlidePerDeflection * deflection, kMostPartTriangles);
    FacetCollector collector(result.mesh.facets);
    for (const FaceMesh& mesh : meshes) add(mesh, collector, result);
    return result;
  }

  static void leave_out(const std::string& fault, Proposal& result) {
    ++result.mesh.left_out[fault];
    ++result.without_bound;
  }

  static void add(const FaceMesh& mesh, FacetCollector& collector, Proposal& result) {
    const base::Result<double> error = surfaces::error_of(mesh.face.surface, mesh.face.mesh);
    if (!error) {
      leave_out(error.error, result);
      return;
    }
    collector.add(mesh);
    double& largest = result.mesh.facets.error;
    largest = std::max(largest, *error + mesh.edge_tolerance);
    ++result.mesh.faces;
  }

  SplinePart part_;
  EdgeCurves edges_;
};

}  // namespace

PartMesh mesh_of_part(const TopoDS_Shape& part) { return PartMesher(part).made(); }

}  // namespace camway::scene::cad
