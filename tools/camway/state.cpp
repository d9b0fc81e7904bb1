// SPDX-License-Identifier: MIT
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/scene/log/change_record.h"
#include "daemon/scene/log/sqlite/sqlite_log.h"
#include "tools/camway/common/commands.h"
#include "tools/json/json_text.h"

namespace camway::tools {
namespace {

using scene::RecordedScene;
using scene::SqliteLog;

/// A scene of the log, for people.
struct KeptScene {
  std::string name;
  RecordedScene scene;  ///< with its newest objects as `objects`
  std::size_t revisions = 0;
};

std::string when_text(std::chrono::system_clock::time_point time) {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(time)));
}

/// Reads what is kept. On a fault, prints it and returns nothing.
std::optional<std::vector<KeptScene>> read_scenes(const std::string& folder) {
  const auto log = SqliteLog::open_read_only(folder);
  if (!log) {
    print_error(log.error);
    return std::nullopt;
  }
  const auto logged = (*log)->scenes();
  if (!logged) {
    print_error(logged.error);
    return std::nullopt;
  }
  std::vector<KeptScene> kept;
  for (const scene::LoggedScene& each : *logged) {
    base::Result<RecordedScene> scene = recorded_scene_of(each);
    if (!scene) {
      print_error(scene.error);
      return std::nullopt;
    }
    const std::size_t revisions = scene->revisions.size() + 1;
    scene->forget_before(scene->newest_revision());
    kept.push_back({each.name, *std::move(scene), revisions});
  }
  return kept;
}

void print_json(const std::vector<KeptScene>& scenes) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const KeptScene& kept : scenes) {
    nlohmann::ordered_json objects = nlohmann::ordered_json::array();
    for (const scene::RecordedObject& object : kept.scene.objects) objects.push_back(object.name);
    json.push_back({{"scene", kept.name},
                    {"revision", kept.scene.oldest.revision},
                    {"last_change", when_text(kept.scene.oldest.note.when)},
                    {"revisions_kept", kept.revisions},
                    {"objects", std::move(objects)}});
  }
  fmt::print("{}\n", json_text(json, 2));
}

void print_text(const std::vector<KeptScene>& scenes) {
  if (scenes.empty()) {
    fmt::print("no scenes\n");
    return;
  }
  fmt::print("{:<24}  {:>8}  {:>7}  {:>4}  {}\n", "scene", "revision", "objects", "kept",
             "last change");
  for (const KeptScene& kept : scenes) {
    const scene::ChangeNote& note = kept.scene.oldest.note;
    fmt::print("{:<24}  {:>8}  {:>7}  {:>4}  {}\n", kept.name, kept.scene.oldest.revision,
               kept.scene.objects.size(), kept.revisions,
               fmt::format("{} {} {}", when_text(note.when), note.operation, note.object));
  }
}

ExitCode show_state(const std::string& folder, bool as_json) {
  const std::optional<std::vector<KeptScene>> scenes = read_scenes(folder);
  if (!scenes) return ExitCode::kInvalidInput;
  as_json ? print_json(*scenes) : print_text(*scenes);
  return ExitCode::kSuccess;
}

ExitCode check_state(const std::string& folder) {
  const bool is_export = std::filesystem::is_regular_file(folder);
  const auto content =
      SqliteLog::check(is_export ? std::filesystem::path(folder) : SqliteLog::file_of(folder));
  if (!content) {
    print_error(content.error);
    return ExitCode::kInvalidInput;
  }
  if (!is_export && !read_scenes(folder)) return ExitCode::kInvalidInput;
  fmt::print("{}: whole: {} scenes, {} changes since their summaries, {} blobs of {} bytes\n",
             folder, content->scenes, content->entries, content->blobs, content->blob_bytes);
  return ExitCode::kSuccess;
}

/// Prints a fault, if there is one.
ExitCode outcome(const std::string& fault, const std::string& done) {
  if (!fault.empty()) {
    print_error(fault);
    return ExitCode::kInvalidInput;
  }
  fmt::print("{}\n", done);
  return ExitCode::kSuccess;
}

ExitCode export_state(const std::string& folder, const std::string& file) {
  const auto log = SqliteLog::open_read_only(folder);
  return outcome(log ? (*log)->export_to(file) : log.error, fmt::format("{}: written", file));
}

ExitCode restore_state(const std::string& file, const std::string& folder) {
  return outcome(SqliteLog::restore(file, folder), fmt::format("{}: restored", folder));
}

/// Arguments of the subcommands.
struct Words {
  std::string folder;
  std::string file;
  bool as_json = false;
};

CLI::Option* add_word(CLI::App* command, const std::string& name, std::string& word,
                      const std::string& meaning) {
  return command->add_option(name, word, meaning)->required()->type_name("PATH");
}

}  // namespace

void add_state_command(CLI::App& app, ExitCode& exit_code) {
  const auto words = std::make_shared<Words>();
  CLI::App* command = app.add_subcommand(
      "state", "Show, check, copy and restore the folder in which a daemon keeps its scenes");
  command->require_subcommand(1);
  command->footer(exit_code_help("") +
                  "\nExample: camway state export /var/lib/camway backup.sqlite");

  CLI::App* list = command->add_subcommand("show", "List the scenes");
  add_word(list, "FOLDER", words->folder, "the daemon's state.folder");
  list->add_flag("--json", words->as_json, "Print JSON, for machines");
  list->callback([words, &exit_code] { exit_code = show_state(words->folder, words->as_json); });

  CLI::App* verify = command->add_subcommand("check", "Verify every byte");
  add_word(verify, "FOLDER", words->folder, "the daemon's state.folder, or an export");
  verify->callback([words, &exit_code] { exit_code = check_state(words->folder); });

  CLI::App* copy = command->add_subcommand(
      "export", "Copy it into one file, also while a daemon uses it: a backup");
  add_word(copy, "FOLDER", words->folder, "the daemon's state.folder");
  add_word(copy, "FILE", words->file, "the new file");
  copy->callback([words, &exit_code] { exit_code = export_state(words->folder, words->file); });

  CLI::App* restore = command->add_subcommand(
      "restore", "Put an export into a folder that has no scenes; no daemon may use it");
  add_word(restore, "FILE", words->file, "what export wrote");
  add_word(restore, "FOLDER", words->folder, "the daemon's state.folder");
  restore->callback([words, &exit_code] { exit_code = restore_state(words->file, words->folder); });
}

}  // namespace camway::tools
