// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <utility>

#include "daemon/planning/stages/sentences.h"
#include "lcmtypes/wire/channels.h"
#include "tools/camway/replay/replay_flags.h"

namespace camway::tools {
namespace {

/// Returns why a session has no requests.
std::string why_empty(const Session& session, const std::string& log, const ReplayFlags& flags) {
  const std::string& prefix = flags.publishing.prefix;
  if (session.other_version > 0) {
    return fmt::format(
        "{}: its {} on {}_* are of another version of the wire types: replay it with the camway of "
        "the version that recorded it",
        log, planning::counted(session.other_version, "message"), prefix);
  }
  if (session.distrusted > 0) {
    return fmt::format("{}: its {} on {}_* are not signed with a key of {}", log,
                       planning::counted(session.distrusted, "message"), prefix, flags.key_file);
  }
  return fmt::format("{}: holds no planning requests on {}", log,
                     wire::Channels{prefix}.plan_request());
}

/// Returns what to add where a scene is not found.
std::string remedy_for(const std::string& scene, const Session& session, const ReplayFlags& flags) {
  const std::string name = wire::printable(scene);
  const auto digest = session.first_digests.find(scene);
  if (flags.sources.roots.empty() || digest == session.first_digests.end()) {
    return fmt::format("add --scene {}=FILE, or --root DIR", name);
  }
  return fmt::format(
      "no file below {} has its digest {} when read without options; add --scene {}=FILE with the "
      "options of the daemon's scene (scale, up, unknown)",
      fmt::join(flags.sources.roots, ", "), wire::printable(digest->second), name);
}

}  // namespace

ExitCode invalid_replay(std::string_view message) {
  print_error(message);
  return ExitCode::kInvalidInput;
}

std::optional<OpenedSession> open_session(const std::string& log, const ReplayFlags& flags,
                                          const wire::MessageKeys* keys) {
  base::Result<SessionFiles> files = SessionFiles::open(log);
  if (!files) {
    print_error(files.error);
    return std::nullopt;
  }
  Session session = read_session(files->logs(), flags.publishing.prefix, keys);
  session.left_out = files->left_out();
  if (!session.log.damage.empty()) print_error(session.log.damage);
  if (session.requests.empty()) {
    // The damage is all there is to say of a file without a good event.
    if (session.log.events > 0 || session.log.damage.empty()) {
      print_error(why_empty(session, log, flags));
    }
    return std::nullopt;
  }
  if (is_backwards(flags.selection, session.begin_utime)) {
    print_error(fmt::format("{}: --from is after --to, so no request is selected", log));
    return std::nullopt;
  }
  const std::size_t read = session.requests.size();
  session.unwanted = select(flags.selection, session);
  if (session.requests.empty()) {
    print_error(
        fmt::format("{}: none of its {} is selected", log, planning::counted(read, "request")));
    return std::nullopt;
  }
  return OpenedSession{*std::move(files.value), std::move(session)};
}

std::vector<std::string> notes_about(const Session& session, const std::string& whose) {
  std::vector<std::string> notes = notes_of(session, whose);
  if (session.unwanted > 0) {
    notes.push_back(fmt::format("{}{} {} not selected", whose,
                                planning::counted(session.unwanted, "request"),
                                session.unwanted == 1 ? "is" : "are"));
  }
  return notes;
}

std::unique_ptr<ReplayScenes> open_scenes(const OpenedSession& opened, const ReplayFlags& flags,
                                          const wire::MessageKeys* keys) {
  auto scenes = open_scene_sources(flags.sources, opened.session, opened.files,
                                   flags.publishing.prefix, keys);
  if (scenes) return *std::move(scenes);
  print_error(scenes.error);
  return nullptr;
}

std::unique_ptr<ReplayScenes> open_needed_scenes(const OpenedSession& opened,
                                                 const ReplayFlags& flags,
                                                 const wire::MessageKeys* keys) {
  std::unique_ptr<ReplayScenes> scenes = open_scenes(opened, flags, keys);
  if (!scenes) return nullptr;
  // A pack says what it lacks; the requests that need no more are compared.
  if (!opened.session.left_out.empty()) return scenes;
  const std::vector<std::string> missing = missing_scenes(opened.session, *scenes);
  for (const std::string& name : missing) {
    print_error(fmt::format("{}: asks for the scene '{}': {}", flags.log, wire::printable(name),
                            remedy_for(name, opened.session, flags)));
  }
  return missing.empty() ? std::move(scenes) : nullptr;
}

SceneOf scene_of(ReplayScenes& scenes) {
  return [&scenes](const RecordedRequest& request) { return scenes.snapshot_of(request).snapshot; };
}

}  // namespace camway::tools
