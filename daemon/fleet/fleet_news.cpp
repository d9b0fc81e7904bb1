// SPDX-License-Identifier: MIT
#include "daemon/fleet/fleet_news.h"

#include <array>
#include <string_view>
#include <utility>

namespace camway::fleet {
namespace {

/// Trouble that comes again every few seconds for hours must not fill the log.
constexpr service::LimitedLog::Limits kTroubleLimits{.lines_per_s = 1.0 / 30, .burst_lines = 10};

constexpr std::array<std::string_view, 4> kReasons{"it has ended", "it was not heard",
                                                   "it says nothing of the request",
                                                   "NATS did not take the request"};

}  // namespace

ConnectionLog::ConnectionLog(const std::shared_ptr<service::Log>& log)
    : log_(log), losses_(log, service::LogLevel::kWarn, "lost connections", kTroubleLimits) {}

void ConnectionLog::lost(Clock::time_point now) {
  is_told_ = losses_.write("the servers of the fleet cannot be reached; trying again", {}, now);
}

bool ConnectionLog::made_again(std::optional<int> planners) {
  if (!std::exchange(is_told_, false)) return false;
  constexpr std::string_view kEvent = "connected to the fleet again";
  if (planners) {
    log_->info(kEvent, {{"planners", *planners}});
  } else {
    log_->info(kEvent);
  }
  return true;
}

PlannerPresence::PlannerPresence(const std::shared_ptr<service::Log>& log)
    : log_(log), absences_(log, service::LogLevel::kWarn, "absences of planners", kTroubleLimits) {}

void PlannerPresence::tick(int planners, Clock::time_point now) {
  absences_.report_suppressed(now);
  const bool are_heard = planners > 0;
  if (are_heard_ == are_heard) {
    since_.reset();
    return;
  }
  if (!since_) since_ = now;
  if (now < *since_ + (are_heard ? kPlannersSettle : kLossNoticed)) return;
  since_.reset();
  are_heard_ = are_heard;
  if (!are_heard) {
    is_absence_told_ =
        absences_.write("no planner is heard; requests are planned by this process", {}, now);
  } else if (std::exchange(is_absence_told_, false)) {
    log_->info("planners plan", {{"planners", planners}});
  }
}

void PlannerPresence::is_said(int planners) {
  are_heard_ = planners > 0;
  is_absence_told_ = true;
}

FleetNews::FleetNews(const std::shared_ptr<service::Log>& log)
    : connection_(log),
      presence_(log),
      losses_(log, service::LogLevel::kWarn, "lost planners", kTroubleLimits) {}

void FleetNews::connection_lost(Clock::time_point now) {
  // Lost again before it was said that it was made again: one loss for the reader of the log.
  if (is_connected_ && !made_again_) connection_.lost(now);
  is_connected_ = false;
  made_again_.reset();
  silence_.reset();
  presence_.pause();
}

void FleetNews::connection_made(Clock::time_point now) {
  is_connected_ = true;
  made_again_ = now;
}

void FleetNews::planner_lost(const PlannerLoss& loss, Clock::time_point now) {
  if (!is_connected_ || made_again_ || !named_.insert(loss.planner).second) return;
  const bool may_be_the_connection =
      loss.reason == PlannerLoss::Reason::kNotTaken ||
      (loss.reason == PlannerLoss::Reason::kSilent && !loss.is_bus_heard);
  if (!may_be_the_connection) {
    write(loss, now);
    return;
  }
  if (!silence_) silence_ = Silence{loss, 0, now};
  ++silence_->planners;
}

void FleetNews::tick(int planners, Clock::time_point now) {
  if (made_again_ && now >= *made_again_ + kPlannersSettle) {
    if (connection_.made_again(planners)) presence_.is_said(planners);
    made_again_.reset();
  }
  if (is_connected_ && !made_again_) presence_.tick(planners, now);
  if (silence_ && now >= silence_->since + kLossNoticed) {
    const Silence silence = *std::exchange(silence_, std::nullopt);
    if (silence.planners == 1) {
      write(silence.first, now);
    } else {
      losses_.write("planners are lost to requests", {{"planners", silence.planners}}, now);
    }
  }
  connection_.report_suppressed(now);
  losses_.report_suppressed(now);
}

void FleetNews::write(const PlannerLoss& loss, Clock::time_point now) {
  losses_.write("a planner is lost to a request",
                {{"planner", loss.planner},
                 {"client", loss.client},
                 {"request", loss.request},
                 {"reason", kReasons.at(static_cast<std::size_t>(loss.reason))}},
                now);
}

}  // namespace camway::fleet
