// SPDX-License-Identifier: MIT
#include "daemon/fleet/remote_answerer.h"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <stop_token>
#include <utility>

#include "daemon/fleet/remote_job.h"
#include "daemon/fleet/subjects.h"
#include "daemon/messages/plan.h"
#include "lcmtypes/wire/layout.h"

namespace camway::fleet {
namespace {

/// How often the board looks which planners have become silent.
constexpr std::chrono::milliseconds kTick{100};

void keep_ticking(const std::stop_token& stop, PlannerBoard& board, FrontLink& link) {
  std::mutex mutex;
  std::condition_variable_any stopped;
  std::unique_lock lock(mutex);
  while (!stop.stop_requested()) {
    stopped.wait_for(lock, stop, kTick, [] { return false; });
    board.tick();
    link.say_alive();
    link.tick();
  }
}

}  // namespace

base::Result<std::unique_ptr<RemoteAnswerer>> RemoteAnswerer::open(
    const Parts& parts, const FrontOptions& options, PositionOf position_of,
    const std::shared_ptr<service::Log>& log) {
  if (!is_id(options.fleet)) return base::Failure{"the fleet's name is not of [A-Za-z0-9_-]{1,32}"};
  if (!is_id(options.front_id))
    return base::Failure{"the front's id is not of [A-Za-z0-9_-]{1,32}"};
  std::unique_ptr<RemoteAnswerer> answerer(
      new RemoteAnswerer(parts, options, std::move(position_of), log));
  if (!answerer->link_.open()) return base::Failure{"NATS takes no subscription"};
  return answerer;
}

RemoteAnswerer::RemoteAnswerer(const Parts& parts, const FrontOptions& options,
                               PositionOf position_of, const std::shared_ptr<service::Log>& log)
    : parts_(parts),
      options_(options),
      position_of_(std::move(position_of)),
      link_(parts.bus, parts.board, Subjects{options.fleet}, options.front_id, log),
      keeper_([this](const std::stop_token& stop) { keep_ticking(stop, parts_.board, link_); }) {}

RemoteAnswerer::~RemoteAnswerer() = default;

service::Answered RemoteAnswerer::answer(const std::shared_ptr<const scene::Snapshot>& snapshot,
                                         const plan_request_t& request,
                                         const base::Deadline& deadline) {
  std::string error;
  try {
    return RemoteJob(*this, snapshot, request, deadline).run();
  } catch (const std::exception& exception) {
    error = exception.what();
  } catch (...) {
    error = "unknown exception";
  }
  return {messages::plain_answer(plan_response_t::STATUS_INTERNAL_ERROR, "internal error: " + error,
                                 service::header_of(request, snapshot.get()))};
}

bool RemoteAnswerer::take_place_here() {
  if (++planning_here_ <= options_.workers_here) return true;
  --planning_here_;
  return false;
}

void RemoteAnswerer::add_to(status_t& status, std::int64_t newest, bool is_in_touch) const {
  status.role = "front";
  status.log_in_touch = is_in_touch ? 1 : 0;
  const FrontCounts counts = link_.counts();
  status.jobs_sent_again = counts.jobs_sent_again;
  status.differing_answers = counts.differing_answers;
  status.planned_here = counts.planned_here;
  // Half of the message at most, so that scenes are listed beside them (`service::fit_message`).
  std::size_t bytes = 0;
  for (fleet_planner_t& planner : parts_.board.planners(newest)) {
    bytes += static_cast<std::size_t>(planner._getEncodedSizeNoHash());
    if (bytes > wire::kMaxMessageBytes / 2) break;
    status.planners.push_back(std::move(planner));
  }
  status.num_planners = static_cast<std::int32_t>(status.planners.size());
}

}  // namespace camway::fleet
