// SPDX-License-Identifier: MIT
#include "daemon/scene/import/cad/cad_reader.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <TopoDS_Shape.hxx>

#include "daemon/geometry/rounding.h"
#include "daemon/scene/import/cad/cad_file.h"
#include "daemon/scene/import/cad/cad_library.h"
#include "daemon/scene/import/cad/part_mesher.h"
#include "daemon/scene/import/readers/mesh_collector.h"

namespace camway::scene::cad {
namespace {

using import_record::Record;
using surfaces::Point;

/// A decimal is read, converted to millimetres and back; and there is a product of a placement of
/// 3 terms, from a chain of products that the library computes in doubles.
constexpr double kRoundoffs = 32.0;

/// Adds parts to a mesh.
class Assembly {
 public:
  explicit Assembly(double units_per_mm) : units_per_mm_(units_per_mm) {}

  void add(const CadPart& part) {
    const gp_Trsf place = part.shape.Location().Transformation();
    const PartMesh& mesh = mesh_of(part.shape);
    const bool turns = place.IsNegative() != (part.shape.Orientation() == TopAbs_REVERSED);
    const auto first = static_cast<std::uint32_t>(mesh_.vertex_count());
    for (const Point& point : mesh.facets.points) add_vertex(point, place);
    mesh_.begin_object(part.name);
    for (std::array<std::uint32_t, 3> corners : mesh.facets.triangles) {
      if (turns) std::swap(corners[1], corners[2]);
      for (std::uint32_t& corner : corners) corner += first;
      mesh_.add_polygon(corners);
    }
    const double scale = std::abs(place.ScaleFactor()) * units_per_mm_;
    error_ = std::max(error_, mesh.facets.error * scale);
    faces_ += mesh.faces;
    for (const auto& [reason, count] : mesh.left_out) {
      left_out_[reason] += count;
      for (std::uint64_t i = 0; i < count; ++i) mesh_.add_freeform_surface();
    }
  }

  [[nodiscard]] std::size_t triangles() const { return mesh_.triangle_count(); }
  [[nodiscard]] const std::map<std::string, std::uint64_t>& left_out() const { return left_out_; }
  [[nodiscard]] std::uint64_t faces() const { return faces_; }

  Record finish(const std::string& format) {
    Record record = mesh_.finish(format, kRoundoffs * geometry::kUnitRoundoff);
    record.header.absolute_rounding =
        kRoundoffs * geometry::kUnitRoundoff * largest_ * units_per_mm_;
    record.header.surface_error = error_;
    return record;
  }

 private:
  /// The mesh of a part without its placement.
  const PartMesh& mesh_of(const TopoDS_Shape& part) {
    std::optional<PartMesh>& mesh = meshes_[part.TShape().get()];
    if (!mesh) mesh = mesh_of_part(part.Located(TopLoc_Location()).Oriented(TopAbs_FORWARD));
    return *mesh;
  }

  void add_vertex(const Point& point, const gp_Trsf& place) {
    gp_XYZ at(point[0], point[1], point[2]);
    place.Transforms(at);
    mesh_.add_vertex({at.X() * units_per_mm_, at.Y() * units_per_mm_, at.Z() * units_per_mm_});
    // The terms of the placement, which may cancel.
    for (std::size_t k = 0; k < 3; ++k) {
      const double moved = std::abs(place.TranslationPart().Coord(static_cast<int>(k) + 1));
      largest_ = std::max(largest_, std::abs(point[k] * place.ScaleFactor()) + moved);
    }
  }

  const double units_per_mm_;
  mesh_readers::MeshCollector mesh_;
  std::map<const TopoDS_TShape*, std::optional<PartMesh>> meshes_;
  std::map<std::string, std::uint64_t> left_out_;
  std::uint64_t faces_ = 0;
  double error_ = 0.0;
  double largest_ = 0.0;  ///< term of a coordinate, in millimetres
};

void add_note(Record& record, std::uint64_t count, const std::string& text,
              std::string_view mark = "") {
  if (count > 0) record.notes += std::string(mark) + std::to_string(count) + " " + text + "\n";
}

void add_notes(Record& record, const CadFile& file, const Assembly& assembly) {
  constexpr std::string_view kMark = import_record::kWarningMark;
  record.notes +=
      "the file's own unit is applied (" + file.unit + "); it states no axes: see --up\n";
  add_note(record, assembly.faces(), "faces were made flat");
  for (const auto& [reason, count] : assembly.left_out()) {
    add_note(record, count, "faces could not be read: each " + reason);
  }
  add_note(record, file.roots_lost, "shapes of the file could not be read", kMark);
  add_note(record, file.entities_with_errors,
           "entities of the file have errors, so that faces may be missing", kMark);
}

std::string nothing_left(const Assembly& assembly) {
  std::string text = "holds no face that could be read";
  for (const auto& [reason, count] : assembly.left_out()) {
    text += (text.find(':') == std::string::npos ? ": " : ", ") + std::to_string(count) + " that " +
            reason;
  }
  return text;
}

base::Result<Record> read_parts(const std::string& name, bool is_iges) {
  const base::Result<CadFile> file = read_cad_file(name, is_iges);
  if (!file) return base::Failure{file.error};
  // Exactly 1 for a file in millimetres.
  Assembly assembly(kMillimetre_m / file->unit_m);
  for (const CadPart& part : file->parts) {
    assembly.add(part);
    if (assembly.triangles() > kMostTriangles) {
      return base::Failure{"its parts have more than " + std::to_string(kMostTriangles) +
                           " triangles"};
    }
  }
  if (assembly.triangles() == 0) return base::Failure{nothing_left(assembly)};
  Record record = assembly.finish(file->format);
  record.header.unit_m = file->unit_m;
  add_notes(record, *file, assembly);
  return record;
}

}  // namespace

base::Result<Record> read_cad(const std::string& file, bool is_iges) {
  std::optional<base::Result<Record>> result;
  with_cad_errors([&] { result = read_parts(file, is_iges); });
  return *std::move(result);
}

}  // namespace camway::scene::cad
