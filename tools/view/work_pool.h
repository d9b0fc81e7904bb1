// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace camway::view {

/// Threads that run jobs in the order in which they came. Who posts jobs limits their number.
/// Thread-safe.
class WorkPool {
 public:
  using Work = std::function<void()>;

  /// [Limit: 1 <= threads]
  explicit WorkPool(int threads);
  /// Drops the jobs that have not begun, and waits for the others.
  ~WorkPool();
  WorkPool(const WorkPool&) = delete;
  WorkPool& operator=(const WorkPool&) = delete;

  /// Queues a job, which must not throw. Drops it once `stop` was called.
  void post(Work work);
  /// Drops the jobs that have not begun, waits for the others, and ends the threads. Not for two
  /// threads at a time, and not for a job.
  void stop();

 private:
  void run();

  std::mutex mutex_;  ///< guards what is below but threads_
  std::condition_variable changed_;
  std::deque<Work> queue_;
  bool has_stopped_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace camway::view
