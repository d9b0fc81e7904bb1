// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "daemon/scene/log/scene_log.h"

namespace camway::scene {

/// A change that a process reads in a log which several processes write.
struct LogUpdate {
  enum class Kind : std::uint8_t {
    kEntry,    ///< `entry` was appended
    kSummary,  ///< `entry.record` is a summary up to `entry.revision`; the rest of it is empty
    kRemoval   ///< the scene was removed at `entry.revision`; `entry.record` is a text of
               ///< requests (`removal_requests.h`), the rest of it is empty
  };
  Kind kind = Kind::kEntry;
  std::string scene;
  LogEntry entry;
  std::uint64_t position = 0;  ///< in the log; rises from one update to the next
};

/// A log that several processes write and follow. An append of one of them fails with `kConflict`
/// if another one was sooner; once `follow` has brought that other change, it can be tried again.
/// Thread-safe.
class SharedLog : public SceneLog {
 public:
  /// Must not throw. Returns when the update has taken effect.
  using Take = std::function<void(const LogUpdate&)>;

  /// Calls `take` on a thread of its own, in order, for each update after those that `scenes`
  /// returned, the own ones included. Updates that `take` has seen may come again, after the
  /// connection was lost. Entries that a summary has replaced do not come: then the summary comes,
  /// with a revision higher than the newest one that `take` has seen. Requires a call of `scenes`
  /// before, and to be called once.
  virtual void follow(Take take) = 0;
  /// Ends that thread. `take` does not run any more when this has returned.
  virtual void stop_following() = 0;

  /// Removes a scene, whatever is left of it, without reading its contents. Fails with `kConflict`
  /// if there is none. To be called before `scenes`.
  virtual AppendResult drop(std::string_view scene) = 0;

  /// The position up to which this process has read the log: of the last update for which `take`
  /// has returned, or of those that `scenes` returned.
  [[nodiscard]] virtual std::uint64_t followed() const = 0;
  /// The position of the newest change of a scene that this process has made or read; 0 if none.
  [[nodiscard]] virtual std::uint64_t position_of(std::string_view scene) const = 0;
  /// Whether the log can be reached, and all of it was read when it was last asked.
  [[nodiscard]] virtual bool is_in_touch() const = 0;
};

}  // namespace camway::scene
