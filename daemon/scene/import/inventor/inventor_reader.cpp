// SPDX-License-Identifier: MIT
#include "daemon/scene/import/inventor/inventor_reader.h"

#include <Inventor/nodes/SoSeparator.h>

#include <map>
#include <string>
#include <utility>

#include "daemon/gzip/inflate.h"
#include "daemon/scene/import/common/transform_chain.h"
#include "daemon/scene/import/inventor/shape_reader.h"
#include "daemon/scene/import/readers/mesh_collector.h"

namespace camway::scene::inventor {
namespace {

using import_record::Record;
using Counts = std::map<std::string, std::uint64_t>;

/// A radius or an angle is read, and half of it or its sine rounded once more.
constexpr double kRelativeRounding =
    import_process::kReadingRoundoffs * import_process::kFloatRoundoff;

/// "2 LineSet, 1 Text2". Types of VRML 97 lose the prefix that Coin gives them.
std::string listed(const Counts& counts) {
  std::string list;
  for (const auto& [type, count] : counts) {
    if (!list.empty()) list += ", ";
    list += std::to_string(count) + " " + (type.starts_with("VRML") ? type.substr(4) : type);
  }
  return list;
}

/// A list of what there is so many times.
class Inventory {
 public:
  void add(std::uint64_t count, std::string_view one, std::string_view many) {
    if (count == 0) return;
    add(std::to_string(count) + " " + std::string(count == 1 ? one : many));
  }
  void add(const std::string& item) {
    if (item.empty()) return;
    if (!text_.empty()) text_ += ", ";
    text_ += item;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// Says what a scene without triangles has.
std::string lacking(const SceneGraph& graph, const ShapeCounts& shapes) {
  Inventory has;
  has.add(listed(shapes.no_surface));
  has.add(listed(shapes.unknown));
  has.add(shapes.shapes, "shape without a face", "shapes without a face");
  for (const auto& [reason, count] : shapes.no_freeform) {
    has.add(count, "NURBS surface that " + reason, "NURBS surfaces each of which " + reason);
  }
  has.add(shapes.not_chosen, "child that a switch does not choose",
          "children that switches do not choose");
  has.add(shapes.invisible, "shape of draw style INVISIBLE", "shapes of draw style INVISIBLE");
  has.add(graph.not_fetched.size(), "inline file elsewhere", "inline files elsewhere");
  has.add(listed(graph.ignored));
  if (has.text().empty()) {
    return "holds no surface: none of its " + std::to_string(graph.nodes) + " nodes is a shape";
  }
  return "holds no surface: it has " + has.text();
}

void add_note(Record& record, const std::string& text) { record.notes += text + "\n"; }

void add_note(Record& record, std::uint64_t count, const std::string& text,
              std::string_view mark = "") {
  if (count > 0) add_note(record, std::string(mark) + std::to_string(count) + " " + text);
}

void add_notes(Record& record, const SceneGraph& graph, const ShapeCounts& shapes) {
  constexpr std::string_view kMark = import_record::kWarningMark;
  add_note(record, graph.is_vrml     ? "VRML is in metres and Y is up, by its specification"
                   : graph.has_units ? "a Units node of the file is applied; it states no axes"
                                     : "Open Inventor is in metres unless a Units node says "
                                       "otherwise, and states no axes");
  add_note(record, graph.inline_files, "inline files were read");
  for (const std::string& url : graph.not_fetched) {
    add_note(record, std::string(kMark) +
                         "an inline file is not below the scene's folder, and was "
                         "not read: " +
                         url);
  }
  add_note(record, shapes.not_chosen, "children of switches are not chosen, and were not read");
  add_note(record, graph.coarse_levels,
           "coarser levels of detail were left out: the finest counts");
  add_note(record, shapes.invisible, "shapes of draw style INVISIBLE were not read");
  add_note(record, shapes.smooth,
           "smooth shapes (spheres, cones, cylinders, NURBS) were made flat");
  add_note(record, shapes.texts, "texts are in the font that Coin has, whatever their own one");
  add_note(record, shapes.trimmed, "NURBS are trimmed by curves, and were read whole", kMark);
  for (const auto& [reason, count] : shapes.no_freeform) {
    add_note(record, count, "NURBS could not be read: each " + reason);
  }
  if (!shapes.no_surface.empty()) {
    add_note(record, "points, lines and pictures have no surface: " + listed(shapes.no_surface));
  }
  if (!shapes.unknown.empty()) {
    add_note(record, std::string(kMark) +
                         "shapes of unknown types were not read: " + listed(shapes.unknown));
  }
  if (!graph.ignored.empty()) {
    add_note(record, "what is no geometry was not read: " + listed(graph.ignored));
  }
  for (const std::string& warning : graph.warnings) add_note(record, "Coin says: " + warning);
}

}  // namespace

base::Result<Record> read_inventor(std::string_view bytes, const SceneFolder& folder) {
  std::string plain;
  const bool is_compressed = gzip::is_gzip(bytes);
  if (is_compressed) {
    base::Result<std::string> text = gzip::inflated(bytes);
    if (!text) return base::Failure{std::move(text.error)};
    plain = *std::move(text);
    bytes = plain;
  }
  // Coin reads bytes in memory without a header, too, and takes noise for an empty scene.
  if (!bytes.starts_with("#Inventor V") && !bytes.starts_with("#VRML V")) {
    return base::Failure{"does not begin with '#Inventor V' or '#VRML V'"};
  }
  const base::Result<SceneGraph> graph = read_scene_graph(bytes, folder);
  if (!graph) return base::Failure{graph.error};
  mesh_readers::MeshCollector mesh;
  const ShapeCounts shapes = add_shapes(*graph->root, mesh);
  if (shapes.is_too_large) {
    return base::Failure{"its shapes have more than " + std::to_string(kMostVerticesAndTriangles) +
                         " vertices and triangles"};
  }
  if (mesh.triangle_count() == 0) return base::Failure{lacking(*graph, shapes)};
  Record record = mesh.finish(graph->format + (is_compressed ? ", gzip" : ""), kRelativeRounding);
  record.header.single_precision = 1;
  record.header.absolute_rounding = shapes.rounding;
  record.header.surface_error = shapes.surface_error;
  record.header.unit_m = graph->is_vrml || graph->has_units ? 1.0 : 0.0;
  add_notes(record, *graph, shapes);
  return record;
}

}  // namespace camway::scene::inventor
