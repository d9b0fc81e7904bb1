// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lcmtypes/wire/auth/message_keys.h"
#include "tools/camway/common/commands.h"
#include "tools/camway/replay/compare/report.h"
#include "tools/camway/replay/outcome.h"
#include "tools/camway/replay/publish.h"
#include "tools/camway/replay/replay_run.h"
#include "tools/camway/replay/scenes/scene_sources.h"
#include "tools/camway/replay/selection.h"
#include "tools/camway/session/session_files.h"

namespace camway::tools {

/// The command line of `camway replay`.
struct ReplayFlags {
  std::string log;
  std::string baseline;        ///< log of earlier answers, compared with `against`
  std::string against;         ///< log of later answers
  std::string baseline_build;  ///< program whose answers are compared
  SceneSourceFlags sources;
  ReplayOptions run;
  Failing failing = kFailing;
  Selection selection;
  ReportFiles reports;
  std::string responses_dir;
  bool no_timing = false;
  bool step = false;
  bool publish = false;
  PublishOptions publishing;
  std::string key_file;

  /// The files that are read, but for those of scenes.
  [[nodiscard]] std::vector<std::string> inputs() const {
    return {log, baseline, against, key_file};
  }
  [[nodiscard]] Times times() const { return no_timing ? Times::kHidden : Times::kShown; }
};

/// Prints the error and returns `kInvalidInput`.
ExitCode invalid_replay(std::string_view message);

/// A session with its files, which may be unpacked ones.
struct OpenedSession {
  SessionFiles files;
  Session session;
};

/// Reads the wanted requests of a log, a folder of recordings, or a packed session. Prints damage,
/// and why there are no requests, if so; then returns nothing. `keys` may be null.
std::optional<OpenedSession> open_session(const std::string& log, const ReplayFlags& flags,
                                          const wire::MessageKeys* keys);

/// Returns the notes of a report about a session, that on unwanted requests included.
std::vector<std::string> notes_about(const Session& session, const std::string& whose = {});

/// Opens the scenes that the flags name, which go before recorded ones, and those of the
/// session. On an error, prints it and returns null. `opened` must outlive the result; `keys` may
/// be null.
std::unique_ptr<ReplayScenes> open_scenes(const OpenedSession& opened, const ReplayFlags& flags,
                                          const wire::MessageKeys* keys);

/// Opens the scenes as `open_scenes` does. Fails as well if the session needs one more, but for
/// packs that say what they lack.
std::unique_ptr<ReplayScenes> open_needed_scenes(const OpenedSession& opened,
                                                 const ReplayFlags& flags,
                                                 const wire::MessageKeys* keys);

/// Returns the scenes as pictures take them. `scenes` must outlive the result.
SceneOf scene_of(ReplayScenes& scenes);

/// The commands: plan the recorded requests again and compare; do so one by one; compare two logs;
/// compare with another build. `keys` may be null.
ExitCode replay_offline(const ReplayFlags& flags, const wire::MessageKeys* keys);
ExitCode replay_by_steps(const ReplayFlags& flags, const wire::MessageKeys* keys);
ExitCode compare_logs(const ReplayFlags& flags, const wire::MessageKeys* keys);
ExitCode compare_builds(const ReplayFlags& flags, const wire::MessageKeys* keys);

}  // namespace camway::tools
