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

/// A fixed number of threads and the queue that feeds them. All members may be called from any
/// thread. Jobs that leave the queue unrun are handed to the caller, who abandons them.
class WorkerPool {
 public:
  /// [Limit: 1 <= workers]
  WorkerPool(int workers, const FairQueue::Limits& limits);
  /// As `stop`.
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// Queues `job`. Hands back the job that is not run for want of room, this one or another, or
  /// this one if the pool is closed.
  [[nodiscard]] std::optional<FairQueue::Refused> submit(Job job);

  /// The jobs that expired before anybody began them, and when the next will.
  [[nodiscard]] std::vector<Job> take_expired(Job::Clock::time_point now);
  [[nodiscard]] Job::Clock::time_point next_expiry() const;

  /// As those of the queue.
  [[nodiscard]] std::optional<Job> take(const std::string& client, std::int64_t id);
  [[nodiscard]] std::optional<std::size_t> ahead_of(const std::string& client,
                                                    std::int64_t id) const;

  /// Lets no more jobs in and hands back those that nobody has begun.
  [[nodiscard]] std::vector<Job> close();

  /// Drops the jobs that nobody has begun, waits for the others and ends the threads. To be called
  /// before anything goes that a job uses. Not for two threads at a time.
  void stop();

  [[nodiscard]] std::size_t queued() const;
  [[nodiscard]] std::size_t running() const;
  /// How long the worker that is at one job for the longest has been; 0 if none is.
  [[nodiscard]] Job::Clock::duration longest_run(Job::Clock::time_point now) const;
  [[nodiscard]] int workers() const { return workers_; }

 private:
  void work();

  const int workers_;
  mutable std::mutex mutex_;  ///< guards everything below but threads_
  std::condition_variable changed_;
  FairQueue queue_;
  std::multiset<Job::Clock::time_point> begun_;  ///< when the jobs that run were begun
  bool closed_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace camway::service
