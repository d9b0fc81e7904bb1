// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "daemon/nats/connection.h"
#include "daemon/scene/log/nats/nats_log.h"
#include "tests/integration/process.h"
#include "tests/scene/log/log_samples.h"
#include "tests/support/nats_server.h"

namespace camway::scene {

/// The log as one process of a fleet has it, with what it would make of the updates.
class FleetLog {
 public:
  explicit FleetLog(const std::vector<std::string>& urls, NatsLogOptions options = {}) {
    nats::ConnectOptions connect;
    connect.servers = urls;
    auto connection = nats::Connection::open(connect);
    if (!connection) throw std::runtime_error(connection.error);
    connection_ = *std::move(connection);
    options.warn = [this](const std::string& sentence) {
      const std::lock_guard lock(mutex_);
      warnings_ += sentence + "\n";
    };
    auto log = NatsLog::open(*connection_, options);
    if (!log) throw std::runtime_error(log.error);
    log_ = *std::move(log);
    const auto scenes = log_->scenes();
    EXPECT_TRUE(scenes) << scenes.error;
    if (!scenes) return;
    for (const LoggedScene& scene : *scenes) {
      if (scene.summary_revision > 0) {
        take({LogUpdate::Kind::kSummary,
              scene.name,
              {0, scene.summary_revision, scene.summary, {}},
              0});
      }
      for (const LogEntry& entry : scene.entries) {
        take({LogUpdate::Kind::kEntry, scene.name, entry, 0});
      }
    }
  }
  ~FleetLog() { log_.reset(); }

  NatsLog* operator->() const { return log_.get(); }
  NatsLog& operator*() const { return *log_; }
  nats::Connection& connection() { return *connection_; }

  void follow() {
    log_->follow([this](const LogUpdate& update) { take(update); });
  }

  /// The revision of a scene, as this process knows it.
  std::uint64_t revision(const std::string& scene) {
    const std::lock_guard lock(mutex_);
    return revisions_[scene];
  }
  /// All updates that changed something, in order: "office 3: text".
  std::vector<std::string> seen() {
    const std::lock_guard lock(mutex_);
    return seen_;
  }
  bool has_seen(const std::string& update) {
    const std::vector<std::string> all = seen();
    return std::ranges::find(all, update) != all.end();
  }
  /// What must not happen, such as a change that does not follow the one before.
  std::string faults() {
    const std::lock_guard lock(mutex_);
    return faults_;
  }
  std::string warnings() {
    const std::lock_guard lock(mutex_);
    return warnings_;
  }

  /// Appends one entry, whose text is `text`, to the newest revision. Tries again after a conflict.
  AppendResult append(const std::string& scene, const std::string& text,
                      std::vector<BlobId> needs = {}) {
    for (;;) {
      const std::uint64_t before = revision(scene);
      AppendResult result = log_->append(scene, sample_entry(before, before + 1, text, needs));
      if (result.fault != AppendFault::kConflict) {
        // As a store does, when the log has accepted the change.
        if (result.fault == AppendFault::kNone) {
          integration::eventually([&] { return revision(scene) > before; });
        }
        return result;
      }
      integration::eventually([&] { return revision(scene) != before; });
    }
  }

 private:
  void take(const LogUpdate& update) {
    const std::lock_guard lock(mutex_);
    std::uint64_t& revision = revisions_[update.scene];
    const std::string text = update.scene + " " + std::to_string(update.entry.revision) + ": " +
                             log_text(update.entry.record);
    if (update.kind == LogUpdate::Kind::kRemoval) {
      if (revision > 0) seen_.push_back(update.scene + " removed");
      revision = 0;
      return;
    }
    if (update.entry.revision <= revision) return;
    if (update.kind == LogUpdate::Kind::kEntry && update.entry.before != revision) {
      faults_ += text + " does not follow revision " + std::to_string(revision) + "\n";
    }
    seen_.push_back(text);
    revision = update.entry.revision;
  }

  std::mutex mutex_;
  std::map<std::string, std::uint64_t> revisions_;
  std::vector<std::string> seen_;
  std::string faults_;
  std::string warnings_;
  std::unique_ptr<nats::Connection> connection_;
  std::unique_ptr<NatsLog> log_;
};

/// What a process that starts now finds.
inline std::string text_of_log(const std::vector<std::string>& urls, NatsLogOptions options = {}) {
  const FleetLog log(urls, std::move(options));
  const auto scenes = log->scenes();
  return scenes ? text_of_scenes(*scenes) : scenes.error;
}

}  // namespace camway::scene
