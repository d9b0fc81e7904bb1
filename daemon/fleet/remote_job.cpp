// SPDX-License-Identifier: MIT
#include "daemon/fleet/remote_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include <camway/plan_progress_t.hpp>

#include "daemon/messages/plan.h"
#include "daemon/messages/progress.h"
#include "daemon/planning/watched_path.h"
#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/path_fault.h"

namespace camway::fleet {
namespace {

/// How often a job looks for what no message tells: cancels, lost planners, the time.
constexpr std::chrono::milliseconds kLook{10};
/// How often a job is sent again to a planner that says nothing of it, before it counts as lost.
constexpr int kMostRepeats = 3;

/// How long the answer of a planner that has ended is waited for: it came by another subscription
/// than the word that the planner has ended, and may be long.
constexpr std::chrono::milliseconds kLastAnswerWait{500};

using service::Answered;

std::shared_ptr<const planning::WatchedPath> shared_path(
    std::optional<planning::WatchedPath> path) {
  return path ? std::make_shared<const planning::WatchedPath>(std::move(*path)) : nullptr;
}

/// Adds the paths for watching as `service::answer_of` does. Returns why that is not possible.
std::string add_paths(const plan_request_t& request, const messages::DeadlineLimits& limits,
                      Answered& answered) {
  const base::Result<planning::PlanRequest> converted = messages::from_wire(request, limits);
  if (!converted) return answered.wire.certified != 0 ? converted.error : std::string();
  const base::Result<planning::PlanResult> result =
      messages::watched_part_of(answered.wire, converted->keyframes.size());
  if (!result) return result.error;
  answered.path = shared_path(planning::WatchedPath::of(*converted, *result));
  answered.interpolated = shared_path(planning::WatchedPath::as_interpolated(*converted, *result));
  return {};
}

std::chrono::steady_clock::duration to_duration(double seconds) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(seconds));
}

}  // namespace

RemoteJob::RemoteJob(RemoteAnswerer& front, const std::shared_ptr<const scene::Snapshot>& snapshot,
                     const plan_request_t& request, const base::Deadline& deadline)
    : front_(front),
      link_(front.link_),
      board_(front.parts_.board),
      snapshot_(snapshot),
      request_(request),
      deadline_(deadline),
      deadline_s_(deadline.remaining_s()),
      ends_(Clock::now() + to_duration(deadline_s_)),
      position_(front.position_of_(request.scene)),
      job_(link_.begin()) {}

RemoteJob::~RemoteJob() {
  if (planner_) leave_planner(PlannerBoard::Return::kEnded);
  link_.end(job_, std::move(mark_));
}

Answered RemoteJob::run() {
  while (true) {
    if (deadline_.stopped()) return cancelled();
    if (std::optional<Answered> answered = take_messages()) return *std::move(answered);
    if (is_time_up()) {
      return plain(plan_response_t::STATUS_TIMEOUT,
                   fmt::format("no planner answered within {:.4g} s, when the deadline passed",
                               deadline_s_));
    }
    if (planner_) {
      look_after_planner();
    } else if (std::optional<Answered> answered = look_for_planner()) {
      return *std::move(answered);
    }
    if (planner_) {
      job_.inbox->wait(kLook);
    } else {
      board_.wait(kLook);
    }
  }
}

bool RemoteJob::is_time_up() const {
  const Clock::time_point now = Clock::now();
  return now >= ends_ && (asked_.empty() || now >= ends_ + front_.options_.patience_late);
}

std::optional<Answered> RemoteJob::take_messages() {
  while (const std::optional<JobEvent> event = job_.inbox->take()) {
    if (std::optional<Answered> answered = take(*event)) return answered;
  }
  return std::nullopt;
}

std::optional<Answered> RemoteJob::take(const JobEvent& event) {
  if (!asked_.contains(event.planner)) return std::nullopt;
  switch (event.kind) {
    case fleet_answer_t::ANSWER:
      return take_answer(event);
    case fleet_answer_t::PROGRESS:
      if (is_of_planner(event)) take_progress(event);
      return std::nullopt;
    default:
      if (is_of_planner(event)) take_refusal(event);
      return std::nullopt;
  }
}

std::optional<Answered> RemoteJob::take_answer(const JobEvent& event) {
  base::Result<Answered> answered = checked(event);
  if (answered) return given(*std::move(answered), event.planner);
  link_.warn("an answer of a planner is not given", {{"planner", event.planner},
                                                     {"client", request_.client_id},
                                                     {"request", request_.request_id},
                                                     {"reason", answered.error}});
  if (is_of_planner(event)) {
    avoided_.insert(*planner_);
    leave_planner(PlannerBoard::Return::kEnded);
  }
  return std::nullopt;
}

base::Result<Answered> RemoteJob::checked(const JobEvent& event) const {
  base::Result<plan_response_t> response = read_response(event.payload);
  if (!response) return base::Failure{response.error};
  if (response->client_id != request_.client_id || response->request_id != request_.request_id ||
      response->scene != request_.scene) {
    return base::Failure{"it is to another request"};
  }
  const auto revision = static_cast<std::int64_t>(snapshot_->revision);
  if (response->scene_revision < revision) {
    return base::Failure{fmt::format("it is of revision {} of the scene, older than {}",
                                     response->scene_revision, revision)};
  }
  if (response->scene_revision == revision && response->scene_digest != snapshot_->digest) {
    return base::Failure{"its scene has another digest"};
  }
  std::string path_fault = wire::path_fault(response->segments);
  if (!path_fault.empty()) return base::Failure{std::move(path_fault)};
  Answered answered{*std::move(response)};
  if (request_.watch_lease_s > 0.0) {
    std::string fault = add_paths(request_, front_.options_.deadline, answered);
    if (!fault.empty()) return base::Failure{std::move(fault)};
  }
  const auto newest = front_.parts_.scenes.find(request_.scene);
  for (const auto& held : {snapshot_, newest}) {
    if (held && static_cast<std::int64_t>(held->revision) == answered.wire.scene_revision &&
        held->digest == answered.wire.scene_digest) {
      answered.proved_in = held;
    }
  }
  return answered;
}

