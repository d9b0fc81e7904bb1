// SPDX-License-Identifier: MIT
#include "daemon/scene/import/cad/edge_curves.h"

#include <BRep_Tool.hxx>
#include <TopExp.hxx>
#include <TopoDS.hxx>
#include <gp_Pnt.hxx>

namespace camway::scene::cad {
namespace {

/// Null if an edge may not be split.
Handle(Geom_Curve) curve_of(const TopoDS_Edge& edge) {
  if (BRep_Tool::Degenerated(edge)) return {};
  if (!BRep_Tool::SameParameter(edge) || !BRep_Tool::SameRange(edge)) return {};
  double first = 0.0;
  double last = 0.0;
  return BRep_Tool::Curve(edge, first, last);
}

}  // namespace

EdgeCurves::EdgeCurves(const TopoDS_Shape& part) {
  TopExp::MapShapes(part, TopAbs_EDGE, edges_);
  for (int i = 1; i <= edges_.Extent(); ++i) curves_.push_back(curve_of(TopoDS::Edge(edges_(i))));
}

std::optional<std::uint32_t> EdgeCurves::number_of(const TopoDS_Edge& edge) const {
  const int index = edges_.FindIndex(edge);  // from 1, or 0
  if (index == 0 || curves_[static_cast<std::size_t>(index - 1)].IsNull()) return std::nullopt;
  return static_cast<std::uint32_t>(index - 1);
}

surfaces::Point EdgeCurves::point(std::uint32_t number, double parameter) const {
  const gp_Pnt point = curves_[number]->Value(parameter);
  return {point.X(), point.Y(), point.Z()};
}

}  // namespace camway::scene::cad
