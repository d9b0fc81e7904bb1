// SPDX-License-Identifier: MIT
#include "daemon/scene/import/cad/face_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <BRep_Tool.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierCurve.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_Conic.hxx>
#include <Geom_ElementarySurface.hxx>
#include <Geom_Line.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SweptSurface.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>

#include "daemon/scene/import/surfaces/knot_axis.h"

namespace camway::scene::cad {
namespace {

using surfaces::Parameters;
using surfaces::PlaneCurve;
using surfaces::TrimPiece;

bool is_exact(Handle(Geom_Curve) curve) {
  while (true) {
    const auto trimmed = Handle(Geom_TrimmedCurve)::DownCast(curve);
    if (trimmed.IsNull()) break;
    curve = trimmed->BasisCurve();
  }
  return curve->IsKind(STANDARD_TYPE(Geom_Line)) || curve->IsKind(STANDARD_TYPE(Geom_Conic)) ||
         curve->IsKind(STANDARD_TYPE(Geom_BSplineCurve)) ||
         curve->IsKind(STANDARD_TYPE(Geom_BezierCurve));
}

std::vector<double> knots_of(const TColStd_Array1OfReal& sequence) {
  std::vector<double> knots;
  for (int i = sequence.Lower(); i <= sequence.Upper(); ++i) knots.push_back(sequence(i));
  return knots;
}

surfaces::ParametricSurface surface_of(const Handle(Geom_BSplineSurface) & original) {
  const auto spline = Handle(Geom_BSplineSurface)::DownCast(original->Copy());
  surfaces::ParametricSurface result;
  if (spline->IsUPeriodic()) {
    result.periods[0] = spline->UPeriod();
    spline->SetUNotPeriodic();
  }
  if (spline->IsVPeriodic()) {
    result.periods[1] = spline->VPeriod();
    spline->SetVNotPeriodic();
  }
  surfaces::NurbsSurface& surface = result.surface;
  surface.u_knots = knots_of(spline->UKnotSequence());
  surface.v_knots = knots_of(spline->VKnotSequence());
  surface.u_points = static_cast<std::size_t>(spline->NbUPoles());
  surface.v_points = static_cast<std::size_t>(spline->NbVPoles());
  for (int j = 1; j <= spline->NbVPoles(); ++j) {
    for (int i = 1; i <= spline->NbUPoles(); ++i) {
      const gp_Pnt p = spline->Pole(i, j);
      const double w = spline->Weight(i, j);
      surface.points.push_back({w * p.X(), w * p.Y(), w * p.Z(), w});
    }
  }
  return result;
}

/// Fails if it is no B-spline that the hull of its control points holds.
base::Result<PlaneCurve> plane_curve_of(Handle(Geom2d_Curve) curve) {
  while (true) {
    const auto trimmed = Handle(Geom2d_TrimmedCurve)::DownCast(curve);
    if (trimmed.IsNull()) break;
    curve = trimmed->BasisCurve();
  }
  if (curve.IsNull()) return base::Failure{"has an edge without a trim curve"};
  const auto original = Handle(Geom2d_BSplineCurve)::DownCast(curve);
  if (original.IsNull()) return base::Failure{"has a trim curve that is no B-spline"};
  const auto spline = Handle(Geom2d_BSplineCurve)::DownCast(original->Copy());
  PlaneCurve result;
  if (spline->IsPeriodic()) {
    result.period = spline->Period();
    spline->SetNotPeriodic();
  }
  if (spline->Degree() > static_cast<int>(surfaces::kMostDegree)) {
    return base::Failure{"has a trim curve of a degree that is too high"};
  }
  result.knots = knots_of(spline->KnotSequence());
  for (int i = 1; i <= spline->NbPoles(); ++i) {
    const gp_Pnt2d p = spline->Pole(i);
    const double w = spline->Weight(i);
    if (!(w > 0.0)) return base::Failure{"has a trim curve with a weight that is not positive"};
    result.points.push_back({w * p.X(), w * p.Y(), 0.0, w});
  }
  return result;
}

/// Collects the mesh of one face.
class FaceReader {
 public:
  FaceReader(const TopoDS_Face& face, const Handle(Poly_Triangulation) & triangulation,
             const TopLoc_Location& place, const EdgeCurves& edges)
      : face_(TopoDS::Face(face.Oriented(TopAbs_FORWARD))),
        triangulation_(triangulation),
        place_(place),
        edges_(edges) {}

  base::Result<FaceMesh> read(const Handle(Geom_BSplineSurface) & surface) {
    result_.face.surface = surface_of(surface);
    take_nodes();
    for (TopExp_Explorer edge(face_, TopAbs_EDGE); edge.More(); edge.Next()) {
      const TopAbs_Orientation side = edge.Current().Orientation();
      if (side != TopAbs_FORWARD && side != TopAbs_REVERSED) continue;  // not of the boundary
      if (std::string fault = take_edge(TopoDS::Edge(edge.Current())); !fault.empty()) {
        return base::Failure{std::move(fault)};
      }
    }
    return std::move(result_);
  }

