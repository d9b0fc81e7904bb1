// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/fleet/fleet_messages.h"
#include "daemon/fleet/fleet_parts.h"
#include "daemon/fleet/job_table.h"
#include "daemon/fleet/subjects.h"
#include "daemon/nats/bus.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/service/log/limited_log.h"
#include "daemon/service/plans/plan_answerer.h"

namespace camway::fleet {

/// Configuration of a planner.
struct PlannerOptions {
  std::string fleet = "camway";  ///< name of the fleet [Limit: is_id(value)]
  std::string planner_id;        ///< no other process of the fleet has it [Limit: is_id(value)]
  std::string version;           ///< of this program, for people
  int workers = 1;               ///< slots: jobs that run at a time [Limit: 1 <= value]
  /// How long a job waits for a scene that is not there yet, or at an earlier revision.
  std::chrono::milliseconds patience_behind{100};
  std::chrono::milliseconds status_period{250};
  std::chrono::milliseconds progress_period{100};
};

/// Returns whether a planner of this id is alive, by listening for its statuses, two periods long.
/// Two of one id would both get each job of theirs.
bool is_planner_alive(nats::Bus& bus, const PlannerOptions& options);

/// Plans for the fronts of a fleet. Each slot is a thread. Answers are those of `answerer` on the
/// newest snapshot of the request's scene. A job that is sent again runs once, and is answered
/// again.
/// Thread-safe.
class PlannerServer {
 public:
  /// Returns the position in the log of scenes up to which this process has read. Called on any
  /// thread; must not throw.
  using Position = std::function<std::int64_t()>;

  /// The objects that a planner uses. All must outlive it.
  struct Parts {
    nats::Bus& bus;
    const scene::SceneStore& scenes;
    service::PlanAnswerer& answerer;
  };

  /// Takes jobs from then on. Fails if the bus takes no subscription, or for names that are none.
  static base::Result<std::unique_ptr<PlannerServer>> open(
      const Parts& parts, const PlannerOptions& options, Position position,
      const std::shared_ptr<service::Log>& log);
  /// Calls `stop` with no time left.
  ~PlannerServer();
  PlannerServer(const PlannerServer&) = delete;
  PlannerServer& operator=(const PlannerServer&) = delete;

  /// Tells the fronts at once that more of the log was read, instead of a little later.
  void position_changed();

  /// Takes no more jobs, and says so. Returns when all that run are answered. Those that still run
  /// at `limit` end without an answer; returns whether there was none.
  bool stop(std::chrono::milliseconds limit);

  [[nodiscard]] int running() const;
  [[nodiscard]] std::int64_t answered() const;

 private:
  using Clock = std::chrono::steady_clock;
  /// A job, and the request that its parts hold together.
  struct Task {
    std::shared_ptr<RunningJob> job;
    Bytes payload;
  };

  PlannerServer(const Parts& parts, const PlannerOptions& options, Position position,
                const std::shared_ptr<service::Log>& log);

  bool subscribe();
  void begin_threads();
  void on_job(std::span<const std::uint8_t> bytes);
  void plan(fleet_job_t job);
  void cancel(const fleet_job_t& job);
  void repeat(const JobTable::Key& key, bool is_first_part);

  void work();
  void run(const Task& task);
  [[nodiscard]] std::shared_ptr<const scene::Snapshot> snapshot_for(const std::string& scene,
                                                                    const RunningJob& job) const;
  [[nodiscard]] Bytes answer_to(const plan_request_t& request,
                                const std::shared_ptr<const scene::Snapshot>& snapshot,
                                const base::Deadline& deadline);
  void refuse(const RunningJob& job, std::int8_t why, std::int64_t revision);
  void finish(const RunningJob& job, Bytes answer);

  void send(const JobTable::Key& key, std::int8_t kind, std::span<const std::uint8_t> payload,
            std::int64_t revision = 0);
  void tell_fronts(const std::stop_token& stop);
  void publish_status();
  void publish_progress(const RunningJob& job);
  [[nodiscard]] std::vector<std::shared_ptr<RunningJob>> due_progress(Clock::time_point now);
  /// Returns the time of the next progress report. Requires that mutex_ is held.
  [[nodiscard]] Clock::time_point next_progress() const;
  void warn(std::string_view event, service::LogFields fields);

  const Parts parts_;
  const PlannerOptions options_;
  const Subjects subjects_;
  const Position position_;
  const std::string host_;
  const std::int64_t start_id_;

  mutable std::mutex mutex_;             ///< guards the members down to is_changed_
  std::condition_variable changed_;      ///< a task waits, a slot is free, or all ends
  std::condition_variable_any to_tell_;  ///< a status is due
  PartJoiner joiner_;
  JobTable jobs_;
  std::deque<Task> tasks_;
  std::int64_t answered_ = 0;
  bool is_leaving_ = false;
  bool has_ended_ = false;
  bool has_sent_all_ = false;  ///< no answer follows
  bool is_changed_ = false;    ///< whether the fronts do not know yet what has changed

  std::mutex log_mutex_;  ///< guards trouble_
  service::LimitedLog trouble_;

  std::mutex status_mutex_;  ///< guards serial_, and keeps statuses in order
  std::int64_t serial_ = 0;

  std::vector<std::jthread> workers_;
  std::jthread teller_;
  std::unique_ptr<nats::Subscription> subscription_;
};

}  // namespace camway::fleet
