// SPDX-License-Identifier: MIT
#include "daemon/scene/import/inventor/inventor_reader.h"

#include <Inventor/nodes/SoSeparator.h>

#include <map>
#include <string>
#include <utility>

#include "daemon/scene/import/common/transform_chain.h"
#include "daemon/scene/import/inventor/inflate.h"
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

/// Says what a scene without triangles has.
std::string lacking(const SceneGraph& graph, const ShapeCounts& shapes) {
  Counts found = shapes.no_surface;
  found.insert(shapes.unknown.begin(), shapes.unknown.end());
  std::string list = listed(found);
  const auto add = [&](std::uint64_t count, const std::string& text) {
    if (count == 0) return;
    if (!list.empty()) list += ", ";
    list += std::to_string(count) + " " + text;
  };
  add(shapes.shapes, "shapes without a face");
  add(shapes.texts, "of them texts");
  for (const auto& [reason, count] : shapes.no_freeform) add(count, "NURBS that " + reason);
  add(shapes.not_chosen, "children that a switch does not choose");
  add(shapes.invisible, "shapes of draw style INVISIBLE");
  add(graph.not_fetched.size(), "inline files that are not below its folder");
  if (!graph.ignored.empty()) {
    if (!list.empty()) list += ", ";
    list += listed(graph.ignored);
  }
  if (list.empty())
    return "holds no surface: no shape in " + std::to_string(graph.nodes) + " nodes";
  return "holds no surface: it has " + list;
}

void add_note(Record& record, const std::string& text) { record.notes += text + "\n"; }

void add_note(Record& record, std::uint64_t count, const std::string& text,
              std::string_view mark = "") {
  if (count > 0) add_note(record, std::string(mark) + std::to_string(count) + " " + text);
}

void add_notes(Record& record, const SceneGraph& graph, const ShapeCounts& shapes) {
  constexpr std::string_view kMark = import_record::kWarningMark;
  add_note(record, graph.is_vrml ? "VRML is in metres and Y is up, by its specification"
                                 : "Open Inventor is in metres unless a Units node says otherwise, "
                                   "and states no axes");
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
  add_note(record, shapes.smooth, "spheres, cones, cylinders and NURBS were made flat");
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
  const bool is_compressed = is_gzip(bytes);
  if (is_compressed) {
    base::Result<std::string> text = inflated(bytes);
    if (!text) return base::Failure{std::move(text.error)};
    plain = *std::move(text);
    bytes = plain;
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
  record.header.unit_m = graph->is_vrml ? 1.0 : 0.0;
  add_notes(record, *graph, shapes);
  return record;
}

}  // namespace camway::scene::inventor
