// SPDX-License-Identifier: MIT
#include "tools/cameras/formats/camera_file.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "daemon/scene/import/readers/tokens.h"
#include "tools/json/json_document.h"

namespace camway::tools {
namespace {

namespace fs = std::filesystem;

base::Result<std::string> read_beside(const fs::path& folder, const std::string& name) {
  std::error_code error;
  const fs::path file = fs::weakly_canonical(folder / name, error);
  const fs::path root = fs::weakly_canonical(folder, error);
  if (error || std::ranges::mismatch(root, file).in1 != root.end()) {
    return base::Failure{"is not in the folder of the file or below it"};
  }
  base::Result<std::string> text = read_text(file.string());
  if (!text) return base::Failure{"cannot be read"};
  return text;
}

}  // namespace

base::Result<CameraFile> camera_file(const std::string& name) {
  base::Result<std::string> bytes = read_text(name);
  if (!bytes) return base::Failure{std::move(bytes.error)};
  // No binary format begins so.
  if (scene::mesh_readers::without_bom(*bytes).size() < bytes->size()) {
    *bytes = std::string(scene::mesh_readers::without_bom(*bytes));
  }
  fs::path folder = fs::path(name).parent_path();
  if (folder.empty()) folder = ".";
  return CameraFile{name, *std::move(bytes),
                    [folder](const std::string& other) { return read_beside(folder, other); }};
}

}  // namespace camway::tools