 private:
  void take_nodes() {
    const gp_Trsf& move = place_.Transformation();
    for (int i = 1; i <= triangulation_->NbNodes(); ++i) {
      const gp_Pnt point = triangulation_->Node(i).Transformed(move);
      const gp_Pnt2d at = triangulation_->UVNode(i);
      result_.face.mesh.points.push_back({point.X(), point.Y(), point.Z()});
      result_.face.mesh.parameters.push_back({at.X(), at.Y()});
    }
    for (int i = 1; i <= triangulation_->NbTriangles(); ++i) {
      std::array<int, 3> nodes;
      triangulation_->Triangle(i).Get(nodes[0], nodes[1], nodes[2]);
      result_.face.mesh.triangles.push_back({node(nodes[0]), node(nodes[1]), node(nodes[2])});
    }
  }
  static std::uint32_t node(int number) { return static_cast<std::uint32_t>(number - 1); }

  /// The nodes along a trim curve. A seam has two such curves in one face, and the library may
  /// exchange their nodes.
  Handle(Poly_PolygonOnTriangulation)
      polygon_of(const TopoDS_Edge& edge, const Handle(Geom2d_Curve) & trim) const {
    Handle(Poly_PolygonOnTriangulation) nearest;
    double least = 0.0;
    for (const bool is_other : {false, true}) {
      const Handle(Poly_PolygonOnTriangulation) polygon = BRep_Tool::PolygonOnTriangulation(
          is_other ? TopoDS::Edge(edge.Reversed()) : edge, triangulation_, place_);
      if (polygon.IsNull() || !polygon->HasParameters()) continue;
      double off = 0.0;
      for (const int i : {1, polygon->NbNodes()}) {
        const gp_Pnt2d at = trim->Value(polygon->Parameter(i));
        off += at.Distance(triangulation_->UVNode(polygon->Node(i)));
      }
      if (!nearest.IsNull() && off >= least) continue;
      nearest = polygon;
      least = off;
    }
    return nearest;
  }

  /// Returns the fault, or nothing.
  std::string take_edge(const TopoDS_Edge& edge) {
    double first = 0.0;
    double last = 0.0;
    const Handle(Geom2d_Curve) trim = BRep_Tool::CurveOnSurface(edge, face_, first, last);
    const base::Result<PlaneCurve> curve = plane_curve_of(trim);
    if (!curve) return curve.error;
    const Handle(Poly_PolygonOnTriangulation) polygon = polygon_of(edge, trim);
    if (polygon.IsNull()) return "has an edge without nodes";
    for (int i = 1; i < polygon->NbNodes(); ++i) add_piece(edge, *curve, *polygon, i);
    result_.face.curves.push_back(*curve);
    result_.edge_tolerance = std::max(result_.edge_tolerance, BRep_Tool::Tolerance(edge));
    return {};
  }

  /// Adds the piece from node i to the next, of an edge whose trim curve is added after.
  void add_piece(const TopoDS_Edge& edge, const PlaneCurve& curve,
                 const Poly_PolygonOnTriangulation& polygon, int i) {
    surfaces::BoundarySource source;
    if (const std::optional<std::uint32_t> number = edges_.number_of(edge)) {
      source.piece = surfaces::EdgePiece{*number, static_cast<std::uint32_t>(i)};
    }
    source.curve = result_.face.curves.size();
    source.from = polygon.Parameter(i);
    source.to = polygon.Parameter(i + 1);
    TrimPiece piece{{node(polygon.Node(i)), node(polygon.Node(i + 1))},
                    surfaces::hull_of(curve, source.from, source.to)};
    if (edge.Orientation() == TopAbs_REVERSED) {
      std::swap(piece.nodes[0], piece.nodes[1]);
      std::swap(source.from, source.to);
    }
    result_.face.mesh.boundary.push_back(std::move(piece));
    result_.face.sources.push_back(source);
  }

  const TopoDS_Face face_;
  const Handle(Poly_Triangulation) triangulation_;
  const TopLoc_Location place_;
  const EdgeCurves& edges_;
  FaceMesh result_;
};

}  // namespace

std::string fault_of_form(const Handle(Geom_Surface) & surface) {
  if (const auto trimmed = Handle(Geom_RectangularTrimmedSurface)::DownCast(surface);
      !trimmed.IsNull()) {
    return fault_of_form(trimmed->BasisSurface());
  }
  if (surface->IsKind(STANDARD_TYPE(Geom_OffsetSurface))) return "is offset from another surface";
  if (const auto swept = Handle(Geom_SweptSurface)::DownCast(surface); !swept.IsNull()) {
    return is_exact(swept->BasisCurve()) ? "" : "is swept from a curve without an exact form";
  }
  const bool is_known = surface->IsKind(STANDARD_TYPE(Geom_ElementarySurface)) ||
                        surface->IsKind(STANDARD_TYPE(Geom_BSplineSurface)) ||
                        surface->IsKind(STANDARD_TYPE(Geom_BezierSurface));
  return is_known ? "" : "is of a kind that is not known";
}

base::Result<FaceMesh> mesh_of_face(const TopoDS_Face& face, const EdgeCurves& edges) {
  const auto surface = Handle(Geom_BSplineSurface)::DownCast(BRep_Tool::Surface(face));
  if (surface.IsNull()) return base::Failure{"could not be made a B-spline surface"};
  TopLoc_Location place;
  const Handle(Poly_Triangulation) triangulation = BRep_Tool::Triangulation(face, place);
  if (triangulation.IsNull() || triangulation->NbTriangles() == 0) {
    return base::Failure{"could not be made triangles"};
  }
  if (!triangulation->HasUVNodes()) return base::Failure{"has triangles without parameters"};
  base::Result<FaceMesh> result = FaceReader(face, triangulation, place, edges).read(surface);
  if (result) result->is_reversed = face.Orientation() == TopAbs_REVERSED;
  return result;
}

}  // namespace camway::scene::cad
