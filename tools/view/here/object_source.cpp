// SPDX-License-Identifier: MIT
#include "tools/view/here/object_source.h"

#include <fcntl.h>
#include <sys/types.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "daemon/base/file_descriptor.h"
#include "daemon/scene/import/import.h"
#include "daemon/scene/snapshot/shape_mesh.h"

namespace camway::view {
namespace {

using Source = base::Result<std::shared_ptr<const scene::ObjectSource>>;

/// As a daemon has it.
constexpr double kUsualChordShare = 0.01;

double chord_error_m(double asked_m, double radius_m) {
  return asked_m > 0.0 ? asked_m : kUsualChordShare * radius_m;
}

Source of_shape(base::Result<scene::Mesh> mesh, scene::ObjectKind kind,
                const scene::ObjectOptions& options) {
  if (!mesh) return base::Failure{"form: " + mesh.error};
  scene::ImportReport report = scene::report_of(*mesh, scene::to_string(kind));
  return scene::make_source(kind, *std::move(mesh), std::move(report), options);
}

/// A file with the bytes of a mesh, since the import process opens files by name. The destructor
/// removes it.
class MeshFile {
 public:
  MeshFile(std::string_view bytes, const std::string& format) {
    std::error_code failed;
    const std::filesystem::path folder = std::filesystem::temp_directory_path(failed);
    if (failed) return;
    std::string name = (folder / ("camway_view_XXXXXX." + format)).string();
    const base::FileDescriptor file(
        mkostemps(name.data(), static_cast<int>(format.size()) + 1, O_CLOEXEC));
    if (!file.is_open()) return;
    path_ = name;
    while (!bytes.empty()) {
      const ssize_t written = write(file.get(), bytes.data(), bytes.size());
      if (written <= 0) return;
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    is_good_ = true;
  }
  ~MeshFile() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove(path_, ignored);
  }
  MeshFile(const MeshFile&) = delete;
  MeshFile& operator=(const MeshFile&) = delete;

  [[nodiscard]] bool is_good() const { return is_good_; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  bool is_good_ = false;
};

Source of_mesh(const MeshForm& form, const scene::ObjectOptions& options) {
  if (!form.file.empty()) {
    return base::Failure{
        "form.file: no files are read here; send text or base64, or have a daemon plan"};
  }
  const MeshFile file(form.bytes, form.format);
  if (!file.is_good()) return base::Failure{"form: there is no room for a temporary file"};
  scene::ImportOptions import;
  import.scale = form.scale;
  import.up = form.up;
  scene::ImportResult read = scene::import_mesh(file.path(), import);
  if (!read.mesh) {
    std::string error = std::move(read.error);
    // Clients know nothing of the file.
    const std::size_t at = error.find(file.path().string());
    if (at != std::string::npos) error.replace(at, file.path().string().size(), "form");
    return base::Failure{std::move(error)};
  }
  if (read.map) return scene::make_map_source(read.map, std::move(read.report), options);
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
