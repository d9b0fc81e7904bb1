// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <mutex>
#include <vector>

#include "daemon/service/transport/transport.h"

namespace camway::service {

/// Tasks that other threads leave for the loop thread, run in the order of `post`.
class Mailbox {
 public:
  using Task = std::function<void()>;

  explicit Mailbox(Transport& transport) : transport_(transport) {}

  /// Adds a task and wakes the loop.
  /// Thread-safe.
  void post(Task task);

  /// Runs the tasks that are there. For the loop thread.
  void run_all();

  [[nodiscard]] bool empty() const;

 private:
  Transport& transport_;
  mutable std::mutex mutex_;  ///< guards tasks_
  std::vector<Task> tasks_;
};

}  // namespace camway::service