void RemoteJob::take_progress(const JobEvent& event) {
  heard_ = Clock::now();
  repeats_ = 0;
  const wire::Decoded<plan_progress_t> decoded = wire::decode<plan_progress_t>(event.payload);
  if (!decoded.message) return;
  const auto count = [](std::int32_t number) {
    return static_cast<std::size_t>(std::max(number, 0));
  };
  if (const auto stage = messages::stage_of(decoded.message->stage)) deadline_.report(*stage);
  deadline_.report_collisions(count(decoded.message->num_collisions),
                              count(decoded.message->num_corrected));
}

void RemoteJob::take_refusal(const JobEvent& event) {
  // A planner that is only busy is asked again when it says that it is not.
  if (event.kind != fleet_answer_t::BUSY) avoided_.insert(*planner_);
  if (event.kind == fleet_answer_t::UNREADABLE) {
    link_.warn("a planner cannot read a request", {{"planner", event.planner},
                                                   {"client", request_.client_id},
                                                   {"request", request_.request_id}});
  }
  leave_planner(PlannerBoard::Return::kRefused);
}

std::optional<Answered> RemoteJob::look_for_planner() {
  if (Clock::now() >= ends_) return std::nullopt;
  const PlannerBoard::Choice choice = board_.take(position_, avoided_);
  if (choice.outlook == PlannerBoard::Outlook::kTaken) {
    ask(choice.planner);
    return std::nullopt;
  }
  if (choice.outlook == PlannerBoard::Outlook::kBehind) {
    if (!behind_since_) behind_since_ = Clock::now();
    const bool is_patient = Clock::now() - *behind_since_ < front_.options_.patience_behind;
    return is_patient ? std::nullopt : plan_here();
  }
  behind_since_.reset();
  return choice.outlook == PlannerBoard::Outlook::kNone ? plan_here() : std::nullopt;
}

std::optional<Answered> RemoteJob::plan_here() {
  if (!front_.take_place_here()) return std::nullopt;
  link_.count_planned_here();
  Answered answered = front_.parts_.here.answer(snapshot_, request_, deadline_);
  front_.give_place_back();
  return given(std::move(answered), front_.options_.front_id);
}

void RemoteJob::ask(const PlannerBoard::Planner& planner) {
  planner_ = planner;
  ended_since_.reset();
  repeats_ = 0;
  if (has_lost_one_) count_sent_again();
  asked_.insert(planner.id);
  if (send()) return;
  avoided_.insert(planner);
  lose_planner(PlannerLoss::Reason::kNotTaken);
}

void RemoteJob::count_sent_again() {
  if (!is_counted_) link_.count_sent_again();
  is_counted_ = true;
}

bool RemoteJob::send() {
  heard_ = Clock::now();
  if (payload_.empty()) payload_ = wire::encode(request_);
  fleet_job_t head{};
  head.job = job_.number;
  head.kind = fleet_job_t::PLAN;
  head.deadline_s = deadline_.remaining_s();
  head.least_revision = static_cast<std::int64_t>(snapshot_->revision);
  return link_.send(planner_->id, head, payload_);
}

void RemoteJob::look_after_planner() {
  const Clock::time_point now = Clock::now();
  if (board_.has_ended(*planner_)) {
    if (!ended_since_) ended_since_ = now;
    if (now - *ended_since_ >= kLastAnswerWait) lose_planner(PlannerLoss::Reason::kEnded);
    return;
  }
  if (board_.is_lost(*planner_)) {
    lose_planner(PlannerLoss::Reason::kSilent);
    return;
  }
  if (now >= ends_ || now - heard_ < front_.options_.patience_silent) return;
  if (repeats_ >= kMostRepeats) {
    // It lives, so it would be chosen again.
    avoided_.insert(*planner_);
    lose_planner(PlannerLoss::Reason::kIdle);
    return;
  }
  ++repeats_;
  count_sent_again();
  if (!send()) lose_planner(PlannerLoss::Reason::kNotTaken);
}

void RemoteJob::lose_planner(PlannerLoss::Reason why) {
  has_lost_one_ = true;
  link_.planner_lost(why, planner_->id, request_);
  leave_planner(PlannerBoard::Return::kEnded);
}

void RemoteJob::leave_planner(PlannerBoard::Return why) {
  board_.give_back(*planner_, why);
  planner_.reset();
}

Answered RemoteJob::cancelled() {
  fleet_job_t head{};
  head.job = job_.number;
  head.kind = fleet_job_t::CANCEL;
  for (const std::string& planner : asked_) link_.send(planner, head, {});
  return plain(plan_response_t::STATUS_CANCELLED, "cancelled by its client");
}

Answered RemoteJob::plain(std::int32_t status, std::string_view message) const {
  Answered answered{
      messages::plain_answer(status, message, service::header_of(request_, snapshot_.get()))};
  answered.proved_in = snapshot_;
  return answered;
}

Answered RemoteJob::given(Answered answered, const std::string& planner) {
  const bool may_another_follow = asked_.size() > (asked_.contains(planner) ? 1U : 0U);
  if (may_another_follow) mark_ = mark_of(answered.wire, planner);
  return answered;
}

}  // namespace camway::fleet
