// SPDX-License-Identifier: MIT
#include "daemon/scene/import/inventor/shape_reader.h"

#include <Inventor/SbMatrix.h>
#include <Inventor/SoFullPath.h>
#include <Inventor/SoPrimitiveVertex.h>
#include <Inventor/VRMLnodes/SoVRMLBox.h>
#include <Inventor/VRMLnodes/SoVRMLCone.h>
#include <Inventor/VRMLnodes/SoVRMLCylinder.h>
#include <Inventor/VRMLnodes/SoVRMLElevationGrid.h>
#include <Inventor/VRMLnodes/SoVRMLIndexedFaceSet.h>
#include <Inventor/VRMLnodes/SoVRMLIndexedLineSet.h>
#include <Inventor/VRMLnodes/SoVRMLSphere.h>
#include <Inventor/VRMLnodes/SoVRMLSwitch.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/lists/SoNodeList.h>
#include <Inventor/nodes/SoCone.h>
#include <Inventor/nodes/SoCube.h>
#include <Inventor/nodes/SoCylinder.h>
#include <Inventor/nodes/SoFaceSet.h>
#include <Inventor/nodes/SoIndexedFaceSet.h>
#include <Inventor/nodes/SoIndexedLineSet.h>
#include <Inventor/nodes/SoIndexedNurbsSurface.h>
#include <Inventor/nodes/SoIndexedTriangleStripSet.h>
#include <Inventor/nodes/SoLineSet.h>
#include <Inventor/nodes/SoNurbsSurface.h>
#include <Inventor/nodes/SoPathSwitch.h>
#include <Inventor/nodes/SoQuadMesh.h>
#include <Inventor/nodes/SoShape.h>
#include <Inventor/nodes/SoSphere.h>
#include <Inventor/nodes/SoSwitch.h>
#include <Inventor/nodes/SoTriangleStripSet.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "daemon/scene/import/inventor/coordinates.h"
#include "daemon/scene/import/inventor/placement.h"
#include "daemon/scene/import/inventor/transform_tracker.h"
#include "daemon/scene/import/surfaces/nurbs_surface.h"
#include "daemon/scene/import/surfaces/quadrics.h"

