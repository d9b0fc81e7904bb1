// SPDX-License-Identifier: MIT
#include "daemon/service/daemon_options.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <thread>
#include <utility>

#include <CLI/CLI.hpp>

#include "daemon/service/build_info.h"
#include "daemon/service/config_file.h"
#include "daemon/service/daemon_settings.h"
#include "lcmtypes/message_keys.h"

namespace camway::service {
namespace {

constexpr char kFooter[] =
    "Exit codes: 0 stopped by SIGTERM or SIGINT once it serves (while it still reads scenes, the "
    "signal ends it at once), 1 LCM or the port for metrics cannot be used, or LCM failed, 2 wrong "
    "command "
    "line, configuration or scene file.\n"
    "SIGHUP reads the configuration again and takes over scenes and log level; what else changed "
    "is "
    "logged and needs a restart.\n"
    "Example: camwayd --scene office=scenes/office.obj,occupancy=0.1 --scene maze=scenes/maze.obj";

constexpr int kExitBadInput = 2;

bool is_readable_file(const std::filesystem::path& file) {
  std::error_code ignored;
  return !std::filesystem::is_directory(file, ignored) && std::ifstream(file).is_open();
}

int workers_for_this_machine() {
  return static_cast<int>(
      std::clamp(std::thread::hardware_concurrency(), 1U, unsigned{kMaxWorkers}));
}

/// What CLI11 fills in, as text where we parse ourselves.
struct Raw {
  std::string config_file;
  bool check_config = false;
  std::vector<std::string> scenes;
};

/// A flag for a setting of the configuration file that is one of a few words.
void declare_word(CLI::App& app, const std::string& flag, std::string_view key,
                  const std::string& meaning, DaemonOptions& options) {
  const auto setting = [&options, key] {
    const std::vector<Setting> settings = settings_of(options);
    return *std::ranges::find(settings, key, &Setting::key);
  };
  app.add_option_function<std::string>(
         flag,
         [setting, flag](const std::string& word) {
           const std::string fault = setting().set(word);
           if (!fault.empty()) throw CLI::ValidationError(flag, fault);
         },
         meaning + " [" + setting().text() + "]")
      ->type_name("WORD");
}

void declare(CLI::App& app, Raw& raw, DaemonOptions& options) {
  app.set_version_flag("--version", "camwayd " + version_text());
  app.footer(kFooter);
  app.add_option("--config", raw.config_file,
                 "Configuration file (TOML); what is given on the command line goes before it")
      ->type_name("FILE");
  app.add_flag("--check-config", raw.check_config,
               "Say what command line and configuration file come to, and end: with code 2 if "
               "anything is wrong");
  app.add_option("--scene", raw.scenes,
                 "A scene to hold; may be given several times, beside those of the configuration "
                 "file or in the place of one of the same name. scale: file units to metres; up: "
                 "turns axes; occupancy: edge of a voxel of the occupancy map in metres, no map "
                 "without it")
      ->type_name(kSceneArgumentForm)
      ->take_all();
  app.add_option("--scene-roots", options.scene_roots,
                 "Folders, with ':' between them, below which clients may have scene files read; "
                 "without them they can upload only")
      ->type_name("FOLDERS");
  app.add_option("--prefix", options.service.prefix, "Channels begin with this")
      ->capture_default_str();
  app.add_option("--url", options.lcm_url,
                 "LCM provider; ttl=0 keeps the traffic on this host [lcm.url of the configuration "
                 "file, else LCM_DEFAULT_URL, else " +
                     std::string(kDefaultLcmUrl) + "]");
  app.add_option("--workers", options.service.workers,
                 "Requests planned at the same time; 0: one for each core")
      ->check(CLI::Range(0, kMaxWorkers))
      ->capture_default_str();
  // CLI11 would read -1 as the largest number there is.
  app.add_option("--queue", options.service.queue.jobs, "Requests that may wait for a worker")
      ->check(CLI::Range(std::size_t{1}, kMaxQueueCapacity))
      ->capture_default_str();
  app.add_option("--client-queue", options.service.queue.jobs_of_a_client,
                 "Requests of one client that may wait for a worker")
      ->check(CLI::Range(std::size_t{1}, kMaxQueueCapacity))
      ->capture_default_str();
  app.add_option("--deadline-s", options.service.deadline.default_s,
                 "Deadline of requests that name none, seconds from their receipt")
      ->capture_default_str();
  app.add_option("--max-deadline-s", options.service.deadline.max_s,
                 "Longest deadline that a request may ask for, seconds")
      ->capture_default_str();
  declare_word(app, "--log-level", "log.level", "What is logged on standard error", options);
  declare_word(app, "--log-format", "log.format",
               "How: text for people, or an object of JSON on each line", options);
}

/// Reads the command line over `options`; what to end with if it is no good or asks for help.
std::optional<ParsedOptions> read_flags(int argc, const char* const* argv, Raw& raw,
                                        DaemonOptions& options) {
  CLI::App app("camwayd: plans camera paths that are free of collision, over LCM", "camwayd");
  declare(app, raw, options);
  try {
    app.parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    std::ostringstream text;
    const bool good = app.exit(error, text, text) == 0;
    return ParsedOptions{std::nullopt, good ? 0 : kExitBadInput, text.str()};
  }
}

/// The scenes of the command line, beside or in the place of those of the file; returns what is
/// wrong with them.
std::string add_scenes(const std::vector<std::string>& texts, std::vector<SceneArgument>& scenes) {
  std::set<std::string> names;
  for (const std::string& text : texts) {
    ParsedSceneArgument parsed = parse_scene_argument(text);
    if (!parsed.scene) return "--scene: " + parsed.error;
    const std::string& name = parsed.scene->name;
    if (!names.insert(name).second) return "--scene: the name '" + name + "' is given twice";
    std::erase_if(scenes, [&](const SceneArgument& scene) { return scene.name == name; });
    scenes.push_back(std::move(*parsed.scene));
  }
  return {};
}

/// Looks up the folders; returns what is wrong with them.
std::string open_roots(const std::string& folders, SceneRoots& roots) {
  std::vector<std::filesystem::path> paths;
  std::istringstream text(folders);
  for (std::string folder; std::getline(text, folder, ':');) {
    if (!folder.empty()) paths.emplace_back(folder);
  }
  std::string fault;
  roots = SceneRoots::make(paths, fault);
  return fault;
}

/// Turns the texts into options; returns what is wrong with them.
std::string resolve(const Raw& raw, DaemonOptions& options) {
  options.config_file = raw.config_file;
  if (options.service.workers == 0) options.service.workers = workers_for_this_machine();
  if (std::string fault = add_scenes(raw.scenes, options.scenes); !fault.empty()) return fault;
  if (options.scenes.empty() && options.scene_roots.empty()) {
    return "no scene is named: give --scene or, in a configuration file, [[scene]]; or say with "
           "--scene-roots where clients may load scenes from";
  }
  for (SceneArgument& scene : options.scenes) {
    scene.options.import.map_limits = options.service.scene_rules.maps;
    scene.options.mirror_voxels = options.service.scene_rules.mirror_voxels;
  }
  if (std::string fault = open_roots(options.scene_roots, options.service.scene_rules.roots);
      !fault.empty()) {
    return fault;
  }
  return options.service.fault();
}

ParsedOptions failed(const std::vector<std::string>& faults) {
  ParsedOptions parsed{std::nullopt, kExitBadInput, {}};
  for (const std::string& fault : faults) parsed.text += "camwayd: " + fault + '\n';
  return parsed;
}

/// What `--check-config` finds in options that are right in themselves.
ParsedOptions check(const DaemonOptions& options) {
  std::vector<std::string> faults;
  std::ostringstream found;
  found << "camwayd: the configuration is right\n";
  for (const SceneArgument& scene : options.scenes) {
    const std::string line = "scene '" + scene.name + "': " + scene.file.string();
    if (!is_readable_file(scene.file)) faults.push_back(line + " cannot be read");
    found << line << '\n';
  }
  if (!options.auth.key_file.empty()) {
    const wire::MessageKeys::Read read = wire::MessageKeys::from_file(options.auth.key_file);
    if (!read.keys) faults.push_back("auth.key_file: " + read.error);
  }
  DaemonOptions defaults = default_options();
  defaults.service.workers = workers_for_this_machine();
  for (const SettingChange& change : changes_between(std::move(defaults), options)) {
    found << change.key << " = " << change.after << " (default " << change.before << ")\n";
  }
  return faults.empty() ? ParsedOptions{std::nullopt, 0, found.str()} : failed(faults);
}

}  // namespace

std::string url_of_environment() {
  const char* const url = std::getenv("LCM_DEFAULT_URL");
  return url == nullptr ? "" : url;
}

DaemonOptions default_options() {
  DaemonOptions options;
  options.lcm_url = url_of_environment();
  if (options.lcm_url.empty()) options.lcm_url = kDefaultLcmUrl;
  options.service.workers = 0;
  return options;
}

ParsedOptions parse_daemon_options(int argc, const char* const* argv) {
  DaemonOptions options = default_options();
  Raw raw;
  if (std::optional<ParsedOptions> end = read_flags(argc, argv, raw, options)) return *end;
  if (!raw.config_file.empty()) {
    options = default_options();
    const std::vector<std::string> faults = read_config_file(raw.config_file, options);
    if (!faults.empty()) return failed(faults);
    // Once more, over the file. What was good the first time is good again.
    raw = {};
    if (std::optional<ParsedOptions> end = read_flags(argc, argv, raw, options)) return *end;
  }
  if (const std::string fault = resolve(raw, options); !fault.empty()) return failed({fault});
  if (raw.check_config) return check(options);
  return {std::move(options), 0, {}};
}

}  // namespace camway::service
