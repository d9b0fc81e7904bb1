// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "daemon/service/queue/fair_queue.h"

namespace camway::service {

/// A fixed number of threads and the queue that feeds them. Fewer jobs than threads run at a time
/// if `allow` says so: then the threads only wait, as for other processes that do the work. Jobs
/// that leave the queue without being run are returned to the caller, who abandons them.
/// Thread-safe.
class WorkerPool {
 public:
  /// [Limit: 1 <= workers]
  WorkerPool(int workers, const FairQueue::Limits& limits);
  /// Calls `stop`.
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// Queues `job`. Returns the job for which there is no room: this one or another. If the pool is
  /// closed, returns this one.
  [[nodiscard]] std::optional<FairQueue::Refused> submit(Job job);

  /// See `FairQueue`.
  [[nodiscard]] std::vector<Job> take_expired(Job::Clock::time_point now);
  [[nodiscard]] Job::Clock::time_point next_expiry() const;

  /// See `FairQueue`.
  [[nodiscard]] std::optional<Job> take(const std::string& client, std::int64_t id);
  [[nodiscard]] std::optional<std::size_t> ahead_of(const std::string& client,
                                                    std::int64_t id) const;

  /// Accepts no more jobs and returns those that have not begun.
  [[nodiscard]] std::vector<Job> close();

  /// Drops the jobs that have not begun, waits for the others and ends the threads. To be called
  /// before anything is destroyed that a job uses. Not for two threads at a time.
  void stop();

  /// Sets how many jobs may run at a time from now on; jobs that run go on. At first, all threads
  /// may. Values outside of the limits are cut to them. [Limit: 1 <= running <= workers()]
  void allow(int running);
  [[nodiscard]] int allowed() const;

  [[nodiscard]] std::size_t queued() const;
  [[nodiscard]] std::size_t running() const;
  /// Returns the longest time that a worker has been at its present job; 0 if all are idle.
  [[nodiscard]] Job::Clock::duration longest_run(Job::Clock::time_point now) const;
  [[nodiscard]] int workers() const { return workers_; }

 private:
  void work();
  /// Whether a thread may begin a job now. Requires the lock.
  [[nodiscard]] bool may_begin() const { return begun_.size() < allowed_ && queue_.can_begin(); }

  const int workers_;
  mutable std::mutex mutex_;  ///< guards everything below but threads_
  std::condition_variable changed_;
  FairQueue queue_;
  std::multiset<Job::Clock::time_point> begun_;  ///< start times of the running jobs
  std::size_t allowed_;
  bool closed_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace camway::service
