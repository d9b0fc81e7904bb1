// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "daemon/fleet/remote_answerer.h"

namespace camway::fleet {

/// One request of a front on its way through the planners. Used by one thread.
class RemoteJob {
 public:
  /// The arguments must outlive it.
  RemoteJob(RemoteAnswerer& front, const std::shared_ptr<const scene::Snapshot>& snapshot,
            const plan_request_t& request, const base::Deadline& deadline);
  ~RemoteJob();
  RemoteJob(const RemoteJob&) = delete;
  RemoteJob& operator=(const RemoteJob&) = delete;

  /// Returns the answer; see `RemoteAnswerer::answer`.
  service::Answered run();

 private:
  using Clock = std::chrono::steady_clock;

  std::optional<service::Answered> take_messages();
  std::optional<service::Answered> take(const JobEvent& event);
  std::optional<service::Answered> take_answer(const JobEvent& event);
  void take_progress(const JobEvent& event);
  void take_refusal(const JobEvent& event);
  /// Returns the answer with its paths for watching; or why the front must not give it.
  base::Result<service::Answered> checked(const JobEvent& event) const;

  /// Looks for a planner, or plans here.
  std::optional<service::Answered> look_for_planner();
  std::optional<service::Answered> plan_here();
  void ask(const PlannerBoard::Planner& planner);
  bool send();
  void count_sent_again();
  /// Looks whether the planner that has the job still works at it.
  void look_after_planner();
  void lose_planner(PlannerLoss::Reason why);
  void leave_planner(PlannerBoard::Return why);

  [[nodiscard]] bool is_of_planner(const JobEvent& event) const {
    return planner_ && planner_->id == event.planner;
  }
  [[nodiscard]] bool is_time_up() const;
  service::Answered cancelled();
  [[nodiscard]] service::Answered plain(std::int32_t status, std::string_view message) const;
  service::Answered given(service::Answered answered, const std::string& planner);

  RemoteAnswerer& front_;
  FrontLink& link_;
  PlannerBoard& board_;
  const std::shared_ptr<const scene::Snapshot>& snapshot_;
  const plan_request_t& request_;
  const base::Deadline& deadline_;
  const double deadline_s_;  ///< what was left of the deadline at the begin
  const Clock::time_point ends_;
  const std::int64_t position_;  ///< of the log, which a planner must have read
  const FrontLink::Job job_;
  Bytes payload_;  ///< encoded request; empty until it is sent

  std::optional<PlannerBoard::Planner> planner_;  ///< has the job now
  std::set<std::string> asked_;                   ///< all planners that were sent the job
  std::set<PlannerBoard::Planner> avoided_;       ///< planners that cannot, or do not, answer it
  std::optional<Clock::time_point> behind_since_;
  std::optional<Clock::time_point> ended_since_;  ///< when the planner was first seen to have ended
  Clock::time_point heard_;                       ///< last word of the planner about the job
  int repeats_ = 0;                               ///< how often the job was sent again since
  bool has_lost_one_ = false;
  bool is_counted_ = false;         ///< whether it was counted as sent again
  std::optional<AnswerMark> mark_;  ///< of the answer, if another one may follow
};

}  // namespace camway::fleet
