// SPDX-License-Identifier: MIT
#include "daemon/fleet/job_table.h"

namespace camway::fleet {

std::shared_ptr<RunningJob> JobTable::running(const Key& key) const {
  const auto found = jobs_.find(key);
  return found == jobs_.end() ? nullptr : found->second.running;
}

JobTable::Answer JobTable::answer(const Key& key) const {
  const auto found = jobs_.find(key);
  return found == jobs_.end() ? nullptr : found->second.answer;
}

void JobTable::begin(std::shared_ptr<RunningJob> job) {
  const Key key{job->front, job->number};
  jobs_[key].running = std::move(job);
}

void JobTable::end(const Key& key, Answer answer, Clock::time_point now) {
  const auto found = jobs_.find(key);
  if (found == jobs_.end()) return;
  found->second.running.reset();
  if (answer) bytes_ += answer->size();
  found->second.answer = std::move(answer);
  by_age_.push_back({key, now});
  while (!by_age_.empty() && (by_age_.size() > limits_.answers || bytes_ > limits_.bytes ||
                              now - by_age_.front().at >= limits_.age)) {
    const auto oldest = jobs_.find(by_age_.front().key);
    if (oldest->second.answer) bytes_ -= oldest->second.answer->size();
    jobs_.erase(oldest);
    by_age_.pop_front();
  }
}

void JobTable::forget(const Key& key) {
  const auto found = jobs_.find(key);
  if (found != jobs_.end() && found->second.running) jobs_.erase(found);
}

std::vector<std::shared_ptr<RunningJob>> JobTable::all_running() const {
  std::vector<std::shared_ptr<RunningJob>> jobs;
  for (const auto& [key, entry] : jobs_) {
    if (entry.running) jobs.push_back(entry.running);
  }
  return jobs;
}

}  // namespace camway::fleet
