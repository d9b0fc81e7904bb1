// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace camway::service {

/// A fixed number of threads and a bounded queue of jobs, first come first served. All members may
/// be called from any thread.
class WorkerPool {
 public:
  struct Job {
    std::function<void()> run;      ///< by a worker; must not throw
    std::function<void()> abandon;  ///< instead of `run`, by whoever takes it out of the queue
  };

  /// [Limit: 1 <= workers, 1 <= queue_capacity]
  WorkerPool(int workers, std::size_t queue_capacity);
  /// As `stop`.
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// Queues `job`; false if the queue is full or closed.
  [[nodiscard]] bool try_submit(Job job);

  /// Lets no more jobs in and hands back those that nobody has begun.
  std::vector<Job> close();

  /// Drops the jobs that nobody has begun, waits for the others and ends the threads. To be called
  /// before anything goes that a job uses. Not for two threads at a time.
  void stop();

  [[nodiscard]] bool closed() const;
  [[nodiscard]] std::size_t queued() const;
  [[nodiscard]] std::size_t running() const;
  [[nodiscard]] int workers() const { return workers_; }

 private:
  void work();

  const int workers_;
  const std::size_t queue_capacity_;
  mutable std::mutex mutex_;  ///< guards everything below but threads_
  std::condition_variable changed_;
  std::deque<Job> queue_;
  std::size_t running_ = 0;
  bool closed_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace camway::service
