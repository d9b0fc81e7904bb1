// SPDX-License-Identifier: MIT
#include "daemon/scene/import/common/included_files.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

#include "daemon/scene/import/readers/tokens.h"

namespace camway::scene {
namespace {

namespace fs = std::filesystem;

bool is_below(const fs::path& file, const fs::path& folder) {
  return std::ranges::mismatch(folder, file).in1 == folder.end();
}

base::Result<IncludedFile> open_below(const fs::path& folder, const std::string& from,
                                      const std::string& name) {
  const base::Result<fs::path> path = path_below(folder, fs::path(from).parent_path() / name);
  if (!path) return base::Failure{path.error};
  std::ifstream stream(*path, std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(stream), {});
  if (!stream) return base::Failure{"cannot be read"};
  text = mesh_readers::without_bom(text);
  return IncludedFile{path->lexically_relative(folder).string(), std::move(text)};
}

}  // namespace

base::Result<fs::path> path_below(const fs::path& folder, const fs::path& name) {
  std::error_code error;
  fs::path real = fs::canonical(folder / name, error);
  if (error == std::errc::no_such_file_or_directory) return base::Failure{"is not there"};
  // This process may not look at files outside, so it cannot tell whether they are there.
  if (error || !is_below(real, folder)) {
    return base::Failure{"is not in the folder of the scene or below it"};
  }
  if (!fs::is_regular_file(real, error)) return base::Failure{"is not a regular file"};
  return real;
}

OpenInclude files_below(const fs::path& scene) {
  std::error_code error;
  const fs::path folder = fs::canonical(scene, error).parent_path();
  return [folder](const std::string& from, const std::string& name) {
    return open_below(folder, from, name);
  };
}

}  // namespace camway::scene
