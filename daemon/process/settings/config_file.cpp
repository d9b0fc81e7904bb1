// SPDX-License-Identifier: MIT
#include "daemon/process/settings/config_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include <toml++/toml.h>

#include "daemon/base/named_enum.h"
#include "daemon/messages/scene_names.h"
#include "daemon/process/settings/bounds_text.h"
#include "daemon/process/settings/daemon_settings.h"
#include "daemon/scene/import/record/import_words.h"
#include "daemon/scene/voxels/voxel_grid.h"

namespace camway::process {
namespace {

constexpr std::array<std::string_view, 9> kSceneKeys{
    "name",  "file",  "scale", "up", "unknown", "voxel_m", "occupancy_resolution_m",
    "watch", "bounds"};

constexpr double kMaxSceneNumber = 1e9;

/// Collects faults, each with file and line.
class Faults {
 public:
  explicit Faults(std::string file) : file_(std::move(file)) {}

  void add(const toml::source_region& where, std::string_view what) {
    faults_.emplace(where.begin.line, fmt::format("{}: {}", place(where), what));
  }
  /// "camwayd.toml:12".
  [[nodiscard]] std::string place(const toml::source_region& where) const {
    return fmt::format("{}:{}", file_, where.begin.line);
  }
  /// Returns the faults in the order of their lines; the parser visits keys in alphabetical order.
  [[nodiscard]] std::vector<std::string> lines() const {
    std::vector<std::string> lines;
    for (const auto& [line, text] : faults_) lines.push_back(text);
    return lines;
  }

