// SPDX-License-Identifier: MIT
#include "tools/camway/replay/scenes/root_scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <system_error>
#include <utility>

#include "lcmtypes/wire/channels.h"
#include "tools/camway/common/scene_flags.h"

namespace camway::tools {
namespace {

namespace fs = std::filesystem;

/// The endings of files that are tried as scenes.
constexpr std::array<std::string_view, 25> kEndings{
    ".obj", ".off", ".ply", ".stl", ".3ds", ".dae", ".glb",  ".gltf", ".fbx",
    ".x3d", ".lwo", ".ug",  ".bpt", ".iv",  ".wrl", ".step", ".stp",  ".iges",
    ".igs", ".bt",  ".ot",  ".pcd", ".xyz", ".las", ".ase"};

bool is_scene_file(const fs::path& file) {
  std::string ending = file.extension();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::ranges::find(kEndings, ending) != kEndings.end();
}

std::vector<fs::path> scene_files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  fs::recursive_directory_iterator entry(folder, fs::directory_options::skip_permission_denied,
                                         error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_regular_file(ignored) && is_scene_file(entry->path())) {
      files.push_back(entry->path());
    }
  }
  std::ranges::sort(files);
  return files;
}

}  // namespace

std::map<std::string, std::shared_ptr<const scene::Snapshot>> find_by_digest(
    const std::set<std::string>& digests, const std::vector<fs::path>& folders) {
  std::map<std::string, std::shared_ptr<const scene::Snapshot>> found;
  const std::optional<scene::SceneCache> cache = user_cache({});
  for (const fs::path& folder : folders) {
    for (const fs::path& file : scene_files_in(folder)) {
      if (found.size() == digests.size()) return found;
      const scene::SnapshotResult loaded =
          load_timed(file.stem().string(), file.string(), {}, cache).result;
      if (!loaded.snapshot || !digests.contains(loaded.snapshot->digest)) continue;
      found.emplace(loaded.snapshot->digest, loaded.snapshot);
    }
  }
  return found;
}

std::set<std::string> digests_of(const Session& session) {
  std::set<std::string> digests;
  for (const RecordedRequest& request : session.requests) {
    if (request.answer && !request.answer->scene_digest.empty()) {
      digests.insert(request.answer->scene_digest);
    }
  }
  return digests;
}

ScenesByDigest::ScenesByDigest(const Session& session, Found found, std::string why_not)
    : found_(std::move(found)), why_not_(std::move(why_not)) {
  for (const RecordedRequest& request : session.requests) {
    if (request.answer && found_.contains(request.answer->scene_digest)) {
      names_.insert(request.scene);
    }
  }
}

FoundScene ScenesByDigest::snapshot_of(const RecordedRequest& request) {
  if (scene_was_unknown(request)) return {};
  if (!request.answer) return {nullptr, "no answer in the log"};
  const auto found = found_.find(request.answer->scene_digest);
  if (found != found_.end()) return {found->second, {}};
  return {nullptr, fmt::format("scene revision {} of '{}' {}", request.answer->scene_revision,
                               wire::printable(request.scene), why_not_)};
}

}  // namespace camway::tools
