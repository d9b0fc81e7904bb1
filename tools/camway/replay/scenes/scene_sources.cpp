// SPDX-License-Identifier: MIT
#include "tools/camway/replay/scenes/scene_sources.h"

#include <fmt/format.h>

#include <filesystem>
#include <set>
#include <utility>

#include "daemon/process/settings/scene_argument.h"
#include "lcmtypes/wire/channels.h"
#include "tools/camway/common/commands.h"
#include "tools/camway/common/scene_flags.h"
#include "tools/camway/replay/scenes/root_scenes.h"
#include "tools/camway/replay/scenes/scene_playback.h"
#include "tools/camway/replay/scenes/session_scenes.h"

namespace camway::tools {
namespace {

namespace fs = std::filesystem;

/// Loads the scenes of `--scene`.
base::Result<Scenes> load_named(const std::vector<std::string>& arguments) {
  Scenes scenes;
  for (const std::string& argument : arguments) {
    const auto parsed = process::parse_scene_argument(argument);
    if (!parsed) return base::Failure{"--scene " + argument + ": " + parsed.error};
    // Planning does not use the occupancy map, so none is made.
    scene::SnapshotOptions options = parsed->options;
    options.occupancy_resolution_m.reset();
    LoadedScene loaded = load_timed(parsed->name, parsed->file.string(), options);
    if (!loaded.result.snapshot) return base::Failure{loaded.result.error};
    if (!scenes.emplace(parsed->name, std::move(loaded.result.snapshot)).second) {
      return base::Failure{"--scene " + argument + ": the name stands twice"};
    }
  }
  return scenes;
}

/// Returns the scenes with which the names begin in the answers, as far as they are found.
Scenes first_scenes(const Session& session, const ScenesByDigest::Found& found) {
  Scenes first;
  for (const auto& [name, digest] : session.first_digests) {
    const auto snapshot = found.find(digest);
    if (snapshot != found.end()) first.emplace(name, snapshot->second);
  }
  return first;
}

/// Returns the digests of the scenes that requests need, and of those that they are changed from.
std::set<std::string> sought_digests(const Session& session) {
  std::set<std::string> digests = digests_of(session);
  if (session.scene_requests == 0) return digests;
  for (const auto& [name, digest] : session.first_digests) digests.insert(digest);
  return digests;
}

base::Result<std::vector<fs::path>> folders_of(const std::vector<std::string>& roots) {
  std::vector<fs::path> folders;
  std::error_code error;
  for (const std::string& root : roots) {
    if (!fs::is_directory(root, error)) return base::Failure{"--root " + root + ": is no folder"};
    folders.emplace_back(root);
  }
  return folders;
}

}  // namespace

void add_scene_source_flags(CLI::App& command, SceneSourceFlags& flags) {
  command
      .add_option("--scene", flags.scenes,
                  "Scene file by the name that the requests use, as camwayd takes it; may stand "
                  "several times. Recordings of camwayd --record have their scenes")
      ->type_name(process::kSceneArgumentForm)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      .add_option(
          "--root", flags.roots,
          "Folder with scene files, which are found by the digests in the answers; may stand "
          "several times")
      ->type_name("DIR")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

base::Result<std::unique_ptr<ReplayScenes>> open_scene_sources(const SceneSourceFlags& flags,
                                                               const Session& session,
                                                               const SessionFiles& files,
                                                               const std::string& prefix,
                                                               const wire::MessageKeys* keys) {
  base::Result<std::vector<fs::path>> roots = folders_of(flags.roots);
  if (!roots) return base::Failure{roots.error};
  base::Result<Scenes> named = load_named(flags.scenes);
  if (!named) return base::Failure{named.error};
  auto chain = std::make_unique<SceneChain>();
  const std::vector<fs::path> blobs = blob_folders_of(files.logs());
  const bool is_plain = session.updates.empty();
  ScenesByDigest::Found found;
  if (!roots->empty()) found = find_by_digest(sought_digests(session), *roots);
  if (is_plain && session.scene_requests > 0) {
    Scenes first = *named;
    first.merge(first_scenes(session, found));
    PlayedBack played = play_back_changes(session, files.logs(), prefix, keys, first, *roots);
    for (const std::string& fault : played.faults) print_error(fault);
    found.merge(played.scenes);
    chain->add(std::make_unique<ScenesByDigest>(session, std::move(found), "is not in the log"));
    found.clear();
  }
  // Scenes that the user names go before recorded ones.
  chain->add(std::make_unique<NamedScenes>(*std::move(named)));
  chain->add(std::make_unique<SessionScenes>(session, blobs));
  chain->add(std::make_unique<DigestScenes>(session, blobs));
  chain->add(std::make_unique<ScenesByDigest>(session, std::move(found),
                                              "is no file below the folders of --root"));
  return std::unique_ptr<ReplayScenes>(std::move(chain));
}

}  // namespace camway::tools
