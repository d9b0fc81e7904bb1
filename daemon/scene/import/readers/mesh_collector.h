// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/scene/import/readers/polygon_cutter.h"
#include "daemon/scene/import/record/record_layout.h"

namespace camway::scene::mesh_readers {

/// Index of a corner whose vertex does not exist.
inline constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();

/// Builds the record of a mesh from the parts that a reader finds: cuts polygons into triangles and
/// counts what is no surface.
class MeshCollector {
 public:
  /// Requires a count that fits the bytes of the file.
  void reserve_vertices(std::size_t count) { record_.vertices.reserve(count); }
  std::uint32_t add_vertex(const Point& vertex);
  [[nodiscard]] std::size_t vertex_count() const { return record_.vertices.size(); }
  [[nodiscard]] std::size_t triangle_count() const { return record_.triangles.size(); }

  /// Index of vertex `number`, counted from 0; `kNoVertex` if it does not exist yet.
  [[nodiscard]] std::uint32_t vertex(std::int64_t number) const;

  /// Begins an object, which owns the triangles that follow. Only the first 256 bytes of its name
  /// count. Objects without triangles are dropped.
  void begin_object(std::string_view name);

  /// Adds a polygon as triangles; one or two corners count as a point or line. With a corner
  /// `kNoVertex` it becomes one triangle that the receiver drops and counts. With a corner that is
  /// not finite, or too large for areas, all triangles contain that corner; the receiver decides.
  void add_polygon(std::span<const std::uint32_t> corners);

  /// The same for a polygon with holes: the corners of the outline, then those of each hole, up to
  /// each of `ends`. Holes that cannot be cut out are filled, and counted.
  void add_polygon(std::span<const std::uint32_t> corners, std::span<const std::size_t> ends);
  [[nodiscard]] std::uint64_t filled_holes() const { return filled_holes_; }

  void add_points_and_lines(std::uint64_t count) {
    record_.header.dropped_points_and_lines += count;
  }
  /// Records that coordinates were divided by a weight, which is rounded itself.
  void note_weight() { weighted_ = true; }
  void add_freeform_surface() { ++record_.header.dropped_freeform; }
  void add_ignored_statement() { ++record_.header.ignored_statements; }

  /// Returns the record, with at least one object. `relative_rounding`: of reading one number.
  import_record::Record finish(std::string_view format, double relative_rounding);

 private:
  void end_object();
  [[nodiscard]] bool take_corners(std::span<const std::uint32_t> corners);
  void add_fan(std::span<const std::uint32_t> corners, std::size_t first);

  import_record::Record record_;
  std::string name_;
  bool weighted_ = false;
  std::uint64_t filled_holes_ = 0;
  std::size_t first_triangle_ = 0;  ///< first triangle of the current object
  PolygonCutter cutter_;
  std::vector<Point> corners_;
};

}  // namespace camway::scene::mesh_readers
