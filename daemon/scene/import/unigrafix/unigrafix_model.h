// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/scene/import/readers/polygon_cutter.h"
#include "daemon/scene/import/unigrafix/placement_map.h"

namespace camway::scene::unigrafix {

class Definition;

/// An instance of a definition, or an array of them.
struct Use {
  std::string name;
  const Definition* definition = nullptr;
  PlacementMap place;  ///< of the first one
  PlacementMap step;   ///< from one to the next
  std::uint64_t count = 1;
};

/// The content of a definition, or of the whole scene: vertices, faces, and instances of definitions
/// that were complete before it, so that no definition contains itself.
class Definition {
 public:
  explicit Definition(const Definition* outer) : outer_(outer) {}

  /// Index of the vertex of this name; a name that has no vertex yet gets one that is missing.
  std::uint32_t vertex(std::string_view name, const std::string& place);
  /// Returns false if the vertex is defined already.
  bool define_vertex(std::string_view name, const Point& point);
  /// Adds a face: the corners of its outline, then those of each hole, up to each of `ends`.
  void add_face(const std::vector<std::uint32_t>& corners, const std::vector<std::size_t>& ends);
  void add_lines(std::uint64_t count) { lines_ += count; }
  void add_use(Use use);

  /// Returns null if the name is taken.
  Definition* begin_definition(std::string_view name);
  /// A complete definition of this one or of those around it; null if there is none.
  [[nodiscard]] const Definition* find(std::string_view name) const;
  /// Completes it. Returns why it cannot be: a vertex that is used is missing.
  [[nodiscard]] std::string complete();

  [[nodiscard]] const Definition* outer() const { return outer_; }
  [[nodiscard]] const std::vector<Point>& vertices() const { return vertices_; }
  [[nodiscard]] const std::vector<Use>& uses() const { return uses_; }
  [[nodiscard]] std::uint64_t lines() const { return lines_; }
  /// How deep instances are nested in it.
  [[nodiscard]] std::size_t depth() const { return depth_; }
  /// Whether there is any face or line in it or in its instances.
  [[nodiscard]] bool has_content() const { return has_content_; }
  /// Vertices and faces in it and in its instances; at most the largest number.
  [[nodiscard]] std::uint64_t size() const { return size_; }

  /// Calls `take(corners, ends)`, spans as in `add_face`, for each face.
  template <class Take>
  void for_each_face(const Take& take) const {
    std::size_t corner = 0;
    std::size_t end = 0;
    for (const Face& face : faces_) {
      take(std::span(corners_).subspan(corner, face.corners),
           std::span(ends_).subspan(end, face.contours));
      corner += face.corners;
      end += face.contours;
    }
  }

 private:
  struct Face {
    std::uint32_t corners = 0;
    std::uint32_t contours = 0;
  };
  using Names = std::map<std::string, std::uint32_t, std::less<>>;

  const Definition* const outer_;
  Names names_;  ///< of vertices; empty once it is complete
  std::vector<Point> vertices_;
  std::map<std::uint32_t, std::string> missing_;  ///< vertices, and where they are used first
  std::vector<Face> faces_;
  std::vector<std::uint32_t> corners_;
  std::vector<std::size_t> ends_;
  std::vector<Use> uses_;
  std::uint64_t lines_ = 0;
  std::size_t depth_ = 0;
  std::uint64_t size_ = 0;
  bool has_content_ = false;
  bool is_complete_ = false;
  std::map<std::string, std::unique_ptr<Definition>, std::less<>> definitions_;
};

}  // namespace camway::scene::unigrafix
