// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <mutex>
#include <vector>

#include "daemon/service/transport/transport.h"

namespace camway::service {

/// A queue of tasks that other threads leave for the loop thread. Tasks run in the order of `post`.
class Mailbox {
 public:
  using Task = std::function<void()>;

  /// Requires that `transport` outlives this object.
  explicit Mailbox(Transport& transport) : transport_(transport) {}

  /// Adds a task and wakes the loop. The task must not throw: the tasks after it would be lost.
  /// Thread-safe.
  void post(Task task);

  /// Runs all tasks that were posted before the call. Tasks that are posted meanwhile run at the
  /// next call. Not thread-safe: for the loop thread.
  void run_all();

  /// Returns whether no task waits.
  /// Thread-safe.
  [[nodiscard]] bool empty() const;

 private:
  Transport& transport_;
  mutable std::mutex mutex_;  ///< guards tasks_
  std::vector<Task> tasks_;
};

}  // namespace camway::service
