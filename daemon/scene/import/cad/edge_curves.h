// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Geom_Curve.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Shape.hxx>

#include "daemon/scene/import/surfaces/faceted_surface.h"

namespace camway::scene::cad {

/// The edges of a part with their curves in space, in millimetres.
class EdgeCurves {
 public:
  explicit EdgeCurves(const TopoDS_Shape& part);

  /// Returns the number of an edge that may be split: it has a curve in space, with the parameters
  /// of its trim curves. So poles have none. The number is that of all faces that share the edge.
  [[nodiscard]] std::optional<std::uint32_t> number_of(const TopoDS_Edge& edge) const;

  /// Returns the point of an edge. Requires a number that `number_of` has returned.
  [[nodiscard]] surfaces::Point point(std::uint32_t number, double parameter) const;

 private:
  TopTools_IndexedMapOfShape edges_;
  std::vector<Handle(Geom_Curve)> curves_;  ///< null where an edge may not be split
};

}  // namespace camway::scene::cad
