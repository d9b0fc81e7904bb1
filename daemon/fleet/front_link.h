// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "daemon/fleet/answer_comparer.h"
#include "daemon/fleet/fleet_messages.h"
#include "daemon/fleet/fleet_news.h"
#include "daemon/fleet/fleet_parts.h"
#include "daemon/fleet/planner_board.h"
#include "daemon/fleet/subjects.h"
#include "daemon/nats/bus.h"
#include "daemon/service/log/limited_log.h"

namespace camway::fleet {

/// Counts of a front since its start.
struct FrontCounts {
  std::int64_t jobs_sent_again = 0;
  std::int64_t differing_answers = 0;
  std::int64_t planned_here = 0;
};

/// A message of a planner about a job, with the payload of all its parts.
struct JobEvent {
  std::string planner;
  std::int8_t kind = 0;  ///< as of `fleet_answer_t`
  Bytes payload;
};

/// The messages of planners about one job. The bus fills it, and the thread that waits for the job
/// empties it. Thread-safe.
class JobInbox {
 public:
  /// Messages beyond this number are dropped; a planner sends few.
  static constexpr std::size_t kMostEvents = 256;

  void put(JobEvent event);
  std::optional<JobEvent> take();
  /// Waits for a message, but for `longest` at most.
  void wait(std::chrono::milliseconds longest);

 private:
  std::mutex mutex_;  ///< guards events_
  std::condition_variable changed_;
  std::deque<JobEvent> events_;
};

/// A front's side of the bus: sends jobs, and hands what planners say to the jobs and the board.
/// Compares answers that come when another planner has answered already.
/// Thread-safe.
class FrontLink {
 public:
  /// `bus` and `board` must outlive it. Requires `is_id` of both names.
  FrontLink(nats::Bus& bus, PlannerBoard& board, Subjects subjects, std::string front_id,
            const std::shared_ptr<service::Log>& log);

  /// Subscribes. Returns false if the bus refuses; then nothing arrives.
  bool open();

  struct Job {
    std::int64_t number = 0;
    std::shared_ptr<JobInbox> inbox;
  };
  /// Begins a job, with a number that no other job has.
  Job begin();
  /// Ends a job. `mark`: of the answer that was given, if another planner may still give one.
  void end(const Job& job, std::optional<AnswerMark> mark);

  /// Sends a job to a planner. Returns false if the bus did not take it.
  bool send(const std::string& planner, const fleet_job_t& head,
            std::span<const std::uint8_t> payload);

  void count_sent_again();
  void count_planned_here();
  [[nodiscard]] FrontCounts counts() const;

  /// Claims the front's id. Returns false if another front has it; takes some tenths of a second.
  /// Two of one id would take each other's answers, and remove each other's scenes.
  ///
  /// A front listens twice: before it says that it is alive, and while it does. Of two that are
  /// started at once, each hears the other one the second time. One whose claim is settled keeps
  /// the id; else the one with the lower start number gives way. Requires that `say_alive` is
  /// called several times a second meanwhile.
  bool claim_id();
  /// Leaves the id to others.
  void leave_id() { claim_.store(Claim::kNone); }
  /// Tells others of its id that this front is alive, while it claims the id.
  void say_alive();

  /// Logs trouble with a planner. Limited, since planners can provoke it.
  void warn(std::string_view event, service::LogFields fields);
  /// Logs that a planner is lost to a request, unless that is no news (`FleetNews`), or the
  /// connection is lost, which is logged.
  void planner_lost(PlannerLoss::Reason reason, const std::string& planner,
                    const plan_request_t& request);
  /// Takes in that the connection was lost or made again.
  void connection_changed(bool is_connected);
  /// Logs what is due. To be called several times a second.
  void tick();

 private:
  /// How far the claim of the id is.
  enum class Claim : std::uint8_t { kNone, kTrying, kSettled };
  bool is_id_taken();

  void raise_alarm(const AnswerMark& given, const AnswerMark& other);
  void on_answer(std::span<const std::uint8_t> bytes);
  void on_status(std::span<const std::uint8_t> bytes);
  /// Warns once of each start of a planner that gets no jobs because of its version.
  void warn_of_version(const planner_status_t& status);
  void take_late(std::int64_t job, const std::string& planner,
                 std::span<const std::uint8_t> payload);

  nats::Bus& bus_;
  PlannerBoard& board_;
  const Subjects subjects_;
  const std::string front_id_;
  const std::uint64_t start_number_;  ///< random
  std::atomic<Claim> claim_ = Claim::kNone;

  mutable std::mutex mutex_;  ///< guards the members down to warned_of_version_
  std::int64_t next_job_;
  std::map<std::int64_t, std::shared_ptr<JobInbox>> inboxes_;
  PartJoiner joiner_;
  AnswerMemory memory_;
  std::set<PlannerBoard::Planner> warned_of_version_;

  mutable std::mutex log_mutex_;  ///< guards the members down to counts_
  service::LimitedLog trouble_;
  service::LimitedLog alarms_;
  FleetNews news_;
  FrontCounts counts_;

  // Last: their handlers use all above.
  std::unique_ptr<nats::Subscription> answers_;
  std::unique_ptr<nats::Subscription> statuses_;
};

}  // namespace camway::fleet
