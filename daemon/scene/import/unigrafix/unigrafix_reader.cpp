// SPDX-License-Identifier: MIT
#include "daemon/scene/import/unigrafix/unigrafix_reader.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "daemon/geometry/rounding.h"
#include "daemon/scene/import/readers/mesh_collector.h"
#include "daemon/scene/import/readers/tokens.h"

namespace camway::scene::unigrafix {
namespace {

using import_record::Record;
using mesh_readers::MeshCollector;

/// Adds a scene to a mesh, with the instances in it.
class Expansion {
 public:
  explicit Expansion(MeshCollector& mesh) : mesh_(mesh) {}

  void add(const Definition& definition, const PlacementMap& place, const std::string& name) {
    add_faces(definition, place, name);
    mesh_.add_points_and_lines(definition.lines());
    for (const Use& use : definition.uses()) {
      const std::string inner = name.empty() ? use.name : name + "/" + use.name;
      PlacementMap each = use.place;
      for (std::uint64_t i = 0; i < use.count; ++i) {
        add(*use.definition, each.then(place), inner);
        each = each.then(use.step);
        ++instances_;
      }
    }
  }
  [[nodiscard]] double rounding() const { return rounding_; }
  [[nodiscard]] std::uint64_t instances() const { return instances_; }

 private:
  void add_faces(const Definition& definition, const PlacementMap& place, const std::string& name) {
    if (definition.vertices().empty()) return;
    const auto first = static_cast<std::uint32_t>(mesh_.vertex_count());
    Point largest{};
    for (const Point& vertex : definition.vertices()) {
      mesh_.add_vertex(place.apply(vertex));
      for (std::size_t k = 0; k < 3; ++k) largest[k] = std::max(largest[k], std::abs(vertex[k]));
    }
    rounding_ = std::max(rounding_, place.rounding(largest));
    const bool mirrors = place.mirrors();
    mesh_.begin_object(name);
    definition.for_each_face(
        [&](std::span<const std::uint32_t> corners, std::span<const std::size_t> ends) {
          corners_.assign(corners.begin(), corners.end());
          for (std::uint32_t& corner : corners_) corner += first;
          if (mirrors) std::ranges::reverse(std::span(corners_).first(ends[0]));
          mesh_.add_polygon(corners_, ends);
        });
  }

  MeshCollector& mesh_;
  std::vector<std::uint32_t> corners_;
  double rounding_ = 0.0;
  std::uint64_t instances_ = 0;
};

void add_note(Record& record, std::uint64_t count, const std::string& text,
              std::string_view mark = "") {
  if (count == 0) return;
  record.notes += std::string(mark) + std::to_string(count) + " " + text + "\n";
}

}  // namespace

bool is_unigrafix_extension(std::string_view extension) {
  return mesh_readers::equals_ignoring_case(extension, ".ug");
}

base::Result<Record> read_unigrafix(std::string_view text, const OpenInclude& open_include,
                                    std::uint64_t most) {
  Definition scene(nullptr);
  UnigrafixParser parser(scene, open_include);
  std::string fault = parser.parse(text);
  if (!fault.empty()) return base::Failure{std::move(fault)};
  if (scene.size() > most) {
    return base::Failure{"its instances have more than " + std::to_string(most) +
                         " vertices and faces"};
  }
  MeshCollector mesh;
  Expansion expansion(mesh);
  expansion.add(scene, PlacementMap(), "");
  const std::uint64_t filled = mesh.filled_holes();
  // A decimal becomes the nearest double.
  Record record = mesh.finish("UniGrafix", geometry::kUnitRoundoff);
  record.header.absolute_rounding = expansion.rounding();
  const ParseCounts& counts = parser.counts();
  record.notes = "UniGrafix states no unit and no axes: see --scale and --up\n";
  add_note(record, counts.includes, "files were included");
  add_note(record, expansion.instances(), "instances of definitions were made");
  add_note(record, filled, "holes of faces could not be cut out, and are filled",
           import_record::kWarningMark);
  add_note(record, counts.lights_and_cameras, "lights and cameras were not read");
  add_note(record, counts.matrices_without_offset,
           "matrices could be meant by rows or columns; points were taken as rows");
  return record;
}

}  // namespace camway::scene::unigrafix