 private:
  std::string file_;
  std::multimap<toml::source_index, std::string> faults_;
};

/// Sets one setting from a file in `folder`. Returns an error about the value, or an empty text.
std::string apply(const Setting& setting, const toml::node& node,
                  const std::filesystem::path& folder) {
  if (setting.is_text()) {
    const auto* const text = node.as_string();
    if (text == nullptr) {
      return node.is_array() && setting.path == Setting::Path::kFolders
                 ? "must be one text in quotes; several folders have ':' between them"
                 : "must be a text in quotes";
    }
    return setting.set(setting.below(folder, text->get()));
  }
  if (setting.is_switch()) {
    const auto* const on = node.as_boolean();
    if (on == nullptr) return "must be true or false";
    setting.turn(on->get());
    return {};
  }
  if (const auto* const whole = node.as_integer()) {
    return setting.set(static_cast<double>(whole->get()));
  }
  const auto* const number = node.as_floating_point();
  if (number == nullptr || setting.is_whole_number()) {
    return setting.is_whole_number() ? "must be a whole number" : "must be a number";
  }
  return setting.set(number->get());
}

/// Returns the valid keys of a table, for an error about an unknown one.
std::string keys_beside(const std::vector<Setting>& settings, std::string_view table) {
  std::set<std::string_view> keys;
  for (const Setting& setting : settings) {
    const std::size_t dot = setting.key.find('.');
    if (table.empty()) {
      keys.insert(setting.key.substr(0, dot));
    } else if (setting.key.substr(0, dot) == table) {
      keys.insert(setting.key.substr(dot + 1));
    }
  }
  if (table.empty()) keys.insert("scene");
  return fmt::format("{} has {}", table.empty() ? "the file" : fmt::format("[{}]", table),
                     fmt::join(keys, ", "));
}

void read_table(const toml::table& table, std::string_view name,
                const std::vector<Setting>& settings, const std::filesystem::path& folder,
                DaemonOptions& options, Faults& faults) {
  for (const auto& [key, node] : table) {
    const std::string path = fmt::format("{}.{}", name, key.str());
    const auto found = std::find_if(settings.begin(), settings.end(),
                                    [&](const Setting& setting) { return setting.key == path; });
    if (found == settings.end()) {
      faults.add(key.source(),
                 fmt::format("'{}' is no setting; {}", path, keys_beside(settings, name)));
    } else if (const std::string fault = apply(*found, node, folder); !fault.empty()) {
      faults.add(node.source(), fmt::format("{}: {}", path, fault));
    } else {
      options.set_at[path] = fmt::format("{}: {}", faults.place(node.source()), path);
    }
  }
}

std::string read_number_above_0(const toml::node& node, double& value) {
  const std::optional<double> number = node.value<double>();
  if (!number || !(*number > 0.0) || !(*number <= kMaxSceneNumber)) {
    return fmt::format("must be a number above 0, {} at most", kMaxSceneNumber);
  }
  value = *number;
  return {};
}

/// Applies one key of a [[scene]]. Returns an error about its value, or an empty text.
std::string apply_to_scene(std::string_view key, const toml::node& node, SceneArgument& scene) {
  if (key == "scale") return read_number_above_0(node, scene.options.import.scale);
  if (key == "voxel_m") {
    const double voxel_m = node.value<double>().value_or(0.0);
    scene.options.import.voxel_m = voxel_m;
    return scene::VoxelGrid::valid_resolution(voxel_m) ? "" : messages::kResolutionRule;
  }
  if (key == "occupancy_resolution_m") {
    const double resolution_m = node.value<double>().value_or(0.0);
    scene.options.occupancy_resolution_m = resolution_m;
    return scene::VoxelGrid::valid_resolution(resolution_m) ? "" : messages::kResolutionRule;
  }
  if (key == "watch") {
    const auto* const wanted = node.as_boolean();
    if (wanted == nullptr) return "must be true or false";
    scene.watch = wanted->get();
    return {};
  }
  const auto* const text = node.as_string();
  if (text == nullptr) return "must be a text in quotes";
  if (key == "name") {
    scene.name = text->get();
    return messages::is_scene_name(scene.name) ? std::string() : messages::kSceneNameRule;
  }
  if (key == "bounds") {
    const base::Result<geometry::Bounds> parsed = parse_bounds(text->get());
    if (parsed) scene.options.bounds = *parsed;
    return parsed.error;
  }
  if (key == "file") {
    scene.file = text->get();
    return scene.file.empty() ? "must name a file" : std::string();
  }
  if (key == "unknown") {
    const auto unknown = base::value_of<scene::UnknownSpace>(text->get());
    if (!unknown) return "must be free or occupied";
    scene.options.import.unknown = *unknown;
    return {};
  }
  const auto up = base::value_of<scene::UpAxis>(text->get());
  if (!up) return "must be as-in-file, z-to-y or y-to-z";
  scene.options.import.up = *up;
  return {};
}

std::optional<SceneArgument> read_scene(const toml::table& table, Faults& faults) {
  SceneArgument scene;
  bool good = true;
  const auto fault = [&](const toml::source_region& where, const std::string& what) {
    faults.add(where, what);
    good = false;
  };
  for (const auto& [key, node] : table) {
    if (std::find(kSceneKeys.begin(), kSceneKeys.end(), key.str()) == kSceneKeys.end()) {
      fault(key.source(), fmt::format("'{}' is no setting of a scene; {} are", key.str(),
                                      fmt::join(kSceneKeys, ", ")));
    } else if (const std::string why = apply_to_scene(key.str(), node, scene); !why.empty()) {
      fault(node.source(), fmt::format("scene.{}: {}", key.str(), why));
    } else if (key == "file") {
      scene.set_at = faults.place(node.source());
    }
  }
  for (const char* const needed : {"name", "file"}) {
    if (!table.contains(needed)) {
      fault(table.source(), fmt::format("[[scene]]: '{}' is missing", needed));
    }
  }
  return good ? std::optional(std::move(scene)) : std::nullopt;
}

void read_scenes(const toml::node& node, const std::filesystem::path& folder,
                 DaemonOptions& options, Faults& faults) {
  const toml::array* const scenes = node.as_array();
  if (scenes == nullptr || !scenes->is_homogeneous(toml::node_type::table)) {
    faults.add(node.source(), "scene: must be tables, each under [[scene]]");
    return;
  }
  for (const toml::node& element : *scenes) {
    std::optional<SceneArgument> scene = read_scene(*element.as_table(), faults);
    if (!scene) continue;
    scene->file = folder / scene->file;
    const bool twice =
        std::any_of(options.scenes.begin(), options.scenes.end(),
                    [&](const SceneArgument& other) { return other.name == scene->name; });
    if (twice) {
      faults.add(element.source(), fmt::format("scene.name: '{}' is there twice", scene->name));
    }
    options.scenes.push_back(std::move(*scene));
  }
}

void read_root(const toml::table& root, const std::filesystem::path& folder, DaemonOptions& options,
               Faults& faults) {
  const std::vector<Setting> settings = settings_of(options);
  const auto is_table = [&](std::string_view name) {
    return std::any_of(settings.begin(), settings.end(), [&](const Setting& setting) {
      return setting.key.substr(0, setting.key.find('.')) == name;
    });
  };
  for (const auto& [key, node] : root) {
    if (key.str() == "scene") {
      read_scenes(node, folder, options, faults);
    } else if (!is_table(key.str())) {
      faults.add(key.source(),
                 fmt::format("'{}' is no setting; {}", key.str(), keys_beside(settings, "")));
    } else if (const toml::table* const table = node.as_table()) {
      read_table(*table, key.str(), settings, folder, options, faults);
    } else {
      faults.add(node.source(), fmt::format("'{}' must be a table: [{}]", key.str(), key.str()));
    }
  }
}

}  // namespace

std::vector<std::string> read_config_file(const std::filesystem::path& file,
                                          DaemonOptions& options) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) return {file.string() + ": is a folder"};
  errno = 0;
  const std::ifstream stream(file, std::ios::binary);
  if (!stream.is_open()) {
    return {fmt::format("{}: cannot be opened: {}", file.string(),
                        std::generic_category().message(errno))};
  }
  std::ostringstream text;
  text << stream.rdbuf();  // sets failbit if the file is empty
  if (text.str().empty()) return {file.string() + ": is empty"};
  Faults faults(file.string());
  try {
    read_root(toml::parse(text.str(), file.string()), file.parent_path(), options, faults);
  } catch (const toml::parse_error& error) {
    faults.add(error.source(), error.description());
  }
  return faults.lines();
}

}  // namespace camway::process
