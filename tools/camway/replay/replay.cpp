// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <thread>

#include "daemon/cli_support/flag_checks.h"
#include "daemon/process/settings/scene_argument.h"
#include "lcmtypes/wire/auth/message_keys.h"
#include "lcmtypes/wire/channels.h"
#include "tools/camway/common/commands.h"
#include "tools/camway/common/scene_flags.h"
#include "tools/camway/replay/publish.h"
#include "tools/camway/replay/replay_run.h"
#include "tools/camway/replay/session_scenes.h"
#include "tools/camway/session/session_files.h"
#include "tools/json/json_response.h"
#include "tools/support/output_file.h"

namespace camway::tools {
namespace {

struct ReplayFlags {
  std::string log;
  std::vector<std::string> scenes;
  ReplayOptions run;
  std::string responses_dir;
  bool no_timing = false;
  bool publish = false;
  PublishOptions publishing;
  std::string key_file;
};

ExitCode invalid_input(std::string_view message) {
  print_error(message);
  return ExitCode::kInvalidInput;
}

/// Loads the scenes of `--scene`. On an error, prints it and returns nothing.
std::optional<Scenes> load_scenes(const std::vector<std::string>& arguments) {
  Scenes scenes;
  for (const std::string& argument : arguments) {
    const auto parsed = process::parse_scene_argument(argument);
    if (!parsed) {
      print_error("--scene " + argument + ": " + parsed.error);
      return std::nullopt;
    }
    // Planning does not use the occupancy map, so none is made.
    scene::SnapshotOptions options = parsed->options;
    options.occupancy_resolution_m.reset();
    LoadedScene loaded = load_timed(parsed->name, parsed->file.string(), options);
    if (!loaded.result.snapshot) {
      print_error(loaded.result.error);
      return std::nullopt;
    }
    if (!scenes.emplace(parsed->name, std::move(loaded.result.snapshot)).second) {
      print_error("--scene " + argument + ": the name stands twice");
      return std::nullopt;
    }
  }
  return scenes;
}

/// Writes the response to each request as a file. Returns an error text, empty on success. Client
/// ids consist of letters, digits, '-' and '_', so they are valid file names.
std::string write_responses(const ReplayFlags& flags, const Session& session,
                            const std::vector<ReplayedRequest>& replayed) {
  for (std::size_t i = 0; i < replayed.size(); ++i) {
    const RecordedRequest& recorded = session.requests[i];
    ResponseFormat format;
    format.has_timing = !flags.no_timing;
    format.scene = recorded.scene;
    format.scene_digest = replayed[i].scene_digest;
    const base::Result<std::string> text = write_plan_response(replayed[i].result, format);
    if (!text) return "the response cannot be written: " + text.error;
    const std::string name =
        fmt::format("{:04}_{}_{}.json", i, recorded.ids.client_id, recorded.ids.request_id);
    const auto file = std::filesystem::path(flags.responses_dir) / name;
    if (std::string fault = write_file(file, *text); !fault.empty()) return fault;
  }
  return {};
}

/// Returns the exit code of a complete replay. It is a success only if the log is undamaged and
/// agrees.
ExitCode verdict_code(const Session& session, const std::vector<ReplayedRequest>& replayed) {
  if (count(replayed, Verdict::kDiffers) > 0) return ExitCode::kNegative;
  if (!session.log.damage.empty() || count(replayed, Verdict::kAgrees) == 0) {
    return ExitCode::kInvalidInput;
  }
  return ExitCode::kSuccess;
}

/// Makes the folder for responses. Returns an error text if no file can be written there.
std::string make_responses_dir(const std::string& folder) {
  if (folder.empty()) return {};
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return folder + ": cannot be made: " + error.message();
  return why_unwritable(std::filesystem::path(folder) / "response.json");
}

ExitCode replay_offline(const ReplayFlags& flags, const wire::MessageKeys* keys) {
  const std::string& prefix = flags.publishing.prefix;
  const base::Result<SessionFiles> files = SessionFiles::open(flags.log);
  if (!files) return invalid_input(files.error);
  const Session session = read_session(files->logs(), prefix, keys);
  if (!session.log.damage.empty()) print_error(session.log.damage);
  if (session.requests.empty() && session.other_version > 0) {
    return invalid_input(fmt::format(
        "{}: its {} messages on {}_* are of another version of the wire types: replay it with the "
        "camway of the version that recorded it",
        flags.log, session.other_version, prefix));
  }
  if (session.requests.empty() && session.distrusted > 0) {
    return invalid_input(fmt::format("{}: its {} messages on {}_* are not signed with a key of {}",
                                     flags.log, session.distrusted, prefix, flags.key_file));
  }
  if (session.requests.empty()) {
    return invalid_input(fmt::format("{}: holds no planning requests on {}", flags.log,
                                     wire::Channels{prefix}.plan_request()));
  }
  if (const std::string fault = make_responses_dir(flags.responses_dir); !fault.empty()) {
    return invalid_input(fault);
  }
  std::optional<Scenes> named = load_scenes(flags.scenes);
  if (!named) return ExitCode::kInvalidInput;
  // What the user names goes before what was recorded.
  SceneChain scenes;
  scenes.add(std::make_unique<NamedScenes>(*std::move(named)));
  const auto blobs = blob_folders_of(files->logs());
  scenes.add(std::make_unique<SessionScenes>(session, blobs));
  scenes.add(std::make_unique<DigestScenes>(session, blobs));
  const std::vector<std::string> missing = missing_scenes(session, scenes);
  for (const std::string& name : missing) {
    print_error(fmt::format("{}: asks for the scene '{}': add --scene {}=FILE", flags.log,
                            wire::printable(name), wire::printable(name)));
  }
  if (!missing.empty()) return ExitCode::kInvalidInput;
  const std::vector<ReplayedRequest> replayed = replay(session, scenes, flags.run);
  fmt::print("{}", report(session, replayed, flags.no_timing ? Times::kHidden : Times::kShown));
  ExitCode outcome = verdict_code(session, replayed);
  if (!flags.responses_dir.empty()) {
    const std::string error = write_responses(flags, session, replayed);
    if (!error.empty()) outcome = worse(outcome, invalid_input(error));
  }
  return outcome;
}

ExitCode run_replay(const ReplayFlags& flags) {
  if (!wire::is_prefix(flags.publishing.prefix)) {
    return invalid_input("--prefix " + flags.publishing.prefix +
                         ": must be 1 to 11 letters, digits, '-' or '_'");
  }
  wire::MessageKeys::ReadResult read;
  if (!flags.key_file.empty()) read = wire::MessageKeys::from_file(flags.key_file);
  if (!read.error.empty()) return invalid_input("--key-file " + read.error);
  return flags.publish ? publish_log(flags.log, flags.publishing, read.keys)
                       : replay_offline(flags, read.keys.get());
}

void add_offline_flags(CLI::App& command, ReplayFlags& flags) {
  command
      .add_option("--scene", flags.scenes,
                  "A scene by the name that the requests use; may stand several times; as "
                  "camwayd's")
      ->type_name(process::kSceneArgumentForm)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      .add_option("--threads", flags.run.threads,
                  "Requests planned at the same time; the output does not depend on it")
      ->check(cli_support::whole_number(1, 256))
      ->capture_default_str();
  command
      .add_option("--tolerance-m", flags.run.tolerance_m,
                  "Count paths that stay this many metres from each other as equal; 0: only the "
                  "same bits")
      ->check(cli_support::at_least_0())
      ->capture_default_str();
  command.add_option("--responses", flags.responses_dir, "Folder for the response to each request")
      ->type_name("DIR");
  command.add_flag("--no-timing", flags.no_timing,
                   "Leave times out of table and responses, so that two runs compare byte by byte");
}

void add_publish_flags(CLI::App& command, ReplayFlags& flags) {
  CLI::Option* publish =
      command.add_flag("--publish", flags.publish,
                       "Send the recorded requests to a running daemon instead, as recorded");
  command
      .add_option("--speed", flags.publishing.speed,
                  "With --publish: times the recorded speed; 0 for as fast as possible")
      ->check(cli_support::at_least_0())
      ->needs(publish)
      ->capture_default_str();
  command
      .add_option("--wait-s", flags.publishing.wait_s,
                  "With --publish: seconds to wait for answers after the last request")
      ->check(cli_support::between(0.0, 1e6))
      ->needs(publish)
      ->capture_default_str();
  command
      .add_option("--url", flags.publishing.url, "With --publish: LCM network [LCM_DEFAULT_URL]")
      ->needs(publish);
}

}  // namespace

void add_replay_command(CLI::App& app, ExitCode& exit_code) {
  const auto flags = std::make_shared<ReplayFlags>();
  CLI::App* command = app.add_subcommand(
      "replay", "Plan the requests of a recorded session again and compare with the answers");
  command->add_option("LOG", flags->log, "What was recorded: a log of lcm-logger, or a folder of camwayd --record")->required();
  command->add_option("--prefix", flags->publishing.prefix, "Of the daemon's channels")
      ->capture_default_str();
  command
      ->add_option("--key-file", flags->key_file,
                   "Use only messages that were signed with a key of this file; with --publish: "
                   "and sign them anew")
      ->type_name("FILE");
  add_offline_flags(*command, *flags);
  add_publish_flags(*command, *flags);
  command->footer(
      exit_code_help("an answer differs (with --publish: a request was not answered)") +
      "\nA damaged log is replayed up to the damage and ends with 2, unless an answer differs."
      "\nExample: camway replay session.lcmlog --scene office=scenes/office.obj --threads 4");
  command->callback([flags, &exit_code] { exit_code = run_replay(*flags); });
}

}  // namespace camway::tools
