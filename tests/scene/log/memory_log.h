// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cassert>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <utility>

#include "daemon/scene/log/scene_log.h"

namespace camway::testing {

/// A log without a disk, with faults on demand.
class MemoryLog : public scene::SceneLog {
 public:
  /// Next calls of `append` and `put_blob` fail so while it is set.
  scene::AppendFault fault = scene::AppendFault::kNone;

  scene::AppendResult put_blob(const scene::BlobId& id, const scene::Blob& blob) override {
    const std::lock_guard lock(mutex_);
    if (fault != scene::AppendFault::kNone) return {fault, "no disk"};
    for (const scene::BlobId& needed : blob.needs) assert(blobs_.contains(needed));
    blobs_.insert_or_assign(id, blob);
    return {};
  }
  bool has_blob(const scene::BlobId& id) override {
    const std::lock_guard lock(mutex_);
    return blobs_.contains(id);
  }
  base::Result<scene::Bytes> blob(const scene::BlobId& id) override {
    const std::lock_guard lock(mutex_);
    const auto found = blobs_.find(id);
    if (found == blobs_.end()) return base::Failure{"there is no such blob"};
    return found->second.bytes;
  }

  scene::AppendResult append(std::string_view scene, const scene::LogEntry& entry) override {
    const std::lock_guard lock(mutex_);
    if (fault != scene::AppendFault::kNone) return {fault, "no disk"};
    scene::LoggedScene& logged = scenes_[std::string(scene)];
    logged.name = scene;
    if (newest(logged) != entry.before) return {scene::AppendFault::kConflict, "another revision"};
    for (const scene::BlobId& needed : entry.needs) assert(blobs_.contains(needed));
    logged.entries.push_back(entry);
    return {};
  }
  scene::AppendResult summarize(std::string_view scene, std::uint64_t revision,
                                const scene::Bytes& summary,
                                const std::vector<scene::BlobId>& needs) override {
    const std::lock_guard lock(mutex_);
    scene::LoggedScene& logged = scenes_.find(scene)->second;
    std::erase_if(logged.entries, [&](const auto& entry) { return entry.revision <= revision; });
    logged.summary_revision = revision;
    logged.summary = summary;
    summary_needs_[std::string(scene)] = needs;
    return {};
  }
  scene::AppendResult remove(std::string_view scene, std::uint64_t revision) override {
    const std::lock_guard lock(mutex_);
    const auto found = scenes_.find(scene);
    if (found == scenes_.end() || newest(found->second) != revision) {
      return {scene::AppendFault::kConflict, "another revision"};
    }
    scenes_.erase(found);
    summary_needs_.erase(std::string(scene));
    highest_removed_ = std::max(highest_removed_, revision);
    return {};
  }
  std::uint64_t highest_removed() override { return highest_removed_; }

  base::Result<std::vector<scene::LoggedScene>> scenes() override {
    const std::lock_guard lock(mutex_);
    std::vector<scene::LoggedScene> all;
    for (const auto& [name, logged] : scenes_) all.push_back(logged);
    return all;
  }

  std::string note(std::string_view key) override { return notes_[std::string(key)]; }
  scene::AppendResult set_note(std::string_view key, std::string_view text) override {
    notes_[std::string(key)] = text;
    return {};
  }

  scene::AppendResult drop_unused_blobs() override {
    const std::lock_guard lock(mutex_);
    std::set<scene::BlobId> used;
    for (const auto& [name, needs] : summary_needs_) used.insert(needs.begin(), needs.end());
    for (const auto& [name, logged] : scenes_) {
      for (const scene::LogEntry& entry : logged.entries) {
        used.insert(entry.needs.begin(), entry.needs.end());
      }
    }
    std::vector<scene::BlobId> waiting(used.begin(), used.end());
    while (!waiting.empty()) {
      const scene::BlobId id = waiting.back();
      waiting.pop_back();
      for (const scene::BlobId& needed : blobs_.at(id).needs) {
        if (used.insert(needed).second) waiting.push_back(needed);
      }
    }
    std::erase_if(blobs_, [&](const auto& blob) { return !used.contains(blob.first); });
    return {};
  }

  [[nodiscard]] std::size_t blobs() const { return blobs_.size(); }
  [[nodiscard]] std::uint64_t blob_bytes() const {
    std::uint64_t bytes = 0;
    for (const auto& [id, blob] : blobs_) bytes += blob.bytes.size();
    return bytes;
  }
  /// The record of an entry, to be damaged.
  scene::Bytes& record(const std::string& scene, std::size_t entry) {
    return scenes_.at(scene).entries.at(entry).record;
  }

 private:
  static std::uint64_t newest(const scene::LoggedScene& logged) {
    return logged.entries.empty() ? logged.summary_revision : logged.entries.back().revision;
  }

  std::mutex mutex_;
  std::map<std::string, scene::LoggedScene, std::less<>> scenes_;
  std::map<std::string, std::vector<scene::BlobId>> summary_needs_;
  std::map<scene::BlobId, scene::Blob> blobs_;
  std::map<std::string, std::string> notes_;
  std::uint64_t highest_removed_ = 0;
};

}  // namespace camway::testing