namespace camway::scene::inventor {
namespace {

using mesh_readers::MeshCollector;
using surfaces::FacetedSurface;
using Response = SoCallbackAction::Response;

/// Shapes that Coin makes triangles of, which are theirs: a text of its own font, an extrusion.
constexpr std::array<std::string_view, 4> kTriangulatedByCoin = {"Text3", "AsciiText", "VRMLText",
                                                                 "VRMLExtrusion"};
/// Points, lines and pictures on the screen.
constexpr std::array<std::string_view, 13> kNoSurfaces = {"Text2",        "Image",
                                                          "PointSet",     "IndexedPointSet",
                                                          "MarkerSet",    "IndexedMarkerSet",
                                                          "LineSet",      "IndexedLineSet",
                                                          "NurbsCurve",   "IndexedNurbsCurve",
                                                          "VRMLPointSet", "VRMLIndexedLineSet",
                                                          "VRMLLineSet"};

bool contains(std::span<const std::string_view> names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

/// Traverses a scene with Coin's action of callbacks, and adds each shape to a mesh.
class ShapeReader {
 public:
  explicit ShapeReader(MeshCollector& mesh) : mesh_(mesh), vertices_(mesh) {}

  ShapeCounts read(SoNode& root) {
    SoCallbackAction action;
    const SoType all = SoNode::getClassTypeId();
    action.addPreCallback(all, on_enter, this);
    action.addPostCallback(all, on_leave, this);
    action.addTriangleCallback(SoShape::getClassTypeId(), on_triangle, this);
    action.apply(&root);
    return std::move(counts_);
  }

 private:
  static Response on_enter(void* self, SoCallbackAction* action, const SoNode* node) {
    return static_cast<ShapeReader*>(self)->enter(*action, *node);
  }
  static Response on_leave(void* self, SoCallbackAction* action, const SoNode* node) {
    static_cast<ShapeReader*>(self)->transforms_.leave(*action, *node);
    return SoCallbackAction::CONTINUE;
  }
  static void on_triangle(void* self, SoCallbackAction* action, const SoPrimitiveVertex* a,
                          const SoPrimitiveVertex* b, const SoPrimitiveVertex* c) {
    static_cast<ShapeReader*>(self)->add_triangle(*action, {a, b, c});
  }

  Response enter(SoCallbackAction& action, const SoNode& node) {
    transforms_.enter(action, node);
    count_not_chosen(action, node);
    if (!node.isOfType(SoShape::getClassTypeId())) {
      static const SoType kDragger = SoType::fromName("Dragger");
      return node.isOfType(kDragger) ? SoCallbackAction::PRUNE : SoCallbackAction::CONTINUE;
    }
    if (mesh_.vertex_count() + mesh_.triangle_count() > kMostVerticesAndTriangles) {
      counts_.is_too_large = true;
      return SoCallbackAction::ABORT;
    }
    return read_shape(action, node);
  }

  void count_not_chosen(const SoCallbackAction& action, const SoNode& node) {
    int which = SO_SWITCH_ALL;
    int children = 0;
    if (node.isOfType(SoSwitch::getClassTypeId())) {
      const auto& choice = static_cast<const SoSwitch&>(node);
      which = choice.whichChild.getValue();
      if (which == SO_SWITCH_INHERIT) which = action.getSwitch();
      children = choice.getNumChildren();
    } else if (node.isOfType(SoVRMLSwitch::getClassTypeId())) {
      const auto& choice = static_cast<const SoVRMLSwitch&>(node);
      which = choice.whichChoice.getValue();
      children = choice.getNumChildren();
    } else if (node.isOfType(SoPathSwitch::getClassTypeId())) {
      which = SO_SWITCH_NONE;
      children = static_cast<const SoPathSwitch&>(node).getNumChildren();
    }
    if (which == SO_SWITCH_ALL) return;
    const bool has_one = which >= 0 && which < children;
    counts_.not_chosen += static_cast<std::uint64_t>(children - (has_one ? 1 : 0));
  }

  Response read_shape(SoCallbackAction& action, const SoNode& node) {
    const std::string type = node.getTypeId().getName().getString();
    if (action.getDrawStyle() == SoDrawStyle::INVISIBLE) {
      ++counts_.invisible;
      return SoCallbackAction::PRUNE;
    }
    if (contains(kNoSurfaces, type)) {
      ++counts_.no_surface[type];
      count_points_and_lines(action, node);
      return SoCallbackAction::PRUNE;
    }
    placement_.emplace(action.getModelMatrix());
    is_reversed_ = placement_->mirrors();
    mesh_.begin_object(name_of(action, type));
    if (contains(kTriangulatedByCoin, type)) {
      ++counts_.shapes;
      if (type != "VRMLExtrusion") ++counts_.texts;
      return SoCallbackAction::CONTINUE;
    }
    const bool is_read = add_quadric(node) || add_box(node) || add_faces(action, node) ||
                         add_strips(action, node) || add_grid(action, node) ||
                         add_nurbs(action, node);
    ++(is_read ? counts_.shapes : counts_.unknown[type]);
    return SoCallbackAction::PRUNE;
  }

  /// The name of the shape, of the nearest node above it that has one, or of its type.
  static std::string name_of(SoCallbackAction& action, const std::string& type) {
    const auto* const path = static_cast<const SoFullPath*>(action.getCurPath());
    for (int i = path == nullptr ? 0 : path->getLength(); i-- > 0;) {
      const SbName name = path->getNode(i)->getName();
      if (name.getLength() > 0) return name.getString();
    }
    return type;
  }

  template <class Counts>
  static std::uint64_t runs(const Counts& indices) {
    std::uint64_t count = 0;
    bool is_open = false;
    for (int i = 0; i < indices.getNum(); ++i) {
      if (indices[i] >= 0 && !is_open) ++count;
      is_open = indices[i] >= 0;
    }
    return count;
  }

  void count_points_and_lines(SoCallbackAction& action, const SoNode& node) {
    std::uint64_t count = 1;
    if (node.isOfType(SoIndexedShape::getClassTypeId())) {
      count = runs(static_cast<const SoIndexedShape&>(node).coordIndex);
    } else if (node.isOfType(SoVRMLIndexedLineSet::getClassTypeId())) {
      count = runs(static_cast<const SoVRMLIndexedLineSet&>(node).coordIndex);
    } else if (node.isOfType(SoLineSet::getClassTypeId())) {
      count = static_cast<std::uint64_t>(static_cast<const SoLineSet&>(node).numVertices.getNum());
    } else if (node.isOfType(SoNonIndexedShape::getClassTypeId())) {
      count = Coordinates(action, node).size();
    }
    mesh_.add_points_and_lines(count);
  }

  // --- shapes of Open Inventor and VRML without vertices ---

  bool add_quadric(const SoNode& node) {
    const auto number = [](const SoSFFloat& field) {
      return static_cast<double>(field.getValue());
    };
    const auto is_any = [&](SoType type) { return node.isOfType(type); };
    if (is_any(SoSphere::getClassTypeId())) {
      add_smooth(surfaces::sphere(number(static_cast<const SoSphere&>(node).radius)));
    } else if (is_any(SoVRMLSphere::getClassTypeId())) {
      add_smooth(surfaces::sphere(number(static_cast<const SoVRMLSphere&>(node).radius)));
    } else if (is_any(SoCylinder::getClassTypeId())) {
      const auto& c = static_cast<const SoCylinder&>(node);
      const int parts = c.parts.getValue();
      add_smooth(
          surfaces::cylinder(number(c.radius), number(c.height),
                             {(parts & SoCylinder::SIDES) != 0, (parts & SoCylinder::TOP) != 0,
                              (parts & SoCylinder::BOTTOM) != 0}));
    } else if (is_any(SoVRMLCylinder::getClassTypeId())) {
      const auto& c = static_cast<const SoVRMLCylinder&>(node);
      add_smooth(surfaces::cylinder(
          number(c.radius), number(c.height),
          {c.side.getValue() == TRUE, c.top.getValue() == TRUE, c.bottom.getValue() == TRUE}));
    } else if (is_any(SoCone::getClassTypeId())) {
      const auto& c = static_cast<const SoCone&>(node);
      const int parts = c.parts.getValue();
      add_smooth(
          surfaces::cone(number(c.bottomRadius), number(c.height),
                         {(parts & SoCone::SIDES) != 0, false, (parts & SoCone::BOTTOM) != 0}));
    } else if (is_any(SoVRMLCone::getClassTypeId())) {
      const auto& c = static_cast<const SoVRMLCone&>(node);
      add_smooth(surfaces::cone(number(c.bottomRadius), number(c.height),
                                {c.side.getValue() == TRUE, false, c.bottom.getValue() == TRUE}));
    } else {
      return false;
    }
    return true;
  }

  void add_smooth(const FacetedSurface& surface) {
    add_facets(surface, true);
    note_error(surface.error * placement_->stretch());
    ++counts_.smooth;
  }

  /// A value that is not finite belongs to a triangle that is left out, and has no error.
  static void raise(double& bound, double value) {
    if (std::isfinite(value)) bound = std::max(bound, value);
  }
  void note_error(double error) { raise(counts_.surface_error, error); }

  /// `is_local`: whether the points are those of the shape, and not of the scene.
  void add_facets(const FacetedSurface& surface, bool is_local) {
    const auto first = static_cast<std::uint32_t>(mesh_.vertex_count());
    Point largest{};
    for (const Point& point : surface.points) {
      mesh_.add_vertex(is_local ? placement_->apply(point) : point);
      for (std::size_t k = 0; k < 3; ++k) largest[k] = std::max(largest[k], std::abs(point[k]));
    }
    for (const auto& facet : surface.triangles) {
      add_polygon({first + facet[0], first + facet[1], first + facet[2]});
    }
    if (is_local) note_rounding(largest);
  }

  bool add_box(const SoNode& node) {
    Point half;
    if (node.isOfType(SoCube::getClassTypeId())) {
      const auto& cube = static_cast<const SoCube&>(node);
      half = {static_cast<double>(cube.width.getValue()),
              static_cast<double>(cube.height.getValue()),
              static_cast<double>(cube.depth.getValue())};
    } else if (node.isOfType(SoVRMLBox::getClassTypeId())) {
      const SbVec3f size = static_cast<const SoVRMLBox&>(node).size.getValue();
      half = {static_cast<double>(size[0]), static_cast<double>(size[1]),
              static_cast<double>(size[2])};
    } else {
      return false;
    }
    for (double& x : half) x *= 0.5;
    FacetedSurface box;  // corner i is on the upper side of the axes whose bits it has
    for (unsigned i = 0; i < 8; ++i) {
      box.points.push_back({(i & 1U) != 0 ? half[0] : -half[0], (i & 2U) != 0 ? half[1] : -half[1],
                            (i & 4U) != 0 ? half[2] : -half[2]});
    }
    box.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                     {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    add_facets(box, true);
    return true;
  }

  // --- shapes of vertices ---

  void begin_vertices(const Coordinates& coordinates, bool is_clockwise) {
    vertices_.begin(coordinates, *placement_);
    is_reversed_ = placement_->mirrors() != is_clockwise;
  }

  static bool is_clockwise(const SoCallbackAction& action) {
    return action.getVertexOrdering() == SoShapeHints::CLOCKWISE;
  }

  bool add_faces(SoCallbackAction& action, const SoNode& node) {
    const bool is_indexed = node.isOfType(SoIndexedFaceSet::getClassTypeId());
    const bool is_vrml = node.isOfType(SoVRMLIndexedFaceSet::getClassTypeId());
    const bool is_listed = node.isOfType(SoFaceSet::getClassTypeId());
    if (!is_indexed && !is_vrml && !is_listed) return false;
    const Coordinates coordinates(action, node);
    if (is_vrml) {
      const auto& faces = static_cast<const SoVRMLIndexedFaceSet&>(node);
      begin_vertices(coordinates, faces.ccw.getValue() != TRUE);
      add_indexed(faces.coordIndex, [&] { add_polygon(corners_); });
    } else if (is_indexed) {
      begin_vertices(coordinates, is_clockwise(action));
      add_indexed(static_cast<const SoIndexedFaceSet&>(node).coordIndex,
                  [&] { add_polygon(corners_); });
    } else {
      begin_vertices(coordinates, is_clockwise(action));
      const auto& faces = static_cast<const SoFaceSet&>(node);
      add_listed(faces.numVertices, faces.startIndex.getValue(), coordinates.size(),
                 [&] { add_polygon(corners_); });
    }
    note_rounding(vertices_.largest());
    return true;
  }

  bool add_strips(SoCallbackAction& action, const SoNode& node) {
    const bool is_indexed = node.isOfType(SoIndexedTriangleStripSet::getClassTypeId());
    if (!is_indexed && !node.isOfType(SoTriangleStripSet::getClassTypeId())) return false;
    const Coordinates coordinates(action, node);
    begin_vertices(coordinates, is_clockwise(action));
    const auto add_strip = [&] {
      for (std::size_t i = 0; i + 2 < corners_.size(); ++i) {
        const std::size_t odd = i % 2;
        add_polygon({corners_[i + odd], corners_[i + 1 - odd], corners_[i + 2]});
      }
    };
    if (is_indexed) {
      add_indexed(static_cast<const SoIndexedTriangleStripSet&>(node).coordIndex, add_strip);
    } else {
      const auto& strips = static_cast<const SoTriangleStripSet&>(node);
      add_listed(strips.numVertices, strips.startIndex.getValue(), coordinates.size(), add_strip);
    }
    note_rounding(vertices_.largest());
    return true;
  }

  /// Calls `add` with the corners of each run of indices between negative ones.
  template <class Indices, class Add>
  void add_indexed(const Indices& indices, const Add& add) {
    const int count = indices.getNum();
    const std::int32_t* const values = indices.getValues(0);
    corners_.clear();
    for (int i = 0; i <= count; ++i) {
      if (i < count && values[i] >= 0) {
        corners_.push_back(vertices_.vertex(values[i]));
      } else if (!corners_.empty()) {
        add();
        corners_.clear();
      }
    }
  }

  /// The same for runs of the numbers of vertices in `counts`. A negative one means all that are
  /// left.
  void add_listed(const SoMFInt32& counts, std::int64_t next, std::size_t size, const auto& add) {
    const auto end = static_cast<std::int64_t>(size);
    for (int i = 0; i < counts.getNum(); ++i) {
      const std::int64_t asked = counts[i] < 0 ? end - next : counts[i];
      // One index past the end says as much as a million of them: that a vertex is missing.
      const std::int64_t stop = std::min(next + asked, std::max(next, end + 1));
      corners_.clear();
      for (std::int64_t k = next; k < stop; ++k) corners_.push_back(vertices_.vertex(k));
      if (asked >= 3 && corners_.size() < 3) corners_.resize(3, mesh_readers::kNoVertex);
      if (!corners_.empty()) add();
      next += asked;
    }
  }

  bool add_grid(SoCallbackAction& action, const SoNode& node) {
    if (node.isOfType(SoQuadMesh::getClassTypeId())) {
      const auto& grid = static_cast<const SoQuadMesh&>(node);
      const Coordinates coordinates(action, node);
      begin_vertices(coordinates, is_clockwise(action));
      const std::int64_t columns = grid.verticesPerRow.getValue();
      const std::int64_t rows = grid.verticesPerColumn.getValue();
      const std::int64_t start = grid.startIndex.getValue();
      const auto end = static_cast<std::int64_t>(coordinates.size());
      for (std::int64_t row = 0; columns > 0 && row + 1 < rows && start + row * columns < end;
           ++row) {
        for (std::int64_t i = start + row * columns; i + 1 < start + (row + 1) * columns; ++i) {
          if (i >= end) break;
          add_polygon({vertices_.vertex(i), vertices_.vertex(i + columns),
                       vertices_.vertex(i + columns + 1), vertices_.vertex(i + 1)});
        }
      }
      note_rounding(vertices_.largest());
      return true;
    }
    if (!node.isOfType(SoVRMLElevationGrid::getClassTypeId())) return false;
    add_elevations(static_cast<const SoVRMLElevationGrid&>(node));
    return true;
  }

  void add_elevations(const SoVRMLElevationGrid& grid) {
    const std::int64_t columns = grid.xDimension.getValue();
    const std::int64_t rows = grid.zDimension.getValue();
    if (columns < 2 || rows < 2 || columns > grid.height.getNum() / rows) return;
    FacetedSurface surface;
    for (std::int64_t i = 0; i < columns * rows; ++i) {
      surface.points.push_back(
          {static_cast<double>(i % columns) * static_cast<double>(grid.xSpacing.getValue()),
           static_cast<double>(grid.height[static_cast<int>(i)]),
           static_cast<double>(i / columns) * static_cast<double>(grid.zSpacing.getValue())});
    }
    if (grid.ccw.getValue() != TRUE) is_reversed_ = !is_reversed_;
    for (std::int64_t row = 0; row + 1 < rows; ++row) {
      for (std::int64_t column = 0; column + 1 < columns; ++column) {
        const auto a = static_cast<std::uint32_t>(row * columns + column);
        const auto c = static_cast<std::uint32_t>(a + columns);
        surface.triangles.push_back({a, c, c + 1});
        surface.triangles.push_back({a, c + 1, a + 1});
      }
    }
    add_facets(surface, true);
  }

  // --- NURBS ---

  bool add_nurbs(SoCallbackAction& action, const SoNode& node) {
    surfaces::NurbsSurface surface;
    const Coordinates coordinates(action, node);
    if (node.isOfType(SoNurbsSurface::getClassTypeId())) {
      const auto& nurbs = static_cast<const SoNurbsSurface&>(node);
      set_sizes(nurbs, surface);
      const std::size_t count = points_of(surface, coordinates.size());
      for (std::size_t i = 0; i < count; ++i) surface.points.push_back(placed(coordinates, i));
    } else if (node.isOfType(SoIndexedNurbsSurface::getClassTypeId())) {
      const auto& nurbs = static_cast<const SoIndexedNurbsSurface&>(node);
      set_sizes(nurbs, surface);
      const std::size_t count =
          points_of(surface, static_cast<std::size_t>(nurbs.coordIndex.getNum()));
      for (std::size_t i = 0; i < count; ++i) {
        const std::int32_t index = nurbs.coordIndex[static_cast<int>(i)];
        if (index < 0 || static_cast<std::size_t>(index) >= coordinates.size()) break;
        surface.points.push_back(placed(coordinates, static_cast<std::size_t>(index)));
      }
    } else {
      return false;
    }
    add_nurbs_surface(surface);
    if (action.getProfile().getLength() > 0) ++counts_.trimmed;
    return true;
  }

  template <class Nurbs>
  static void set_sizes(const Nurbs& nurbs, surfaces::NurbsSurface& surface) {
    const auto size = [](const SoSFInt32& field) {
      return static_cast<std::size_t>(std::max(0, field.getValue()));
    };
    surface.u_points = size(nurbs.numUControlPoints);
    surface.v_points = size(nurbs.numVControlPoints);
    const auto take = [](const SoMFFloat& field, std::vector<double>& knots) {
      for (int i = 0; i < field.getNum(); ++i) knots.push_back(static_cast<double>(field[i]));
    };
    take(nurbs.uKnotVector, surface.u_knots);
    take(nurbs.vKnotVector, surface.v_knots);
  }

  /// The number of control points, or 0 if there are not so many.
  static std::size_t points_of(const surfaces::NurbsSurface& surface, std::size_t available) {
    if (surface.u_points == 0 || surface.v_points > available / surface.u_points) return 0;
    return surface.u_points * surface.v_points;
  }

  [[nodiscard]] surfaces::WeightedPoint placed(const Coordinates& coordinates,
                                               std::size_t i) const {
    return placement_->apply(coordinates.weighted(i));
  }

  void add_nurbs_surface(const surfaces::NurbsSurface& surface) {
    Point low;
    Point high;
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
    for (const surfaces::WeightedPoint& point : surface.points) {
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], point[k] / point[3]);
        high[k] = std::max(high[k], point[k] / point[3]);
      }
    }
    // Half the diagonal of the control points is what the radius is for a sphere.
    const double size = 0.5 * std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
    const base::Result<FacetedSurface> facets =
        surfaces::facets_of(surface, surfaces::kRelativeTolerance * size);
    if (!facets) {
      ++counts_.no_freeform[facets.error];
      mesh_.add_freeform_surface();
      return;
    }
    add_facets(*facets, false);
    Point largest;
    for (std::size_t k = 0; k < 3; ++k) largest[k] = std::max(std::abs(low[k]), std::abs(high[k]));
    note_rounding(largest);
    note_error(facets->error);
    ++counts_.smooth;
  }

