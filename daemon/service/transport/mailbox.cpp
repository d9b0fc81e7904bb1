// SPDX-License-Identifier: MIT
#include "daemon/service/transport/mailbox.h"

#include <utility>

namespace camway::service {

void Mailbox::post(Task task) {
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
  }
  transport_.wake();
}

void Mailbox::run_all() {
  std::vector<Task> tasks;
  {
    const std::lock_guard lock(mutex_);
    tasks.swap(tasks_);
  }
  for (const Task& task : tasks) task();
}

bool Mailbox::empty() const {
  const std::lock_guard lock(mutex_);
  return tasks_.empty();
}

}  // namespace camway::service
