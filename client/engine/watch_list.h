// SPDX-License-Identifier: MIT
#pragma once

#include <camway/daemon_status.h>
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
#include "client/engine/known_scene.h"
#include "client/engine/plan_collector.h"
#include "client/messages/plan.h"

namespace camway {

/// The watched paths of a client. Requests them, renews their leases, acknowledges received states
/// and asks again for missing ones. A state machine without a network of its own.
///
/// Not thread-safe: only the engine's thread may use it.
class WatchList {
 public:
  struct Hooks {
    std::function<void(Outgoing)> send;
    std::function<void(std::shared_ptr<Call>)> start;
  };

  WatchList(Context& context, Hooks hooks) : context_(context), hooks_(std::move(hooks)) {}

  /// Adds a path. Requires a request without `fault_in_form`, with an id and a lease.
  void add(const PlanRequest& request, WatchHandler handler);
  /// Removes a path. The daemon is told repeatedly until it confirms or the lease is over.
  void remove(std::int64_t request_id);
  /// Returns whether the daemon has still to confirm the end of a watch.
  bool is_ending(std::int64_t request_id) const;

  /// Takes a page of an answer. Pages that a call waits for are ignored.
  void take_answer(std::int64_t request_id, std::span<const std::uint8_t> bytes);
  /// Takes a page of a better answer on offer.
  void take_offer(std::int64_t request_id, std::span<const std::uint8_t> bytes);
  /// Accepts the better path that was offered last. Has no effect without an offer.
  void take_better(std::int64_t request_id);
  /// Takes an encoded `watch_report_t`.
  void take_report(std::span<const std::uint8_t> bytes, Clock::time_point now);
  void take_heartbeat(const DaemonStatus& status, Clock::time_point now);
  /// Notes a sign of life of the daemon.
  void note_life(Clock::time_point now);

  /// Ends all calls of handlers. Paths are neither added nor removed any more, so that a handler
  /// may close the list from which it is called.
  void close() { is_closed_ = true; }

  /// Does everything that is due at `now`.
  void step(Clock::time_point now);
  /// Returns when `step` is due next.
  Clock::time_point wake() const;

 private:
  /// A better answer on offer.
  struct Offer {
    std::int64_t revision;     ///< `path_state_t::offer_revision`
    Clock::time_point ask_at;  ///< next time to ask for its pages, or to accept it
    double again_s;            ///< pause between the attempt at `ask_at` and the next one; it grows
    bool is_told = false;      ///< whether the handler has received it
    bool is_taken = false;     ///< whether the user has accepted it
  };
  struct Watched {
    PlanRequest request;
    WatchHandler handler;
    PlanCollector collector;
    PlanCollector offered;       ///< pages of the offer
    bool is_asked = false;       ///< whether a call for the path is pending
    Clock::time_point ask_at{};  ///< next time to request the path; max: not needed
    double ask_again_s = 0.0;    ///< pause between the attempt at `ask_at` and the next; it grows
    std::int64_t held_revision = -1;  ///< scene revision of the answer that is held; below 0: none
    KnownScene scene = {};            ///< what was heard of its scene
    /// Whether a new daemon has forgotten changes of the scene. Such a path stays lost.
    bool is_forgotten = false;
    std::int64_t serial = 0;  ///< serial of the newest state that was received
    bool is_broken = false;
    WatchEvent last_break = {};           ///< the last event kBroken
    bool is_lost = false;                 ///< whether the last event was kLost
    std::int64_t scene_revision = 0;      ///< scene revision of the last event before kLost
    std::optional<Failure> refusal = {};  ///< reason why the daemon refuses to watch it, if it does
    /// The event with the newest answer that came while the daemon refused to watch the path; at
    /// most one. The handler receives it when a report says that the path is watched.
    std::vector<WatchEvent> untold = {};
    std::optional<Offer> offer = {};
  };
  /// A message that ends the watches of some paths. It is repeated until it is answered.
  struct Ending {
    std::vector<std::int64_t> paths;
    Clock::time_point send_at;     ///< next time to send it
    Clock::time_point give_up_at;  ///< time at which the lease is over anyway
    double again_s;  ///< pause between the attempt at `send_at` and the next; it grows
  };

  void ask(Watched& watched);
  void answered(std::int64_t request_id, const PlanResponse& response);
  /// Gives up a path whose scene has lost changes with the daemon that had them.
  void forget(Watched& watched, const PlanResponse& response);
  /// The answer has a proved path, which is watched from now on.
  void take_proof(Watched& watched, const PlanResponse& response, bool is_first);
  /// The answer has no proved path, and there is none before it: ends the watch.
  void end_without_proof(Watched& watched, const PlanResponse& response);
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
  /// Takes note of the start of the daemon that sent something. Tells of a new one.
  void note_start(const DaemonStart& start);
  void look_for_life(Clock::time_point now);
  void lose_all(const Failure& why);
  void tell(Watched& watched, WatchEvent event);
  /// Calls the handler with kLost, unless that was the last event.
  void tell_lost(Watched& watched, const Failure& why);
  void tell_watched_again();

  Context& context_;
  const Hooks hooks_;
  std::map<std::int64_t, Watched> watched_;
  std::set<std::int64_t> to_acknowledge_;   ///< paths with a state to acknowledge
  std::set<std::int64_t> unwanted_;         ///< paths whose watch is to be ended
  std::map<std::int64_t, Ending> endings_;  ///< messages that end watches, by their id
  Clock::time_point renew_at_ = Clock::time_point::max();
  double renew_again_s_ = 0.0;         ///< wait for the answer to a renewal
  std::set<std::int64_t> unanswered_;  ///< ids of the last renewals that are not answered yet
  /// Last time at which every renewal that had been sent was answered. Also set when the first path
  /// is added, and when a heartbeat shows that the daemon was restarted.
  Clock::time_point renewed_at_{};
  Clock::time_point stepped_at_{};  ///< time of the last step
  /// Time of the last sign of life, plus the time since then in which this client did not run (for
  /// example, because the process was stopped). So a pause of the client does not count as silence
  /// of the daemon.
  Clock::time_point heard_at_{};
  Clock::time_point ping_at_{};  ///< earliest time to ask the daemon for a sign of life
  bool was_heard_ = false;       ///< whether a daemon was heard since the first path was added
  bool is_silent_ = false;       ///< whether the handlers were told of the daemon's silence
  /// `DaemonStart::id` of all daemons that were heard: two may share a prefix.
  std::set<std::int64_t> starts_;
  bool is_closed_ = false;
};

}  // namespace camway
