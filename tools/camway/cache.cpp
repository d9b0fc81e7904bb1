// SPDX-License-Identifier: MIT
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/base/named_enum.h"
#include "daemon/scene/cache/scene_cache.h"
#include "daemon/scene/import/record/import_words.h"
#include "tools/camway/common/commands.h"
#include "tools/json/json_text.h"

namespace camway::tools {
namespace {

using scene::CachedScene;
using scene::SceneCache;

std::string time_text(std::chrono::system_clock::time_point time) {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(time));
}

std::uint64_t bytes_of(const std::vector<CachedScene>& scenes) {
  std::uint64_t bytes = 0;
  for (const CachedScene& scene : scenes) bytes += scene.bytes;
  return bytes;
}

/// Returns "house.obj (scale 0.0254, z-to-y)": a file may be kept in several readings.
std::string file_text(const CachedScene& scene) {
  std::string reading;
  if (scene.scale != 1.0) reading = fmt::format("scale {}", scene.scale);
  if (scene.up != scene::UpAxis::kAsInFile) {
    reading += (reading.empty() ? "" : ", ") + std::string(base::name_of(scene.up));
  }
  return reading.empty() ? scene.scene_file : scene.scene_file + " (" + reading + ")";
}

void print_json(const SceneCache& cache, const std::vector<CachedScene>& scenes) {
  using OrderedJson = nlohmann::ordered_json;
  OrderedJson json;
  json["folder"] = cache.folder().string();
  json["limit_bytes"] = cache.limits().bytes;
  json["bytes"] = bytes_of(scenes);
  json["scenes"] = OrderedJson::array();
  for (const CachedScene& scene : scenes) {
    json["scenes"].push_back({{"file", scene.scene_file},
                              {"scale", scene.scale},
                              {"up", base::name_of(scene.up)},
                              {"triangles", scene.triangles},
                              {"bytes", scene.bytes},
                              {"last_used", time_text(scene.last_used)},
                              {"same_build", scene.is_of_this_build},
                              {"key", scene.key}});
  }
  fmt::print("{}\n", json_text(json, 2));
}

void print_text(const SceneCache& cache, const std::vector<CachedScene>& scenes) {
  constexpr double kBytesPerMb = 1e6;
  if (!scenes.empty()) {
    fmt::print("{:<20}  {:>9}  {:>8}  {:<7}  {}\n", "last used", "triangles", "MB", "build",
               "file");
  }
  for (const CachedScene& scene : scenes) {
    fmt::print("{:<20}  {:>9}  {:>8.1f}  {:<7}  {}\n", time_text(scene.last_used), scene.triangles,
               static_cast<double>(scene.bytes) / kBytesPerMb,
               scene.is_of_this_build ? "this" : "another", file_text(scene));
  }
  fmt::print("{}: {} {}, {:.1f} MB of at most {:.0f} MB\n", cache.folder().string(), scenes.size(),
             scenes.size() == 1 ? "scene" : "scenes",
             static_cast<double>(bytes_of(scenes)) / kBytesPerMb,
             static_cast<double>(cache.limits().bytes) / kBytesPerMb);
}

/// Returns the cache. On an error, prints it and returns nothing. Whoever clears the cache needs no
/// limit of its size.
std::optional<SceneCache> open_cache(bool needs_limit) {
  scene::UserCache user = scene::cache_of_environment();
  const std::string fault = user.cache ? user.cache->fault() : "";
  if (needs_limit && !user.fault.empty()) {
    print_error(user.fault);
  } else if (!user.cache) {
    print_error("there is no cache: " + user.absence);
  } else if (!fault.empty()) {
    print_error(user.cache->folder().string() + ": " + fault);
  } else {
    return std::move(user.cache);
  }
  return std::nullopt;
}

ExitCode run_cache(bool clears, bool as_json) {
  const std::optional<SceneCache> cache = open_cache(!clears);
  if (!cache) return ExitCode::kInvalidInput;
  if (clears) {
    const std::size_t removed = cache->clear();
    fmt::print("{}: {} {} removed\n", cache->folder().string(), removed,
               removed == 1 ? "scene" : "scenes");
  } else if (as_json) {
    print_json(*cache, cache->scenes());
  } else {
    print_text(*cache, cache->scenes());
  }
  return ExitCode::kSuccess;
}

}  // namespace

void add_cache_command(CLI::App& app, ExitCode& exit_code) {
  const auto as_json = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand(
      "cache", "List the prepared scenes that are kept for the next start, or remove them");
  command->add_flag("--json", *as_json, "Print JSON, for machines");
  const CLI::App* clear = command->add_subcommand("clear", "Remove all of them");
  command->footer(
      "The folder is CAMWAY_CACHE_DIR, else XDG_CACHE_HOME/camway, else ~/.cache/camway; "
      "CAMWAY_CACHE_DIR= (empty) turns the cache off. CAMWAY_CACHE_BYTES limits its size "
      "[2147483648]; the scenes that were used the longest ago make room. Scenes of another build "
      "are not used.\n" +
      exit_code_help("") + "\nExample: camway cache --json");
  command->callback(
      [clear, as_json, &exit_code] { exit_code = run_cache(clear->parsed(), *as_json); });
}

}  // namespace camway::tools
