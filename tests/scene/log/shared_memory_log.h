// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "daemon/scene/log/shared_log.h"
#include "tests/scene/log/memory_log.h"

namespace camway::testing {

/// The part of a log in memory that all its processes share.
struct SharedMemory {
  std::mutex mutex;  ///< guards all below but `log`
  std::condition_variable_any changed;
  MemoryLog log;
  std::vector<scene::LogUpdate> updates;
  std::map<std::string, std::uint64_t, std::less<>> positions;  ///< of the newest change of scenes
  std::uint64_t position = 0;

  void add(scene::LogUpdate::Kind kind, std::string_view name, scene::LogEntry entry) {
    updates.push_back({kind, std::string(name), std::move(entry), ++position});
    positions[std::string(name)] = position;
    changed.notify_all();
  }
};

/// What one process has of a log in memory. `stop_following` and `follow` may be called in turn.
class SharedMemoryLog final : public scene::SharedLog {
 public:
  explicit SharedMemoryLog(std::shared_ptr<SharedMemory> shared) : shared_(std::move(shared)) {}
  ~SharedMemoryLog() override { stop_following(); }

  scene::AppendResult put_blob(const scene::BlobId& id, const scene::Blob& blob) override {
    return shared_->log.put_blob(id, blob);
  }
  bool has_blob(const scene::BlobId& id) override { return shared_->log.has_blob(id); }
  base::Result<scene::Bytes> blob(const scene::BlobId& id) override {
    return shared_->log.blob(id);
  }
  scene::AppendResult append(std::string_view name, const scene::LogEntry& entry) override {
    const std::lock_guard lock(shared_->mutex);
    scene::AppendResult done = shared_->log.append(name, entry);
    if (done.error.empty()) shared_->add(scene::LogUpdate::Kind::kEntry, name, entry);
    return done;
  }
  scene::AppendResult summarize(std::string_view name, std::uint64_t revision,
                                const scene::Bytes& summary,
                                const std::vector<scene::BlobId>& needs) override {
    const std::lock_guard lock(shared_->mutex);
    if (shared_->log.head(name) != revision) {
      return {scene::AppendFault::kConflict, "it is not the newest revision"};
    }
    scene::AppendResult done = shared_->log.summarize(name, revision, summary, needs);
    if (!done.error.empty()) return done;
    std::erase_if(shared_->updates, [&](const auto& update) { return update.scene == name; });
    shared_->add(scene::LogUpdate::Kind::kSummary, name, {0, revision, summary, {}});
    return done;
  }
  scene::AppendResult drop(std::string_view name) override {
    const std::uint64_t revision = [&] {
      const std::lock_guard lock(shared_->mutex);
      return shared_->log.head(name);
    }();
    if (revision == 0) return {scene::AppendFault::kConflict, "there is no such scene"};
    return remove(name, revision, "");
  }
  scene::AppendResult remove(std::string_view name, std::uint64_t revision,
                             std::string_view request) override {
    const std::lock_guard lock(shared_->mutex);
    scene::AppendResult done = shared_->log.remove(name, revision, request);
    if (!done.error.empty()) return done;
    std::erase_if(shared_->updates, [&](const auto& update) { return update.scene == name; });
    const auto bytes = std::as_bytes(std::span<const char>(request.data(), request.size()));
    shared_->add(scene::LogUpdate::Kind::kRemoval, name,
                 {0, revision, {bytes.begin(), bytes.end()}, {}});
    return done;
  }
  std::uint64_t highest_removed() override { return shared_->log.highest_removed(); }
  std::vector<std::string> removals() override { return shared_->log.removals(); }
  base::Result<std::vector<scene::LoggedScene>> scenes() override {
    const std::lock_guard lock(shared_->mutex);
    followed_ = shared_->position;
    return shared_->log.scenes();
  }
  std::string note(std::string_view key) override { return shared_->log.note(key); }
  scene::AppendResult set_note(std::string_view key, std::string_view text) override {
    return shared_->log.set_note(key, text);
  }
  base::Result<std::map<std::string, std::string>> notes(std::string_view prefix) override {
    return shared_->log.notes(prefix);
  }
  bool catch_up(std::chrono::milliseconds patience) override {
    std::unique_lock lock(shared_->mutex);
    const std::uint64_t end = shared_->position;
    return shared_->changed.wait_for(lock, patience, [&] { return followed_ >= end; });
  }
  scene::AppendResult drop_unused_blobs() override { return {}; }

  void follow(Take take) override {
    thread_ = std::jthread([this, take = std::move(take)](const std::stop_token& stop) {
      std::unique_lock lock(shared_->mutex);
      while (shared_->changed.wait(lock, stop, [&] { return shared_->position > followed_; })) {
        const auto next =
            std::ranges::upper_bound(shared_->updates, followed_, {}, &scene::LogUpdate::position);
        if (next == shared_->updates.end()) {
          followed_ = shared_->position;
          shared_->changed.notify_all();
          continue;
        }
        const scene::LogUpdate update = *next;
        lock.unlock();
        take(update);
        lock.lock();
        followed_ = update.position;
        shared_->changed.notify_all();
      }
    });
  }
  void stop_following() override { thread_ = {}; }
  std::uint64_t followed() const override {
    const std::lock_guard lock(shared_->mutex);
    return followed_;
  }
  std::uint64_t position_of(std::string_view name) const override {
    const std::lock_guard lock(shared_->mutex);
    const auto found = shared_->positions.find(name);
    return found == shared_->positions.end() ? 0 : found->second;
  }
  bool is_in_touch() const override { return true; }

 private:
  std::shared_ptr<SharedMemory> shared_;
  std::uint64_t followed_ = 0;  ///< guarded by the mutex of the shared part
  std::jthread thread_;
};

}  // namespace camway::testing
