// SPDX-License-Identifier: MIT
#include "daemon/service/scene_roots.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "lcmtypes/channels.h"

namespace camway::service {
namespace {

namespace fs = std::filesystem;

/// Component by component, so that /scenes2 is not below /scenes. Both are canonical.
bool is_below(const fs::path& file, const fs::path& folder) {
  const auto [in_folder, in_file] =
      std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return in_folder == folder.end() && in_file != file.end();
}

}  // namespace

SceneRoots SceneRoots::make(const std::vector<fs::path>& folders, std::string& error) {
  SceneRoots roots;
  for (const fs::path& folder : folders) {
    std::error_code failed;
    fs::path canonical = fs::canonical(folder, failed);
    if (failed || !fs::is_directory(canonical, failed)) {
      error = "scene root '" + folder.string() + "' is not a folder that can be read";
      return {};
    }
    roots.folders_.push_back(std::move(canonical));
  }
  return roots;
}

RootedFile SceneRoots::resolve(std::string_view asked) const {
  const std::string shown = wire::printable(std::string(asked));
  const auto refuse = [&](const std::string& reason) {
    return RootedFile{{}, "file: '" + shown + "' " + reason};
  };
  if (folders_.empty()) return refuse("cannot be read: the daemon has no scene roots");
  const fs::path wanted(asked);
  if (asked.empty() || asked.find('\0') != std::string_view::npos) return refuse("names no file");
  if (std::find(wanted.begin(), wanted.end(), "..") != wanted.end()) {
    return refuse("must not contain '..'");
  }
  bool leads_out = false;
  for (const fs::path& folder : folders_) {
    std::error_code failed;
    fs::path file = fs::canonical(folder / wanted, failed);
    if (failed) continue;
    if (!is_below(file, folder)) {
      leads_out = true;
      continue;
    }
    if (fs::is_regular_file(file, failed)) return {std::move(file), {}};
  }
  return refuse(leads_out ? "leads out of the scene roots" : "is no file below a scene root");
}

}  // namespace camway::service
