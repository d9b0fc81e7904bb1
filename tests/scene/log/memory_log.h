// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "daemon/scene/log/removal_requests.h"
#include "daemon/scene/log/scene_log.h"

namespace camway::testing {

/// A log in memory: the model of other logs, and one whose faults a test can choose. Thread-safe,
/// except for `fault`, `head` and what follows it.
class MemoryLog final : public scene::SceneLog {
 public:
  using AppendFault = scene::AppendFault;
  using AppendResult = scene::AppendResult;
  using BlobId = scene::BlobId;

  /// The fault of all calls of `append`, `put_blob` and `notes` while it is set.
  AppendFault fault = AppendFault::kNone;

  AppendResult put_blob(const BlobId& id, const scene::Blob& blob) override {
    const std::lock_guard lock(mutex_);
    if (fault != AppendFault::kNone) return {fault, "no disk"};
    if (blobs_.contains(id)) return {};
    if (!are_there(blob.needs)) return {AppendFault::kBroken, "needs"};
    blobs_.emplace(id, blob);
    return {};
  }
  bool has_blob(const BlobId& id) override {
    const std::lock_guard lock(mutex_);
    return blobs_.contains(id);
  }
  base::Result<scene::Bytes> blob(const BlobId& id) override {
    const std::lock_guard lock(mutex_);
    if (!blobs_.contains(id)) return base::Failure{"not there"};
    return blobs_.at(id).bytes;
  }
  AppendResult append(std::string_view name, const scene::LogEntry& entry) override {
    const std::lock_guard lock(mutex_);
    if (fault != AppendFault::kNone) return {fault, "no disk"};
    if (head(name) != entry.before) return {AppendFault::kConflict, "revision"};
    if (!are_there(entry.needs)) return {AppendFault::kBroken, "needs"};
    Kept& kept = scenes_[std::string(name)];
    kept.scene.name = name;
    kept.scene.entries.push_back(entry);
    return {};
  }
  AppendResult summarize(std::string_view name, std::uint64_t revision, const scene::Bytes& summary,
                         const std::vector<BlobId>& needs) override {
    const std::lock_guard lock(mutex_);
    const auto found = scenes_.find(std::string(name));
    if (found == scenes_.end()) return {AppendFault::kConflict, "no scene"};
    scene::LoggedScene& scene = found->second.scene;
    const bool is_known =
        revision == scene.summary_revision ||
        std::ranges::any_of(scene.entries, [&](const auto& e) { return e.revision == revision; });
    if (revision == 0 || !is_known) return {AppendFault::kConflict, "no revision"};
    if (!are_there(needs)) return {AppendFault::kBroken, "needs"};
    std::erase_if(scene.entries, [&](const auto& e) { return e.revision <= revision; });
    scene.summary_revision = revision;
    scene.summary = summary;
    found->second.summary_needs = needs;
    return {};
  }
  AppendResult remove(std::string_view name, std::uint64_t revision,
                      std::string_view request) override {
    const std::lock_guard lock(mutex_);
    if (revision == 0 || head(name) != revision) return {AppendFault::kConflict, "revision"};
    removals_ = scene::with_removal(removals_, request);
    scenes_.erase(std::string(name));
    highest_removed_ = std::max(highest_removed_, revision);
    return {};
  }
  std::uint64_t highest_removed() override { return highest_removed_; }
  std::vector<std::string> removals() override {
    const std::lock_guard lock(mutex_);
    return scene::removals_in(removals_);
  }
  base::Result<std::vector<scene::LoggedScene>> scenes() override {
    const std::lock_guard lock(mutex_);
    std::vector<scene::LoggedScene> list;
    for (const auto& [name, kept] : scenes_) list.push_back(kept.scene);
    return list;
  }
  std::string note(std::string_view key) override { return notes_[std::string(key)]; }
  AppendResult set_note(std::string_view key, std::string_view text) override {
    notes_[std::string(key)] = text;
    return {};
  }
  base::Result<std::map<std::string, std::string>> notes(std::string_view prefix) override {
    if (fault != AppendFault::kNone) return base::Failure{"no disk"};
    std::map<std::string, std::string> found;
    for (const auto& [key, text] : notes_) {
      if (key.starts_with(prefix) && !text.empty()) found.emplace(key, text);
    }
    return found;
  }
  AppendResult drop_unused_blobs() override {
    const std::lock_guard lock(mutex_);
    std::set<BlobId> used;
    for (const auto& [name, kept] : scenes_) {
      for (const BlobId& id : kept.summary_needs) use(id, used);
      for (const scene::LogEntry& entry : kept.scene.entries) {
        for (const BlobId& id : entry.needs) use(id, used);
      }
    }
    std::erase_if(blobs_, [&](const auto& blob) { return !used.contains(blob.first); });
    return {};
  }

  /// The newest revision of a scene; 0 if it does not exist. Not to be called beside changes.
  [[nodiscard]] std::uint64_t head(std::string_view name) const {
    const auto found = scenes_.find(std::string(name));
    if (found == scenes_.end()) return 0;
    const scene::LoggedScene& scene = found->second.scene;
    return scene.entries.empty() ? scene.summary_revision : scene.entries.back().revision;
  }
  [[nodiscard]] std::size_t blobs() const { return blobs_.size(); }
  [[nodiscard]] std::uint64_t blob_bytes() const {
    std::uint64_t bytes = 0;
    for (const auto& [id, blob] : blobs_) bytes += blob.bytes.size();
    return bytes;
  }
  /// The record of an entry, to be damaged.
  scene::Bytes& record(const std::string& name, std::size_t entry) {
    return scenes_.at(name).scene.entries.at(entry).record;
  }

 private:
  struct Kept {
    scene::LoggedScene scene;
    std::vector<BlobId> summary_needs;
  };

  // The next two functions require that mutex_ is held.

  [[nodiscard]] bool are_there(const std::vector<BlobId>& needs) const {
    return std::ranges::all_of(needs, [&](const BlobId& id) { return blobs_.contains(id); });
  }
  void use(const BlobId& id, std::set<BlobId>& used) const {
    if (!used.insert(id).second) return;
    for (const BlobId& need : blobs_.at(id).needs) use(need, used);
  }

  std::mutex mutex_;
  std::map<std::string, Kept> scenes_;
  std::map<BlobId, scene::Blob> blobs_;
  std::map<std::string, std::string> notes_;
  std::string removals_;
  std::uint64_t highest_removed_ = 0;
};

}  // namespace camway::testing
