// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <mutex>
#include <vector>

#include "daemon/service/transport/transport.h"

namespace camway::service {

/// Work that any thread leaves for the loop thread, done in the order in which it was left.
class Mailbox {
 public:
  using Task = std::function<void()>;

  explicit Mailbox(Transport& transport) : transport_(transport) {}

  /// From any thread. Wakes the loop.
  void post(Task task);

  /// From the loop thread: does what was left so far.
  void run_all();

  [[nodiscard]] bool empty() const;

 private:
  Transport& transport_;
  mutable std::mutex mutex_;  ///< guards tasks_
  std::vector<Task> tasks_;
};

}  // namespace camway::service
