// SPDX-License-Identifier: MIT
#include "tools/camway/common/request_file.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "daemon/scene/import/import.h"
#include "daemon/scene/import/import_warnings.h"
#include "tools/json/json_document.h"

namespace camway::tools {
namespace {

/// Returns the mesh of a file as a body, or the reason why there is none.
base::Result<motion::MeshShape> read_mesh(const std::filesystem::path& file, const BodyFile& body) {
  scene::ImportOptions options;
  options.scale = body.scale;
  scene::ImportResult read = scene::import_mesh(file, options);
  const std::string scaled =
      body.scale == 1.0 ? "" : fmt::format(" (with a scale of {})", body.scale);
  if (!read.mesh) return base::Failure{read.error + scaled};
  // A body without a part of it would be proved free where that part collides. A closed surface has
  // lost none with faces of zero area.
  if (body.solid) read.report.degenerate_triangles = 0;
  if (const std::string list = scene::faces_left_out(read.report); !list.empty()) {
    return base::Failure{file.string() + ": the body would be without faces of its file: " + list};
  }
  motion::MeshShape mesh{std::move(read.mesh->vertices), std::move(read.mesh->triangles),
                         body.solid};
  if (const std::optional<motion::ShapeFault> fault = motion::fault_in(mesh)) {
    return base::Failure{file.string() + ": " + fault->field + (fault->field.empty() ? "" : ": ") +
                         fault->reason + scaled};
  }
  return mesh;
}

}  // namespace

base::Result<RequestFile> read_request(const std::string& file) {
  const base::Result<std::string> text = read_text(file);
  if (!text) return base::Failure{text.error};
  return read_request_text(*text, file);
}

base::Result<RequestFile> read_request_text(const std::string& text, const std::string& file) {
  base::Result<RequestFile> request = parse_as<RequestFile>(text, source_of(file));
  if (!request || !request->body_file) return request;
  const std::filesystem::path folder =
      file == "-" ? std::filesystem::path() : std::filesystem::path(file).parent_path();
  base::Result<motion::MeshShape> mesh =
      read_mesh(folder / request->body_file->file, *request->body_file);
  if (!mesh) return base::Failure{source_of(file) + ": body.file: " + mesh.error};
  request->body = *std::move(mesh.value);
  return request;
}

}  // namespace camway::tools
