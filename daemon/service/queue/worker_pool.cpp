// SPDX-License-Identifier: MIT
#include "daemon/service/queue/worker_pool.h"

#include <algorithm>
#include <utility>

namespace camway::service {

WorkerPool::WorkerPool(int workers, const FairQueue::Limits& limits)
    : workers_(workers), queue_(limits), allowed_(static_cast<std::size_t>(workers)) {
  threads_.reserve(static_cast<std::size_t>(workers));
  try {
    for (int i = 0; i < workers; ++i) threads_.emplace_back([this] { work(); });
  } catch (...) {
    stop();  // the threads wait for it, and the destructor does not run
    throw;
  }
}

WorkerPool::~WorkerPool() { stop(); }

void WorkerPool::stop() {
  const std::vector<Job> dropped = close();
  threads_.clear();
}

std::optional<FairQueue::Refused> WorkerPool::submit(Job job) {
  std::optional<FairQueue::Refused> refused;
  {
    const std::lock_guard lock(mutex_);
    if (closed_) return FairQueue::Refused{std::move(job), Refusal::kStopping};
    refused = queue_.push(std::move(job));
  }
  changed_.notify_one();
  return refused;
}

std::vector<Job> WorkerPool::take_expired(Job::Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  return queue_.take_expired(now);
}

Job::Clock::time_point WorkerPool::next_expiry() const {
  const std::lock_guard lock(mutex_);
  return queue_.next_expiry();
}

std::optional<Job> WorkerPool::take(const std::string& client, std::int64_t id) {
  const std::lock_guard lock(mutex_);
  return queue_.take(client, id);
}

std::optional<std::size_t> WorkerPool::ahead_of(const std::string& client, std::int64_t id) const {
  const std::lock_guard lock(mutex_);
  return queue_.ahead_of(client, id);
}

std::vector<Job> WorkerPool::close() {
  std::vector<Job> left;
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    left = queue_.take_all();
  }
  changed_.notify_all();
  return left;
}

void WorkerPool::allow(int running) {
  {
    const std::lock_guard lock(mutex_);
    allowed_ = static_cast<std::size_t>(std::clamp(running, 1, workers_));
  }
  changed_.notify_all();
}

int WorkerPool::allowed() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(allowed_);
}

std::size_t WorkerPool::queued() const {
  const std::lock_guard lock(mutex_);
  return queue_.size();
}

std::size_t WorkerPool::running() const {
  const std::lock_guard lock(mutex_);
  return begun_.size();
}

Job::Clock::duration WorkerPool::longest_run(Job::Clock::time_point now) const {
  const std::lock_guard lock(mutex_);
  return begun_.empty() ? Job::Clock::duration::zero() : now - *begun_.begin();
}

void WorkerPool::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return closed_ || may_begin(); });
    if (queue_.empty()) return;
    FairQueue::Begun begun = queue_.pop();
    // The end of a job may permit two others: the next of its strand, and one of its client.
    const Job::Clock::time_point start = Job::Clock::now();
    const auto mark = begun_.insert(start);
    if (may_begin()) changed_.notify_one();
    lock.unlock();
    begun.job.run();
    const Job::Clock::duration took = Job::Clock::now() - start;
    begun.job.run = nullptr;  // destroyed outside the lock
    begun.job.abandon = nullptr;
    lock.lock();
    queue_.finish(begun, took);
    begun_.erase(mark);
  }
}

}  // namespace camway::service
