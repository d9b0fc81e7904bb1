// SPDX-License-Identifier: MIT
#pragma once

#include <camway/watch.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <camway/watch_report_t.hpp>
#include <camway/watched_path_t.hpp>

#include "client/engine/context.h"
#include "client/messages/plan.h"

namespace camway {

/// The watched paths of a client: asks for them, renews their leases, tells the daemon what has
/// come, and asks again for what has not. A state machine without a network of its own. For the
/// engine's thread.
class WatchList {
 public:
  struct Hooks {
    std::function<void(Outgoing)> send;
    std::function<void(std::shared_ptr<Call>)> start;
  };

  WatchList(Context& context, Hooks hooks) : context_(context), hooks_(std::move(hooks)) {}

  /// Precondition: no `fault_in_form(request)`, which has an id and a lease.
  void add(const PlanRequest& request, WatchHandler handler);
  /// Also of the daemon's list: it is told until it says that it heard, or the lease is over.
  void remove(std::int64_t request_id);
  /// Whether the daemon is still to be told so.
  bool is_ending(std::int64_t request_id) const;

  /// A page of an answer that no call waits for.
  void take_answer(std::int64_t request_id, std::span<const std::uint8_t> bytes);
  /// A page of an answer on offer.
  void take_offer(std::int64_t request_id, std::span<const std::uint8_t> bytes);
  /// The better path that was told last is to be the one that is watched.
  void take_better(std::int64_t request_id);
  void take_report(std::span<const std::uint8_t> bytes, Clock::time_point now);
  void take_heartbeat(double uptime_s, Clock::time_point now);
  /// Anything came from the daemon.
  void note_life(Clock::time_point now);

  /// No handler is called any more.
  void close() { is_closed_ = true; }

  /// Does what is due.
  void step(Clock::time_point now);
  Clock::time_point wake() const;

 private:
  /// A better answer that the daemon has.
  struct Offer {
    std::int64_t revision;
    Clock::time_point ask_at;  ///< for its pages, or that it be the answer; again
    double again_s;            ///< how long after the last time
    bool is_told = false;
    bool is_taken = false;
  };
  struct Watched {
    PlanRequest request;
    WatchHandler handler;
    PlanCollector collector;
    PlanCollector offered;            ///< what came of an offer
    bool is_asked = false;            ///< a call is on its way
    Clock::time_point ask_at{};       ///< again; the end of time if there is no need
    double ask_again_s = 0.0;         ///< how long after the last time
    std::int64_t held_revision = -1;  ///< of the answer that is here; below 0: none
    std::int64_t serial = 0;          ///< of the daemon's newest state that is here
    bool is_broken = false;
    bool is_lost = false;             ///< as was told last
    std::int64_t scene_revision = 0;  ///< of what was told before that
    std::optional<Failure> refusal = {};  ///< why the daemon does not watch it; none if it may
    std::vector<WatchEvent> untold = {};  ///< the answer since then, told once it is watched
    std::optional<Offer> offer = {};
  };
  /// A message that ends the watching of some paths, until it is answered.
  struct Ending {
    std::vector<std::int64_t> paths;
    Clock::time_point send_at;
    Clock::time_point give_up_at;  ///< when the lease is over anyway
    double again_s;                ///< how long after the last time it is sent
  };

  void ask(Watched& watched);
  void answered(std::int64_t request_id, const PlanResponse& response);
  void take_state(const path_state_t& state, const watch_report_t& report, Clock::time_point now);
  void take_new_state(Watched& watched, const path_state_t& state, const watch_report_t& report,
                      Clock::time_point now);
  void take_offer_state(Watched& watched, const path_state_t& state, Clock::time_point now);
  void tell_offer(Watched& watched);
  void ask_for_offers(Clock::time_point now);
  void ask_later(Watched& watched, Clock::time_point now);
  void renew(Clock::time_point now);
  void acknowledge();
  void end_unwanted(Clock::time_point now);
  void send(std::vector<watched_path_t> paths, std::int64_t id, double lease_s);
  void look_for_life(Clock::time_point now);
  void lose_all(const Failure& why);
  void tell(Watched& watched, WatchEvent event);
  /// Unless that was told last: that it is still so is no news.
  void tell_lost(Watched& watched, const Failure& why);
  void tell_watched_again();

  Context& context_;
  const Hooks hooks_;
  std::map<std::int64_t, Watched> watched_;
  std::set<std::int64_t> to_acknowledge_;
  std::set<std::int64_t> unwanted_;         ///< paths that the daemon is to be told not to watch
  std::map<std::int64_t, Ending> endings_;  ///< by the id of the message
  Clock::time_point renew_at_ = Clock::time_point::max();
  double renew_again_s_ = 0.0;         ///< how long to wait for the answer
  std::set<std::int64_t> unanswered_;  ///< ids of the renewals that were sent last
  Clock::time_point renewed_at_{};     ///< when all of them were answered
  Clock::time_point stepped_at_{};     ///< last
  Clock::time_point heard_at_{};       ///< a sign of life; later where we did not listen meanwhile
  Clock::time_point ping_at_{};        ///< not before: that the daemon may give one
  bool was_heard_ = false;             ///< ever, since there was something to watch
  bool is_silent_ = false;             ///< as was told
  bool is_closed_ = false;
};

}  // namespace camway
