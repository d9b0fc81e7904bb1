// SPDX-License-Identifier: MIT
#include "tools/view/here/object_source.h"

#include <cstdint>
#include <string>
#include <utility>

#include "daemon/scene/import/import.h"
#include "daemon/scene/import/upload_file.h"
#include "daemon/scene/snapshot/shape_mesh.h"

namespace camway::view {
namespace {

using Source = base::Result<std::shared_ptr<const scene::ObjectSource>>;

double chord_error_m(double asked_m, double radius_m) {
  return asked_m > 0.0 ? asked_m : scene::kUsualChordShare * radius_m;
}

Source of_shape(base::Result<scene::Mesh> mesh, scene::ObjectKind kind,
                const scene::ObjectOptions& options) {
  if (!mesh) return base::Failure{"form: " + mesh.error};
  scene::ImportReport report = scene::report_of(*mesh, scene::to_string(kind));
  return scene::make_source(kind, *std::move(mesh), std::move(report), options);
}

Source of_mesh(const MeshForm& form, const scene::ObjectOptions& options) {
  if (!form.file.empty()) {
    return base::Failure{
        "form.file: no files are read here; send text or base64, or have a daemon plan"};
  }
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(form.bytes.data());
  const scene::UploadFile file({bytes, form.bytes.size()}, form.format);
  if (!file.is_good()) return base::Failure{"form: there is no room for a temporary file"};
  scene::ImportOptions import;
  import.scale = form.scale;
  import.up = form.up;
  import.voxel_m = form.voxel_m;
  scene::ImportResult read = scene::import_mesh(file.path(), import);
  if (!read.mesh) {
    std::string error = std::move(read.error);
    // Clients know nothing of the file.
    const std::size_t at = error.find(file.path().string());
    if (at != std::string::npos) error.replace(at, file.path().string().size(), "form");
    return base::Failure{std::move(error)};
  }
  if (read.map) {
    return scene::make_map_source(read.map, std::move(read.report), options, read.map_origin_m);
  }
  return scene::make_source(scene::ObjectKind::kMesh, *std::move(read.mesh), std::move(read.report),
                            options);
}

}  // namespace

Source make_object_source(const Form& form, const scene::ObjectOptions& options) {
  using scene::ObjectKind;
  if (const auto* const box = std::get_if<BoxForm>(&form)) {
    return of_shape(scene::box_mesh(box->size_m), ObjectKind::kBox, options);
  }
  if (const auto* const ball = std::get_if<SphereForm>(&form)) {
    const double chord_m = chord_error_m(ball->chord_error_m, ball->radius_m);
    return of_shape(scene::sphere_mesh(ball->radius_m, chord_m), ObjectKind::kSphere, options);
  }
  if (const auto* const cylinder = std::get_if<CylinderForm>(&form)) {
    const double chord_m = chord_error_m(cylinder->chord_error_m, cylinder->radius_m);
    return of_shape(scene::cylinder_mesh(cylinder->radius_m, cylinder->height_m, chord_m),
                    ObjectKind::kCylinder, options);
  }
  return of_mesh(std::get<MeshForm>(form), options);
}

}  // namespace camway::view
