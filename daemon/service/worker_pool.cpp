// SPDX-License-Identifier: MIT
#include "daemon/service/worker_pool.h"

#include <iterator>
#include <utility>

namespace camway::service {

WorkerPool::WorkerPool(int workers, std::size_t queue_capacity)
    : workers_(workers), queue_capacity_(queue_capacity) {
  threads_.reserve(static_cast<std::size_t>(workers));
  for (int i = 0; i < workers; ++i) threads_.emplace_back([this] { work(); });
}

WorkerPool::~WorkerPool() { stop(); }

void WorkerPool::stop() {
  close();
  threads_.clear();
}

bool WorkerPool::try_submit(Job job) {
  {
    const std::lock_guard lock(mutex_);
    if (closed_ || queue_.size() >= queue_capacity_) return false;
    queue_.push_back(std::move(job));
  }
  changed_.notify_one();
  return true;
}

std::vector<WorkerPool::Job> WorkerPool::close() {
  std::vector<Job> left;
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    left.assign(std::make_move_iterator(queue_.begin()), std::make_move_iterator(queue_.end()));
    queue_.clear();
  }
  changed_.notify_all();
  return left;
}

bool WorkerPool::closed() const {
  const std::lock_guard lock(mutex_);
  return closed_;
}

std::size_t WorkerPool::queued() const {
  const std::lock_guard lock(mutex_);
  return queue_.size();
}

std::size_t WorkerPool::running() const {
  const std::lock_guard lock(mutex_);
  return running_;
}

void WorkerPool::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return closed_ || !queue_.empty(); });
    if (queue_.empty()) return;
    Job job = std::move(queue_.front());
    queue_.pop_front();
    ++running_;
    lock.unlock();
    job.run();
    job = {};
    lock.lock();
    --running_;
  }
}

}  // namespace camway::service
