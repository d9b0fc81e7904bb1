// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/cli_support/flag_checks.h"
#include "daemon/planning/request/request.h"
#include "daemon/scene/import/import.h"
#include "daemon/scene/import/import_warnings.h"
#include "tools/camway/common/commands.h"
#include "tools/camway/common/scene_flags.h"
#include "tools/json/json_text.h"

namespace camway::tools {
namespace {

struct InfoFlags {
  SceneFlags scene;
  std::uint32_t octree_threshold = scene::IndexOptions{}.threshold;
  std::optional<double> occupancy_m;
  bool json = false;
};

using OrderedJson = nlohmann::ordered_json;

OrderedJson vector_json(const geometry::Vec3& v) { return {v.x(), v.y(), v.z()}; }

/// Returns the warnings that need no request; the tolerance is assumed to be the default.
std::vector<std::string> warnings_of(const scene::ImportReport& report) {
  return scene::import_warnings(report, planning::PlanOptions{}.interval_tolerance_m,
                                scene::kOfDefault);
}

/// Returns the notes of the reader, and what the extents suggest about axes.
std::vector<std::string> notes_of(const scene::ImportReport& report) {
  std::vector<std::string> notes = report.notes;
  if (report.bounds_m.isEmpty() || report.up != scene::UpAxis::kAsInFile) return notes;
  // Rooms, storeys and terrains are wider than they are high.
  constexpr double kFlat = 0.5;
  const geometry::Vec3 size_m = report.bounds_m.sizes();
  if (size_m.z() < kFlat * std::min(size_m.x(), size_m.y())) {
    notes.emplace_back("the smallest extent is z: perhaps Z is up (see --up)");
  }
  return notes;
}

OrderedJson import_json(const scene::ImportReport& report) {
  OrderedJson json;
  json["format"] = report.format;
  json["scale_m_per_unit"] = report.scale;
  json["up"] = to_string(report.up);
  json["vertices"] = report.vertices;
  json["triangles"] = report.triangles;
  json["objects"] = report.objects;
  if (!report.bounds_m.isEmpty()) {
    json["bounds_min_m"] = vector_json(report.bounds_m.min());
    json["bounds_max_m"] = vector_json(report.bounds_m.max());
    json["single_precision"] = report.single_precision;
    json["rounding_m"] = report.rounding_m;
    json["surface_error_m"] = report.surface_error_m;
  }
  json["degenerate_triangles"] = report.degenerate_triangles;
  json["dropped_nonfinite"] = report.dropped_nonfinite;
  json["dropped_bad_index"] = report.dropped_bad_index;
  if (report.unit_m != 0.0) json["unit_m"] = report.unit_m;
  json["notes"] = report.notes;
  json["dropped_points_and_lines"] = report.dropped_points_and_lines;
  json["dropped_freeform"] = report.dropped_freeform;
  json["ignored_statements"] = report.ignored_statements;
  json["warnings"] = warnings_of(report);
  return json;
}

OrderedJson octree_json(const scene::IndexStatistics& statistics, std::uint32_t threshold) {
  OrderedJson json;
  json["threshold"] = threshold;
  json["nodes"] = statistics.nodes;
  json["leaves"] = statistics.leaves;
  json["depth"] = statistics.depth;
  json["references"] = statistics.references;
  json["duplication"] = statistics.duplication;
  json["memory_bytes"] = statistics.memory_bytes;
  return json;
}

OrderedJson field_json(const scene::Snapshot& snapshot) {
  OrderedJson json;
  json["on"] = snapshot.field != nullptr;
  if (!snapshot.field) {
    json["why_off"] = snapshot.why_no_field;
    return json;
  }
  const scene::DistanceFieldStatistics& statistics = snapshot.field->statistics();
  json["resolution_m"] = statistics.resolution_m;
  json["cells"] = statistics.cells;
  json["memory_bytes"] = statistics.memory_bytes;
  json["settled_share"] = statistics.settled_share;
  json["settled_from_m"] = statistics.settled_from_m;
  return json;
}

OrderedJson occupancy_json(const scene::OccupancyStatistics& statistics) {
  OrderedJson json;
  json["resolution_m"] = statistics.resolution_m;
  json["occupied_voxels"] = statistics.occupied_voxels;
  json["nodes"] = statistics.nodes;
  json["memory_bytes"] = statistics.memory_bytes;
  return json;
}

void print_json(const scene::Snapshot& snapshot, const InfoFlags& flags, double load_ms) {
  OrderedJson json;
  json["scene"] = flags.scene.file;
  json["digest"] = snapshot.digest;
  json["import"] = import_json(snapshot.report);
  json["octree"] = octree_json(snapshot.index.statistics(), flags.octree_threshold);
  json["distance_field"] = field_json(snapshot);
  if (snapshot.occupancy) json["occupancy"] = occupancy_json(snapshot.occupancy->statistics());
  json["load_ms"] = load_ms;
  fmt::print("{}\n", json_text(json, 2));
}

double megabytes(std::uint64_t bytes) { return static_cast<double>(bytes) / (1 << 20); }

void print_rounding(const scene::ImportReport& report) {
  if (report.rounding_m == 0.0) {
    fmt::print("rounding     none: coordinates are those of the file\n");
    return;
  }
  fmt::print("rounding     coordinates are off by {:.2g} m at most: {}\n", report.rounding_m,
             report.single_precision ? "files of this format are read in single precision"
                                     : "decimals and scale round to the nearest double");
}

void print_import(const scene::ImportReport& report) {
  fmt::print("format       {}\n", report.format);
  fmt::print("triangles    {} in {} objects, {} vertices\n", report.triangles, report.objects,
             report.vertices);
  if (!report.bounds_m.isEmpty()) {
    const geometry::Vec3 low = report.bounds_m.min();
    const geometry::Vec3 high = report.bounds_m.max();
    const geometry::Vec3 size = high - low;
    fmt::print("bounds       [{:.3f}, {:.3f}, {:.3f}] to [{:.3f}, {:.3f}, {:.3f}] m\n", low.x(),
               low.y(), low.z(), high.x(), high.y(), high.z());
    fmt::print("size         {:.3f} x {:.3f} x {:.3f} m\n", size.x(), size.y(), size.z());
    print_rounding(report);
    if (report.surface_error_m > 0.0) {
      fmt::print(
          "surfaces     smooth surfaces are flat within {:.2g} m; paths keep that distance, too\n",
          report.surface_error_m);
    }
  }
  fmt::print("degenerate   {} triangles of zero area, kept out\n", report.degenerate_triangles);
  fmt::print(
      "dropped      {} not finite, {} with a bad index, {} points and lines, {} free-form, "
      "{} unknown\n",
      report.dropped_nonfinite, report.dropped_bad_index, report.dropped_points_and_lines,
      report.dropped_freeform, report.ignored_statements);
  fmt::print("{} {} m per unit, axes {} (see --scale and --up)\n",
             report.unit_m == 0.0 ? "assumed     " : "by the file ", report.scale,
             to_string(report.up));
  for (const std::string& note : notes_of(report)) fmt::print("note         {}\n", note);
}

void print_field(const scene::Snapshot& snapshot) {
  if (!snapshot.field) {
    fmt::print("field        off: {}\n", snapshot.why_no_field);
    return;
  }
  const scene::DistanceFieldStatistics& field = snapshot.field->statistics();
  fmt::print(
      "field        {} x {} x {} cells of {:.4g} m, {:.1f} MB; {:.0f} % of them are {:.4g} m "
      "or more away from the scene\n",
      field.cells[0], field.cells[1], field.cells[2], field.resolution_m,
      megabytes(field.memory_bytes), 100.0 * field.settled_share, field.settled_from_m);
}

void print_text(const scene::Snapshot& snapshot, const InfoFlags& flags, double load_ms) {
  fmt::print("scene        {}\n", flags.scene.file);
  print_import(snapshot.report);
  fmt::print("digest       {}\n", snapshot.digest);
  const scene::IndexStatistics& octree = snapshot.index.statistics();
  fmt::print(
      "octree       threshold {}: {} nodes, {} leaves, depth {}, duplication {:.2f}, {:.1f} MB\n",
      flags.octree_threshold, octree.nodes, octree.leaves, octree.depth, octree.duplication,
      megabytes(octree.memory_bytes));
  print_field(snapshot);
  if (snapshot.occupancy) {
    const scene::OccupancyStatistics occupancy = snapshot.occupancy->statistics();
    fmt::print("occupancy    {} occupied voxels of {} m, {} nodes, {:.1f} MB\n",
               occupancy.occupied_voxels, occupancy.resolution_m, occupancy.nodes,
               megabytes(occupancy.memory_bytes));
  }
  fmt::print("loaded in    {:.1f} ms\n", load_ms);
}

ExitCode run_info(const InfoFlags& flags) {
  if (flags.scene.file.empty()) {
    print_error("no scene file is given (see camway info --help)");
    return ExitCode::kInvalidInput;
  }
  scene::SnapshotOptions options;
  options.import = flags.scene.import_options();
  options.index.threshold = flags.octree_threshold;
  options.occupancy_resolution_m = flags.occupancy_m;
  const LoadedScene loaded =
      load_timed(flags.scene.file, flags.scene.file, options, user_cache(flags.scene));
  if (!loaded.result.snapshot) {
    print_error(loaded.result.error);
    return ExitCode::kInvalidInput;
  }
  for (const std::string& warning : warnings_of(loaded.result.snapshot->report)) {
    print_error("warning: " + warning);
  }
  if (flags.json) {
    print_json(*loaded.result.snapshot, flags, loaded.load_ms);
  } else {
    print_text(*loaded.result.snapshot, flags, loaded.load_ms);
  }
  return ExitCode::kSuccess;
}

}  // namespace

void add_info_command(CLI::App& app, ExitCode& exit_code) {
  const auto flags = std::make_shared<InfoFlags>();
  CLI::App* command = app.add_subcommand(
      "info", "Say what a scene file holds, what was assumed of it, and how its octree came out");
  CLI::Option* const scene = add_scene_flags(*command, flags->scene);
  command->add_option("file", flags->scene.file, "The same as --scene")->excludes(scene);
  command
      ->add_option("--octree-threshold", flags->octree_threshold,
                   "A leaf of the octree with more triangles than this splits")
      ->check(cli_support::whole_number(1, 1'000'000'000))
      ->capture_default_str();
  command
      ->add_option("--occupancy", flags->occupancy_m,
                   "Build the OctoMap mirror with voxels of this many metres too")
      ->check(cli_support::above_0())
      ->type_name("METRES");
  command->add_flag("--json", flags->json, "Print JSON, for machines");
  command->footer(exit_code_help("") +
                  "\nExample: camway info scenes/office.obj --scale 0.0254 --up z-to-y");
  command->callback([flags, &exit_code] { exit_code = run_info(*flags); });
}

}  // namespace camway::tools
