// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "tools/view/backend.h"

namespace camway::view {

/// The requests under way over HTTP: counted, and cancelled when the door closes. Kept by what is
/// under way. Thread-safe.
class HttpJobs {
 public:
  using Ticket = std::uint64_t;

  explicit HttpJobs(int most) : most_(most) {}

  /// Takes a place. Returns 0 if there is none, or if the door closes.
  Ticket enter() {
    const std::lock_guard lock(mutex_);
    if (has_closed_ || jobs_.size() >= static_cast<std::size_t>(most_)) return 0;
    jobs_[++last_] = nullptr;
    return last_;
  }
  /// Keeps the job to be cancelled, unless it has ended.
  void set(Ticket ticket, std::shared_ptr<Job> job) {
    const std::lock_guard lock(mutex_);
    const auto found = jobs_.find(ticket);
    if (found == jobs_.end()) return;
    if (has_closed_ && job) job->cancel();
    found->second = std::move(job);
  }
  void leave(Ticket ticket) {
    std::shared_ptr<Job> ended;  // destroyed without the lock
    const std::lock_guard lock(mutex_);
    const auto found = jobs_.find(ticket);
    if (found == jobs_.end()) return;
    ended = std::move(found->second);
    jobs_.erase(found);
  }
  void close() {
    std::map<Ticket, std::shared_ptr<Job>> jobs;
    {
      const std::lock_guard lock(mutex_);
      has_closed_ = true;
      jobs = jobs_;
    }
    for (const auto& [ticket, job] : jobs) {
      if (job) job->cancel();
    }
  }

 private:
  const int most_;
  std::mutex mutex_;  ///< guards what is below
  std::map<Ticket, std::shared_ptr<Job>> jobs_;
  Ticket last_ = 0;
  bool has_closed_ = false;
};

}  // namespace camway::view
