// SPDX-License-Identifier: MIT
#include "tools/view/work_pool.h"

#include <utility>

namespace camway::view {

WorkPool::WorkPool(int threads) {
  try {
    for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { run(); });
  } catch (...) {
    stop();  // the threads wait for it, and the destructor does not run
    throw;
  }
}

WorkPool::~WorkPool() { stop(); }

void WorkPool::post(Work work) {
  {
    const std::lock_guard lock(mutex_);
    if (has_stopped_) return;
    queue_.push_back(std::move(work));
  }
  changed_.notify_one();
}

void WorkPool::stop() {
  std::deque<Work> dropped;  // destroyed without the lock, since jobs may own anything
  {
    const std::lock_guard lock(mutex_);
    has_stopped_ = true;
    dropped.swap(queue_);
  }
  changed_.notify_all();
  threads_.clear();
}

void WorkPool::run() {
  for (;;) {
    Work work;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return has_stopped_ || !queue_.empty(); });
      if (has_stopped_) return;
      work = std::move(queue_.front());
      queue_.pop_front();
    }
    work();
  }
}

}  // namespace camway::view
