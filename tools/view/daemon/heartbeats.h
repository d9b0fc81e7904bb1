// SPDX-License-Identifier: MIT
#pragma once

#include <camway/client.h>

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "tools/view/backend.h"

namespace camway::view {

/// Listens to the heartbeats of a daemon on a thread of its own: its status, and events when its
/// scenes change, when it falls silent, and when it is heard again. Thread-safe.
class Heartbeats {
 public:
  /// Keeps a reference to `client`.
  explicit Heartbeats(Client& client);
  ~Heartbeats();
  Heartbeats(const Heartbeats&) = delete;
  Heartbeats& operator=(const Heartbeats&) = delete;

  /// Returns the last heartbeat; nothing if the daemon is silent. Waits for the first one as long
  /// as a daemon may need to be heard.
  std::optional<DaemonStatus> wait();

  /// Returns whether the daemon is silent: whether none was heard for as long as one may be.
  [[nodiscard]] bool is_silent();

  /// Calls `told` when the daemon falls silent, and several times a second as long as it is, on a
  /// thread of its own, until this ends: a question may be on its way when the silence is noticed.
  /// It must neither throw nor wait nor call this object. Call this before anything else.
  void on_silence(std::function<void()> told);

  /// Tells of scenes and silence from now on, first of what is known.
  std::unique_ptr<Watch> watch(Tell event);

  /// Tells of the scenes, which this process has just changed.
  void scenes_changed(const std::vector<SceneInfo>& scenes);

  /// Lets waiting calls return.
  void stop();

 private:
  using Key = std::uint64_t;
  class Watcher;

  void listen();
  void heard(DaemonStatus status);
  void silent();
  /// Tells all who watch. Requires the lock.
  void tell(const std::string& event);
  [[nodiscard]] static std::string scenes_event(const std::vector<SceneInfo>& scenes);

  Client& client_;
  std::mutex mutex_;  ///< guards what is below; held while events are told
  std::condition_variable changed_;
  bool has_stopped_ = false;
  bool is_known_ = false;  ///< whether a daemon was heard, or had time to be
  std::optional<DaemonStatus> last_;
  std::chrono::steady_clock::time_point heard_at_ = std::chrono::steady_clock::now();
  std::map<Key, Tell> watchers_;
  Key last_key_ = 0;
  std::function<void()> on_silence_;
  std::jthread thread_;
};

}  // namespace camway::view
