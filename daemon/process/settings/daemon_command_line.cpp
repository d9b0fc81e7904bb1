// SPDX-License-Identifier: MIT
#include "daemon/process/settings/daemon_command_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <sstream>
#include <thread>
#include <utility>

#include <CLI/CLI.hpp>

#include "daemon/cli_support/flag_checks.h"
#include "daemon/cli_support/help_tree.h"
#include "daemon/process/settings/config_file.h"
#include "daemon/process/settings/daemon_faults.h"
#include "daemon/process/settings/daemon_settings.h"
#include "daemon/process/settings/try_scenes.h"
#include "daemon/service/transport/lcm_url.h"
#include "daemon/version/build_info.h"

namespace camway::process {
namespace {

constexpr char kFooter[] =
    "Exit codes: 0 stopped by SIGTERM or SIGINT once it serves (while it still reads scenes, the "
    "signal ends it at once), 1 LCM, the port for metrics, the folder of the state or the servers "
    "of the fleet cannot be used, LCM failed, or another daemon serves with this prefix or records "
    "into this folder, 2 wrong command line, configuration or scene file, the folder of recordings "
    "cannot be made or written, or standard output cannot be written.\n"
    "SIGHUP reads the configuration again and takes over scenes and log level; what else changed "
    "is logged and needs a restart.\n"
    "Example: camwayd --scene office=scenes/office.obj,occupancy=0.1 --scene maze=scenes/maze.obj";

int workers_for_this_machine() {
  return static_cast<int>(
      std::clamp(std::thread::hardware_concurrency(), 1U, unsigned{service::kMaxWorkers}));
}

/// Values that CLI11 sets; texts that are parsed later.
struct Raw {
  std::string config_file;
  bool check_config = false;
  std::vector<std::string> scenes;
};

/// Returns the setting of that key. Requires that there is one.
Setting setting_of(std::string_view key, DaemonOptions& options) {
  const std::vector<Setting> settings = settings_of(options);
  return *std::ranges::find(settings, key, &Setting::key);
}

/// Adds a flag without a value that turns a setting on.
void declare_switch(CLI::App& app, const std::string& flag, std::string_view key,
                    const std::string& meaning, DaemonOptions& options) {
  const auto turn_on = [&options, key, flag] {
    setting_of(key, options).turn(true);
    options.set_at[std::string(key)] = flag;
  };
  app.add_flag_callback(flag, turn_on, meaning);
}

/// Returns the form of a setting's value as the help shows it.
std::string form_of(const Setting& setting) {
  if (setting.path == Setting::Path::kFile) return "PATH";
  if (setting.path == Setting::Path::kFolders) return "FOLDER";
  if (!setting.is_text()) return "NUMBER";
  const std::vector<std::string_view> choices = setting.choices();
  return choices.empty() ? "WORD" : fmt::format("WORD:{}", fmt::join(choices, "|"));
}

/// Adds a flag for a setting. `usual` is its default as the help shows it.
void declare_setting(CLI::App& app, const std::string& flag, std::string_view key,
                     const std::string& meaning, DaemonOptions& options,
                     const std::optional<std::string>& usual = std::nullopt) {
  const auto setting = [&options, key] { return setting_of(key, options); };
  const auto apply = [setting, flag, key, &options](const std::string& word) {
    const std::string fault = setting().set_word(word);
    if (!fault.empty()) throw CLI::ValidationError(flag, fault);
    options.set_at[std::string(key)] = flag;
  };
  app.add_option_function<std::string>(flag, apply,
                                       meaning + " [" + usual.value_or(setting().text()) + "]")
      ->type_name(form_of(setting()));
}

/// Adds the flags for files: the configuration, and scenes, which are no settings.
void declare_files(CLI::App& app, Raw& raw) {
  app.add_option("--config", raw.config_file,
                 "Configuration file (TOML); what is given on the command line goes before it")
      ->type_name("FILE");
  app.add_flag("--check-config", raw.check_config,
               "Say what command line and configuration file come to, having read the scenes, and "
               "end: with code 2 if anything is wrong");
  app.add_option("--scene", raw.scenes,
                 "A scene to hold; may be given several times, beside those of the configuration "
                 "file or in the place of one of the same name. scale: file units to metres; up: "
                 "turns axes; occupancy: edge of a voxel of the occupancy map in metres, no map "
                 "without it; bounds: what no body may leave, metres, a number left out is no "
                 "limit")
      ->type_name(kSceneArgumentForm)
      ->take_all();
}

void declare_folders(CLI::App& app, DaemonOptions& options) {
  declare_setting(app, "--scene-roots", "scenes.roots",
                  "Folders, with ':' between them, below which clients may have scene files read; "
                  "without them they can upload only; relative to the folder that this is started "
                  "in",
                  options, "none");
  declare_setting(
      app, "--state", "state.folder",
      "Folder in which scenes are kept, so that the next daemon with it has them again; "
      "without it they end with the daemon; relative to the folder that this is started in",
      options, "none");
  declare_setting(app, "--record", "record.folder",
                  "Folder into which messages and changes of scenes are recorded, for `camway "
                  "replay`; relative to the folder that this is started in",
                  options, "none");
}

void declare_fleet(CLI::App& app, DaemonOptions& options) {
  declare_setting(
      app, "--role", "fleet.role",
      "What this process does: all of it alone; front: serve clients of a fleet and let "
      "its planners plan; planner: plan for the fronts of a fleet",
      options);
  declare_setting(app, "--fleet", "fleet.servers",
                  "Servers of NATS that join the fleet, nats://HOST:PORT or tls://HOST:PORT, with "
                  "',' between them",
                  options, "none");
  declare_setting(app, "--fleet-name", "fleet.name", "Processes of the same name are one fleet",
                  options);
  app.add_option("--fleet-drop", options.drop_scenes,
                 "A front removes this scene from the fleet before it reads the scenes there, for "
                 "one whose contents are lost; may be given several times")
      ->type_name("SCENE");
}

void declare_channels(CLI::App& app, DaemonOptions& options) {
  declare_setting(app, "--prefix", "lcm.prefix", "Channels begin with this", options);
  declare_switch(app, "--share-prefix", "lcm.share_prefix",
                 "Serve though another daemon serves with this prefix; else this one says so and "
                 "ends with code 1",
                 options);
  declare_setting(app, "--url", "lcm.url", "LCM provider; ttl=0 keeps the traffic on this host",
                  options,
                  "lcm.url of the configuration file, else LCM_DEFAULT_URL, else " +
                      std::string(kDefaultLcmUrl));
}

void declare_planning(CLI::App& app, DaemonOptions& options) {
  declare_setting(app, "--workers", "planning.workers",
                  "Requests planned at the same time; 0: one for each core", options);
  declare_setting(app, "--queue", "queue.requests", "Requests that may wait for a worker", options);
  declare_setting(app, "--client-queue", "queue.requests_of_a_client",
                  "Requests of one client that may wait for a worker", options);
  declare_setting(app, "--deadline-s", "planning.deadline_s",
                  "Deadline of requests that name none, seconds from their receipt", options);
  declare_setting(app, "--max-deadline-s", "planning.max_deadline_s",
                  "Longest deadline that a request may ask for, seconds", options);
}

void declare_log(CLI::App& app, DaemonOptions& options) {
  declare_setting(app, "--log-level", "log.level", "What is logged on standard error", options);
  declare_setting(app, "--log-format", "log.format",
                  "How: text for people, or an object of JSON on each line", options);
}

void declare(CLI::App& app, Raw& raw, DaemonOptions& options) {
  app.set_version_flag("--version", "camwayd " + service::version_text());
  app.footer(kFooter);
  declare_files(app, raw);
  declare_folders(app, options);
  declare_fleet(app, options);
  declare_channels(app, options);
  declare_planning(app, options);
  declare_log(app, options);
}

ParsedOptions failed(std::vector<std::string> faults) {
  return {std::nullopt, {}, std::move(faults)};
}

/// Returns `fault` after the place of its setting; an empty text if there is no fault.
std::string fault_at(std::string_view key, const std::string& fault, const DaemonOptions& options) {
  return fault.empty() ? fault : options.where(key) + ": " + fault;
}

/// Reads the command line into `options`. Returns the end of the process, if the command line is
/// invalid or asks for help.
std::optional<ParsedOptions> read_flags(int argc, const char* const* argv, Raw& raw,
                                        DaemonOptions& options) {
  CLI::App app("camwayd: plans camera paths that are free of collision, over LCM", "camwayd");
  declare(app, raw, options);
  if (cli_support::asks_for_help_tree(argc, argv)) {
    return ParsedOptions{std::nullopt, cli_support::help_tree(app), {}};
  }
  cli_support::refuse_missing_values(app);
  try {
    app.parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    std::ostringstream text;
    if (app.exit(error, text, text) == 0) return ParsedOptions{std::nullopt, text.str(), {}};
    return failed({cli_support::command_line_fault(app, error)});
  }
}

/// Adds the scenes of the command line; they replace those of the file with the same name. Returns
/// an error or an empty text.
std::string add_scenes(const std::vector<std::string>& texts, std::vector<SceneArgument>& scenes) {
  std::set<std::string> names;
  for (const std::string& text : texts) {
    base::Result<SceneArgument> parsed = parse_scene_argument(text);
    if (!parsed) return "--scene: " + parsed.error;
    const std::string& name = parsed->name;
    if (!names.insert(name).second) return "--scene: the name '" + name + "' is given twice";
    parsed->set_at = "--scene";
    std::erase_if(scenes, [&](const SceneArgument& scene) { return scene.name == name; });
    scenes.push_back(*std::move(parsed));
  }
  return {};
}

/// Opens the folders. Returns an error or an empty text.
std::string open_roots(const std::string& folders, service::SceneRoots& roots) {
  std::vector<std::filesystem::path> paths;
  std::istringstream text(folders);
  for (std::string folder; std::getline(text, folder, ':');) {
    if (!folder.empty()) paths.emplace_back(folder);
  }
  base::Result<service::SceneRoots> opened = service::SceneRoots::make(paths);
  if (opened) roots = *std::move(opened);
  return opened.error;
}

/// Completes the options. Returns their faults.
std::vector<std::string> resolve(const Raw& raw, DaemonOptions& options) {
  options.config_file = raw.config_file;
  if (options.service.workers == 0) options.service.workers = workers_for_this_machine();
  const std::string fault_of_scenes = add_scenes(raw.scenes, options.scenes);
  std::vector<std::string> faults = contradictions(options);
  const auto add = [&faults](std::string fault) {
    if (!fault.empty()) faults.push_back(std::move(fault));
  };
  add(fault_of_scenes);
  if (fault_of_scenes.empty() && options.scenes.empty() && options.scene_roots.empty() &&
      options.state.folder.empty() && options.fleet.role == FleetRole::kAlone) {
    add("no scene is named: give --scene or, in a configuration file, [[scene]]; or say with "
        "--scene-roots where clients may load scenes from, or with --state where scenes are kept");
  }
  for (SceneArgument& scene : options.scenes) {
    scene.options.import.map_limits = options.service.scene_rules.maps;
    scene.options.mirror_voxels = options.service.scene_rules.mirror_voxels;
  }
  // The values of file and flags were checked when they were read; that of the environment was not.
  add(fault_at("lcm.url", service::parse_lcm_url(options.lcm_url).fault, options));
  add(fault_at("scenes.roots", open_roots(options.scene_roots, options.service.scene_rules.roots),
               options));
  return faults;
}

/// Returns the outcome of `--check-config` for options with these faults.
ParsedOptions check(const DaemonOptions& options, std::vector<std::string> faults) {
  std::ranges::move(missing_things(options), std::back_inserter(faults));
  TriedScenes scenes = try_scenes(options.scenes, options.store);
  std::ranges::move(scenes.faults, std::back_inserter(faults));
  if (!faults.empty()) return failed(std::move(faults));
  std::ostringstream found;
  found << "camwayd: the configuration is right\n";
  for (const std::string& scene : scenes.found) found << scene << '\n';
  DaemonOptions defaults = default_options();
  defaults.service.workers = workers_for_this_machine();
  for (const SettingChange& change : changes_between(std::move(defaults), options)) {
    found << change.key << " = " << change.after << " (default " << change.before << ")\n";
  }
  return {std::nullopt, found.str(), {}};
}

}  // namespace

ParsedOptions parse_daemon_options(int argc, const char* const* argv) {
  DaemonOptions options = default_options();
  Raw raw;
  if (std::optional<ParsedOptions> end = read_flags(argc, argv, raw, options)) return *end;
  if (!raw.config_file.empty()) {
    options = default_options();
    std::vector<std::string> faults = read_config_file(raw.config_file, options);
    if (!faults.empty()) return failed(std::move(faults));
    // The flags once more, over the file. They were valid the first time, so they are valid again.
    raw = {};
    if (std::optional<ParsedOptions> end = read_flags(argc, argv, raw, options)) return *end;
  }
  std::vector<std::string> faults = resolve(raw, options);
  if (raw.check_config) return check(options, std::move(faults));
  if (faults.empty()) faults = unusable_fleet_files(options);
  if (!faults.empty()) return failed(std::move(faults));
  return {std::move(options), {}, {}};
}

}  // namespace camway::process
