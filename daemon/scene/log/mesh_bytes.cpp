// SPDX-License-Identifier: MIT
#include "daemon/scene/log/mesh_bytes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "daemon/base/parallel_chunks.h"
#include "daemon/scene/cache/mesh_check.h"

namespace camway::scene {
namespace {

using geometry::Vec3;
using TriangleCorners = std::array<std::uint32_t, 3>;

static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(TriangleCorners) == 12,
              "both have no gaps");
constexpr std::size_t kLeastObjectBytes = 12;  ///< two counts, and a name of no bytes

/// Texts reach logs and JSON; those of an import are printable ASCII.
std::string get_printable(ByteReader& reader) {
  std::string text = reader.get_text(std::numeric_limits<std::uint32_t>::max());
  const auto is_printable = [](char c) { return c >= 0x20 && c <= 0x7e; };
  if (!std::ranges::all_of(text, is_printable)) reader.fail();
  return text;
}

/// Reads objects of these triangles. Fails if they do not cover all.
std::vector<MeshObject> get_mesh_objects(ByteReader& reader, std::size_t triangles) {
  std::vector<MeshObject> objects;
  std::uint64_t first = 0;
  for (std::size_t left = reader.get_count(kLeastObjectBytes); left > 0; --left) {
    std::string name = get_printable(reader);
    const auto count = reader.get<std::uint32_t>();
    if (count > triangles - first) reader.fail();
    if (reader.has_failed()) return {};
    objects.push_back({std::move(name), static_cast<std::uint32_t>(first), count});
    first += count;
  }
  if (first != triangles) reader.fail();
  return objects;
}

/// Calls `visit` for each number of a report, in the order of the record.
template <class Report, class Visit>
void visit_report_numbers(Report& report, const Visit& visit) {
  visit(report.scale);
  visit(report.vertices);
  visit(report.triangles);
  visit(report.objects);
  for (Eigen::Index k = 0; k < 3; ++k) visit(report.bounds_m.min()[k]);
  for (Eigen::Index k = 0; k < 3; ++k) visit(report.bounds_m.max()[k]);
  visit(report.degenerate_triangles);
  visit(report.dropped_nonfinite);
  visit(report.dropped_bad_index);
  visit(report.dropped_points_and_lines);
  visit(report.dropped_freeform);
  visit(report.ignored_statements);
  visit(report.rounding_m);
}

bool is_sound_report(const ImportReport& report) {
  // False for NaN. The corners of an empty box are finite, too.
  return report.scale > 0.0 && report.rounding_m >= 0.0 && report.up <= UpAxis::kYToZ &&
         report.bounds_m.min().allFinite() && report.bounds_m.max().allFinite();
}

}  // namespace

void put_mesh(ByteWriter& writer, const Mesh& mesh) {
  writer.put_count(mesh.vertices.size());
  for (const Vec3& vertex : mesh.vertices)
    writer.put_array(std::span<const double>(vertex.data(), 3));
  writer.put_count(mesh.triangles.size());
  for (const TriangleCorners& corners : mesh.triangles) {
    writer.put_array(std::span<const std::uint32_t>(corners));
  }
  writer.put_count(mesh.objects.size());
  for (const MeshObject& object : mesh.objects) {
    writer.put_text(object.name);
    writer.put(object.triangle_count);
  }
}

base::Result<Mesh> get_mesh(ByteReader& reader, bool may_lack_area) {
  Mesh mesh;
  mesh.vertices.resize(reader.get_count(sizeof(Vec3)));
  for (Vec3& vertex : mesh.vertices) reader.get_array(std::span<double>(vertex.data(), 3));
  mesh.triangles.resize(reader.get_count(sizeof(TriangleCorners)));
  for (TriangleCorners& corners : mesh.triangles)
    reader.get_array(std::span<std::uint32_t>(corners));
  mesh.objects = get_mesh_objects(reader, mesh.triangles.size());
  if (reader.has_failed()) return base::Failure{"counts, texts or objects of the mesh are wrong"};
  const unsigned threads = base::chunk_threads(0);
  std::string fault =
      may_lack_area ? fault_in_numbers(mesh, threads) : checked_bounds(mesh, threads).error;
  if (!fault.empty()) return base::Failure{"the mesh is wrong: " + fault};
  return mesh;
}

bool has_surface_error(const ImportReport& report) { return report.surface_error_m != 0.0; }

void put_report(ByteWriter& writer, const ImportReport& report) {
  writer.put_text(report.format);
  writer.put(static_cast<std::uint8_t>(report.up));
  writer.put_flag(report.single_precision);
  visit_report_numbers(report, [&](const auto& number) { writer.put(number); });
  if (has_surface_error(report)) writer.put(report.surface_error_m);
}

std::optional<ImportReport> get_report(ByteReader& reader, bool with_surface_error) {
  ImportReport report;
  report.format = get_printable(reader);
  report.up = static_cast<UpAxis>(reader.get<std::uint8_t>());
  report.single_precision = reader.get_flag();
  visit_report_numbers(
      report, [&](auto& number) { number = reader.get<std::decay_t<decltype(number)>>(); });
  if (with_surface_error) report.surface_error_m = reader.get<double>();
  // A source has one record: an error of 0 is left out.
  const bool is_sound_error = std::isfinite(report.surface_error_m) &&
                              report.surface_error_m >= 0.0 &&
                              has_surface_error(report) == with_surface_error;
  if (!is_sound_report(report) || !is_sound_error) reader.fail();
  if (reader.has_failed()) return std::nullopt;
  return report;
}

}  // namespace camway::scene