  // --- the mesh ---

  void add_polygon(std::initializer_list<std::uint32_t> corners) {
    polygon_.assign(corners);
    add_polygon(polygon_);
  }

  void add_polygon(std::vector<std::uint32_t>& corners) {
    if (is_reversed_) std::ranges::reverse(corners);
    mesh_.add_polygon(corners);
  }

  /// A triangle that Coin made.
  void add_triangle(SoCallbackAction& action,
                    const std::array<const SoPrimitiveVertex*, 3>& corners) {
    const Placement placement(action.getModelMatrix());
    Point largest{};
    polygon_.clear();
    for (const SoPrimitiveVertex* const corner : corners) {
      Point point;
      for (std::size_t k = 0; k < 3; ++k) {
        point[k] = static_cast<double>(corner->getPoint()[static_cast<int>(k)]);
        largest[k] = std::max(largest[k], std::abs(point[k]));
      }
      polygon_.push_back(mesh_.add_vertex(placement.apply(point)));
    }
    is_reversed_ = placement.mirrors();
    add_polygon(polygon_);
    note_rounding(largest);
  }

  void note_rounding(const Point& largest) {
    raise(counts_.rounding, transforms_.chain().rounding(largest));
  }

  MeshCollector& mesh_;
  ShapeVertices vertices_;
  TransformTracker transforms_;
  ShapeCounts counts_;
  std::optional<Placement> placement_;  ///< of the shape that is read
  bool is_reversed_ = false;            ///< whether its polygons turn the other way
  std::vector<std::uint32_t> corners_;
  std::vector<std::uint32_t> polygon_;
};

}  // namespace

ShapeCounts add_shapes(SoNode& root, MeshCollector& mesh) { return ShapeReader(mesh).read(root); }

}  // namespace camway::scene::inventor
