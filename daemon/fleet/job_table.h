// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "daemon/base/progress.h"
#include "daemon/fleet/fleet_messages.h"

namespace camway::fleet {

/// A job that a planner runs. The worker and the server share it.
struct RunningJob {
  using Clock = std::chrono::steady_clock;

  std::string front;
  std::int64_t number = 0;
  double deadline_s = 0.0;
  std::int64_t least_revision = 0;
  Clock::time_point received;
  Clock::time_point told;  ///< last message about it to the front
  std::stop_source stop;
  std::shared_ptr<base::Progress> progress = std::make_shared<base::Progress>();
};

/// The jobs that a planner runs, and those that it ended lately with their answers, so that a job
/// that comes twice runs once.
/// Not thread-safe.
class JobTable {
 public:
  using Clock = std::chrono::steady_clock;
  using Key = std::pair<std::string, std::int64_t>;
  using Answer = std::shared_ptr<const Bytes>;

  struct Limits {
    std::size_t answers = 512;                  ///< ended jobs that are remembered
    std::size_t bytes = std::size_t{64} << 20;  ///< of their answers
    std::chrono::seconds age{60};
  };

  JobTable() : JobTable(Limits{}) {}
  explicit JobTable(const Limits& limits) : limits_(limits) {}

  /// Returns whether the job is known: runs, or ended lately.
  [[nodiscard]] bool knows(const Key& key) const { return jobs_.contains(key); }
  /// Returns the job if it runs; else null.
  [[nodiscard]] std::shared_ptr<RunningJob> running(const Key& key) const;
  /// Returns the answer of a job that ended; null if it did not, or has none.
  [[nodiscard]] Answer answer(const Key& key) const;

  /// Requires a job that is not known.
  void begin(std::shared_ptr<RunningJob> job);
  /// Ends a job. `answer` is null for one that was cancelled: then it is known, without an answer.
  void end(const Key& key, Answer answer, Clock::time_point now);
  /// Forgets a job, so that it may be tried again.
  void forget(const Key& key);

  /// Returns all jobs that run.
  [[nodiscard]] std::vector<std::shared_ptr<RunningJob>> all_running() const;
  [[nodiscard]] std::size_t num_running() const { return jobs_.size() - by_age_.size(); }
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  struct Ended {
    Key key;
    Clock::time_point at;
  };
  struct Entry {
    std::shared_ptr<RunningJob> running;  ///< null when it has ended
    Answer answer;
  };

  const Limits limits_;
  std::map<Key, Entry> jobs_;
  std::list<Ended> by_age_;  ///< ended jobs, oldest first
  std::size_t bytes_ = 0;
};

}  // namespace camway::fleet
