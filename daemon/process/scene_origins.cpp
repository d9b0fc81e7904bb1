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
/// Begins the keys of the notes of processes that share a log.
constexpr std::string_view kNoteOfOwner = "configured scenes of ";

using Origins = std::map<std::string, SceneOrigins::Origin, std::less<>>;

/// Reads a note, and leaves out what it cannot read: the files of that are read again, which is
/// never wrong.
Origins origins_in(std::string_view text) {
  Origins origins;
  const json note = json::parse(text, nullptr, false);
  if (!note.is_object()) return origins;
  for (const auto& [name, origin] : note.items()) {
    if (!origin.is_array() || origin.size() < 4 || origin.size() > 5) continue;
    if (!origin[0].is_string() || !origin[1].is_number() || !origin[2].is_number() ||
        !origin[3].is_number()) {
      continue;
    }
    origins[name] = {origin[0].get<std::string>(),
                     {origin[1].get<std::int64_t>(), origin[2].get<std::int64_t>(),
                      origin[3].get<std::uint64_t>()},
                     origin.size() == 5};
  }
  return origins;
}

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
      is_shared_(!owner.empty()),
      note_key_(is_shared_ ? std::string(kNoteOfOwner) + owner : std::string(kNoteKey)) {
  if (log_ != nullptr) origins_ = origins_in(log_->note(note_key_));
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

void SceneOrigins::mark_dropped(const std::string& name, bool is_dropped) {
  const auto found = origins_.find(name);
  if (found == origins_.end() || found->second.is_dropped == is_dropped) return;
  found->second.is_dropped = is_dropped;
  save();
}

base::Result<std::string> SceneOrigins::other_owner_of(const std::string& name) const {
  if (log_ == nullptr || !is_shared_) return std::string();
  const auto notes = log_->notes(kNoteOfOwner);
  if (!notes) return base::Failure{notes.error};
  for (const auto& [key, text] : *notes) {
    if (key == note_key_) continue;
    const Origins origins = origins_in(text);
    const auto found = origins.find(name);
    if (found != origins.end() && !found->second.is_dropped) return key.substr(kNoteOfOwner.size());
  }
  return std::string();
}

void SceneOrigins::erase(const std::string& name) {
  if (origins_.erase(name) > 0) save();
}

std::string SceneOrigins::arguments_of(const SceneArgument& scene) {
  return std::filesystem::absolute(scene.file).string() + " " + options_of(scene);
}

std::string SceneOrigins::reading_of(const SceneArgument& scene) {
  const scene::ImportOptions& import = scene.options.import;
  const std::string voxels = import.voxel_m ? fmt::format(" voxel_m {}", *import.voxel_m) : "";
  return fmt::format("scale {} up {} unknown {}{}", import.scale, static_cast<int>(import.up),
                     static_cast<int>(import.unknown), voxels);
}

std::string SceneOrigins::options_of(const SceneArgument& scene) {
  return reading_of(scene) + scene_options_of(scene);
}

std::string SceneOrigins::other_reader_of(const SceneArgument& scene) const {
  if (log_ == nullptr || !is_shared_) return "";
  const auto notes = log_->notes(kNoteOfOwner);
  if (!notes) return "";
  for (const auto& [key, text] : *notes) {
    if (key == note_key_) continue;
    const Origins origins = origins_in(text);
    const auto found = origins.find(scene.name);
    if (found == origins.end() || found->second.is_dropped) continue;
    // The file of another machine may have another name.
    if (found->second.arguments.find(" " + reading_of(scene)) == std::string::npos) {
      return key.substr(kNoteOfOwner.size());
    }
  }
  return "";
}

std::string SceneOrigins::scene_options_of(const SceneArgument& scene) {
  const scene::SnapshotOptions& options = scene.options;
  std::string bounds;
  for (std::size_t side = 0; side < geometry::Bounds::kSides; ++side) {
    bounds += fmt::format(" {}", options.bounds.limit_m(side));
  }
  return fmt::format(" voxel {} bounds{}", options.occupancy_resolution_m.value_or(0.0), bounds);
}

void SceneOrigins::save() {
  json note = json::object();
  for (const auto& [name, origin] : origins_) {
    json& kept = note[name];
    kept = {origin.arguments, origin.stamp.written_ns, origin.stamp.size, origin.stamp.inode};
    if (origin.is_dropped) kept.push_back(true);
  }
  // If this fails, the next start reads the files again.
  log_->set_note(note_key_, note.dump(-1, ' ', false, json::error_handler_t::replace));
}

}  // namespace camway::process
