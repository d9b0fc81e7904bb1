// SPDX-License-Identifier: MIT
#include "daemon/process/scene_origins.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <utility>

#include <nlohmann/json.hpp>

namespace camway::process {
namespace {

using nlohmann::json;

constexpr std::string_view kNoteKey = "configured scenes";

}  // namespace

FileStamp FileStamp::of(const std::filesystem::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return {};  // loading says what is wrong
  constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
  return {status.st_mtim.tv_sec * kNanosecondsPerSecond + status.st_mtim.tv_nsec, status.st_size,
          status.st_ino};
}

SceneOrigins::SceneOrigins(scene::SceneLog* log, const std::string& owner)
    : log_(log),
      note_key_(owner.empty() ? std::string(kNoteKey) : fmt::format("{} of {}", kNoteKey, owner)) {
  if (log_ == nullptr) return;
  const json note = json::parse(log_->note(note_key_), nullptr, false);
  // Without the note all files are read again, which is never wrong.
  if (!note.is_object()) return;
  for (const auto& [name, origin] : note.items()) {
    if (!origin.is_array() || origin.size() != 4 || !origin[0].is_string()) continue;
    if (!origin[1].is_number() || !origin[2].is_number() || !origin[3].is_number()) continue;
    origins_[name] = {origin[0].get<std::string>(),
                      {origin[1].get<std::int64_t>(), origin[2].get<std::int64_t>(),
                       origin[3].get<std::uint64_t>()}};
  }
}

std::optional<SceneOrigins::Origin> SceneOrigins::find(std::string_view name) const {
  const auto found = origins_.find(name);
  return found == origins_.end() ? std::nullopt : std::optional(found->second);
}

std::vector<std::string> SceneOrigins::names() const {
  std::vector<std::string> names;
  for (const auto& [name, origin] : origins_) names.push_back(name);
  return names;
}

void SceneOrigins::set(const SceneArgument& scene, const FileStamp& stamp) {
  if (log_ == nullptr) return;
  origins_[scene.name] = {arguments_of(scene), stamp};
  save();
}

void SceneOrigins::erase(const std::string& name) {
  if (origins_.erase(name) > 0) save();
}

std::string SceneOrigins::arguments_of(const SceneArgument& scene) {
  return std::filesystem::absolute(scene.file).string() + " " + options_of(scene);
}

std::string SceneOrigins::options_of(const SceneArgument& scene) {
  const scene::SnapshotOptions& options = scene.options;
  std::string bounds;
  for (std::size_t side = 0; side < geometry::Bounds::kSides; ++side) {
    bounds += fmt::format(" {}", options.bounds.limit_m(side));
  }
  return fmt::format("scale {} up {} unknown {} voxel {} bounds{}", options.import.scale,
                     static_cast<int>(options.import.up), static_cast<int>(options.import.unknown),
                     options.occupancy_resolution_m.value_or(0.0), bounds);
}

void SceneOrigins::save() {
  json note = json::object();
  for (const auto& [name, origin] : origins_) {
    note[name] = {origin.arguments, origin.stamp.written_ns, origin.stamp.size, origin.stamp.inode};
  }
  // If this fails, the next start reads the files again.
  log_->set_note(note_key_, note.dump(-1, ' ', false, json::error_handler_t::replace));
}

}  // namespace camway::process
