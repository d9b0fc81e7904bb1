// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/scene/import/readers/polygon_cutter.h"
#include "daemon/scene/import/record/import_format.h"

namespace camway::scene::mesh_readers {

/// For a corner whose vertex does not exist.
inline constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();

/// Takes what a reader finds and makes the record of it: cuts polygons, counts what is no surface.
class MeshCollector {
 public:
  /// For a count that the bytes have been seen to hold.
  void reserve_vertices(std::size_t count) { record_.vertices.reserve(count); }
  std::uint32_t add_vertex(const Point& vertex);
  [[nodiscard]] std::size_t vertex_count() const { return record_.vertices.size(); }

  /// The vertex of that number, counted from 0; `kNoVertex` if there is none so far.
  [[nodiscard]] std::uint32_t vertex(std::int64_t number) const;

  /// Triangles from here on belong to an object of this name, of which the first 256 bytes count.
  /// Objects without a triangle leave no trace.
  void begin_object(std::string_view name);

  /// One of 3 corners or more becomes triangles, one of fewer counts as a point or line. A corner
  /// `kNoVertex` spoils its polygon, which then is one triangle that the receiver drops and counts;
  /// of one with a corner that is not finite, or so large that areas overflow, every triangle has
  /// that corner, and the receiver decides.
  void add_polygon(std::span<const std::uint32_t> corners);

  void add_points_and_lines(std::uint64_t count) {
    record_.header.dropped_points_and_lines += count;
  }
  /// Some coordinates were divided by a weight, which is rounded itself.
  void note_weight() { weighted_ = true; }
  void add_freeform_surface() { ++record_.header.dropped_freeform; }
  void add_ignored_statement() { ++record_.header.ignored_statements; }

  /// The record, with one object at least. `relative_rounding`: of reading one number.
  import_format::Record finish(std::string_view format, double relative_rounding);

 private:
  void end_object();
  void add_fan(std::span<const std::uint32_t> corners, std::size_t first);

  import_format::Record record_;
  std::string name_;
  bool weighted_ = false;
  std::size_t first_triangle_ = 0;  ///< of the object begun last
  PolygonCutter cutter_;
  std::vector<Point> corners_;
};

}  // namespace camway::scene::mesh_readers
