// SPDX-License-Identifier: MIT
#include "daemon/scene/import/inventor/coordinates.h"

#include <Inventor/SbVec3f.h>
#include <Inventor/SbVec4f.h>
#include <Inventor/VRMLnodes/SoVRMLCoordinate.h>
#include <Inventor/VRMLnodes/SoVRMLVertexShape.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/elements/SoCoordinateElement.h>
#include <Inventor/misc/SoState.h>
#include <Inventor/nodes/SoVertexProperty.h>
#include <Inventor/nodes/SoVertexShape.h>

#include <algorithm>
#include <cmath>

namespace camway::scene::inventor {

Coordinates::Coordinates(SoCallbackAction& action, const SoNode& shape) {
  if (shape.isOfType(SoVRMLVertexShape::getClassTypeId())) {
    const SoNode* const node = static_cast<const SoVRMLVertexShape&>(shape).coord.getValue();
    if (node == nullptr || !node->isOfType(SoVRMLCoordinate::getClassTypeId())) return;
    const SoMFVec3f& points = static_cast<const SoVRMLCoordinate*>(node)->point;
    take(points.getValues(0), points.getNum());
    return;
  }
  if (shape.isOfType(SoVertexShape::getClassTypeId())) {
    const SoNode* const node = static_cast<const SoVertexShape&>(shape).vertexProperty.getValue();
    if (node != nullptr && node->isOfType(SoVertexProperty::getClassTypeId())) {
      const SoMFVec3f& points = static_cast<const SoVertexProperty*>(node)->vertex;
      if (points.getNum() > 0) {
        take(points.getValues(0), points.getNum());
        return;
      }
    }
  }
  const SoCoordinateElement* const element = SoCoordinateElement::getInstance(action.getState());
  if (element->is3D() == TRUE) {
    take(element->getArrayPtr3(), element->getNum());
    return;
  }
  weighted_ = element->getArrayPtr4();
  size_ = weighted_ == nullptr ? 0 : static_cast<std::size_t>(std::max(0, element->getNum()));
}

void Coordinates::take(const SbVec3f* points, int count) {
  plain_ = points;
  size_ = points == nullptr ? 0 : static_cast<std::size_t>(std::max(0, count));
}

std::array<double, 4> Coordinates::weighted(std::size_t i) const {
  std::array<double, 4> result = {0.0, 0.0, 0.0, 1.0};
  const int parts = plain_ != nullptr ? 3 : 4;
  for (int k = 0; k < parts; ++k) {
    result[static_cast<std::size_t>(k)] =
        static_cast<double>(plain_ != nullptr ? plain_[i][k] : weighted_[i][k]);
  }
  return result;
}

Point Coordinates::point(std::size_t i) const {
  const std::array<double, 4> p = weighted(i);
  if (plain_ != nullptr) return {p[0], p[1], p[2]};
  return {p[0] / p[3], p[1] / p[3], p[2] / p[3]};
}

void ShapeVertices::begin(const Coordinates& coordinates, const Placement& placement) {
  coordinates_ = &coordinates;
  placement_ = &placement;
  largest_ = {};
  ++shape_;
  if (known_.size() < coordinates.size()) known_.resize(coordinates.size());
}

std::uint32_t ShapeVertices::vertex(std::int64_t number) {
  if (number < 0 || static_cast<std::uint64_t>(number) >= coordinates_->size()) {
    return mesh_readers::kNoVertex;
  }
  const auto i = static_cast<std::size_t>(number);
  Known& known = known_[i];
  if (known.shape != shape_) {
    const Point point = coordinates_->point(i);
    for (std::size_t k = 0; k < 3; ++k) {
      if (std::isfinite(point[k])) largest_[k] = std::max(largest_[k], std::abs(point[k]));
    }
    known = {shape_, mesh_.add_vertex(placement_->apply(point))};
  }
  return known.index;
}

}  // namespace camway::scene::inventor
