// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "daemon/service/log/limited_log.h"

namespace camway::fleet {

/// Logs when the servers of a fleet cannot be reached and when they can again, in pairs of lines;
/// in few of them if that goes on.
/// Not thread-safe.
class ConnectionLog {
 public:
  using Clock = service::LimitedLog::Clock;

  explicit ConnectionLog(const std::shared_ptr<service::Log>& log);

  void lost(Clock::time_point now);
  /// `planners`: how many are heard; nothing: not to be said. Silent if the loss was not logged;
  /// returns whether it was.
  bool made_again(std::optional<int> planners);
  void report_suppressed(Clock::time_point now) { losses_.report_suppressed(now); }

 private:
  const std::shared_ptr<service::Log> log_;
  service::LimitedLog losses_;
  bool is_told_ = false;  ///< that the connection is lost
};

/// Logs whether planners are heard, when that changes; in few lines if that goes on.
/// Not thread-safe.
class PlannerPresence {
 public:
  using Clock = ConnectionLog::Clock;

  explicit PlannerPresence(const std::shared_ptr<service::Log>& log);

  /// Requires a call several times a second. `planners`: how many are heard. A change is logged
  /// once it has lasted, so that planners that start together are counted together.
  void tick(int planners, Clock::time_point now);
  /// Takes what another line has said, so that it is not said twice.
  void is_said(int planners);
  /// Forgets a change that began: nothing is heard while the connection is lost.
  void pause() { since_.reset(); }

 private:
  const std::shared_ptr<service::Log> log_;
  service::LimitedLog absences_;
  std::optional<bool> are_heard_;           ///< as logged; nothing: at the start
  std::optional<Clock::time_point> since_;  ///< of the change that is not logged yet
  bool is_absence_told_ = true;             ///< if not, planners that come again are not, either
};

/// A planner that cannot be expected to answer a request.
struct PlannerLoss {
  enum class Reason : std::uint8_t {
    kEnded,     ///< by its own word, or by its new start
    kSilent,    ///< it was not heard
    kIdle,      ///< it is heard, but says nothing of the request
    kNotTaken,  ///< the bus did not take the request
  };
  Reason reason = Reason::kSilent;
  std::string planner;
  std::string client;  ///< of the request
  std::int64_t request = 0;
  /// Whether another planner was heard so lately that the bus works.
  bool is_bus_heard = false;
};

/// How long silence must last before it is logged as the planners' own: more than it takes until a
/// lost connection is noticed: three pings of a second.
inline constexpr std::chrono::milliseconds kLossNoticed{4000};
/// How long planners need to be heard once they start, or once the connection is made again, as
/// each of them has to make its own.
inline constexpr std::chrono::milliseconds kPlannersSettle{2000};

/// Logs trouble of a front with its fleet: one line for one cause. A planner that is lost is
/// named once, however many requests it had, until it is heard again. If all planners become
/// silent at once, the connection may be lost, which is noticed later: then nothing is said of
/// planners if it is, and else one line of all.
/// Not thread-safe.
class FleetNews {
 public:
  using Clock = ConnectionLog::Clock;

  explicit FleetNews(const std::shared_ptr<service::Log>& log);

  void connection_lost(Clock::time_point now);
  void connection_made(Clock::time_point now);
  void planner_lost(const PlannerLoss& loss, Clock::time_point now);
  void planner_heard(const std::string& planner) { named_.erase(planner); }
  /// To be called several times a second. `planners`: how many are heard now.
  void tick(int planners, Clock::time_point now);

 private:
  struct Silence {
    PlannerLoss first;
    std::size_t planners = 0;
    Clock::time_point since;
  };

  void write(const PlannerLoss& loss, Clock::time_point now);

  ConnectionLog connection_;
  PlannerPresence presence_;
  service::LimitedLog losses_;
  bool is_connected_ = true;
  std::optional<Clock::time_point> made_again_;  ///< until it is logged
  std::optional<Silence> silence_;               ///< of planners, whose cause is not known yet
  std::set<std::string> named_;                  ///< planners that were lost and not heard since
};

}  // namespace camway::fleet
