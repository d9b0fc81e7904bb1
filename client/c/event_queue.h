// SPDX-License-Identifier: MIT
#pragma once

#include <camway/watch.h>

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>

#include "client/c/watch_event.h"

namespace camway::c {

/// Events of watched paths that a program takes one by one. Thread-safe.
class EventQueue {
 public:
  /// Events that are kept of a watch, as `camway_event_queue_next` says. An answer has tens of
  /// kilobytes, so a program that takes none has megabytes for each watch at most.
  static constexpr std::size_t kMostOfAWatch = 100;

  void put(const WatchEvent& event);

  /// Takes the oldest event, for which it waits at most `timeout_s`. Returns nothing if there is
  /// none. What the event points to is good until the next call.
  std::optional<camway_watch_event> next(double timeout_s);

 private:
  struct Backlog {
    std::size_t num_kept = 0;
    std::int64_t num_missed = 0;  ///< events that were dropped since the last one was taken
  };

  std::mutex mutex_;  ///< of all members
  std::condition_variable came_;
  std::deque<std::shared_ptr<const WatchEvent>> kept_;
  std::unordered_map<std::int64_t, Backlog> backlogs_;  ///< of watches with events in `kept_`
  std::unique_ptr<const WatchEventInC> taken_;
};

}  // namespace camway::c
