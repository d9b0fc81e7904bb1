// SPDX-License-Identifier: MIT
#pragma once

#include <camway/client.h>

#include <atomic>
#include <deque>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "client/engine/call.h"
#include "client/engine/lcm_connection.h"
#include "client/engine/watch_list.h"
#include "lcmtypes/wire/channels.h"

namespace camway {

/// The thread of a client. It alone uses the connection: it sends requests, repeats them, and
/// passes each received message to its call. The public members are thread-safe.
class Engine {
 public:
  /// Subscribes to all channels and starts the thread. Requires an open connection; connection and
  /// context must outlive the engine.
  Engine(LcmConnection& connection, Context& context);
  /// Ends all calls with `Outcome::kClosed`. In the engine's own thread it requires that
  /// `close_from_handler` was called.
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  /// Closes the engine from a handler, which runs on the engine's own thread and therefore cannot
  /// join it. Ends all calls; no handler runs after it returns. The thread calls `release` as its
  /// last action.
  void close_from_handler(std::function<void()> release);

  void start(std::shared_ptr<Call> call);
  void cancel(Call::Kind kind, std::int64_t request_id);
  /// Cancels all calls of a kind.
  void cancel_all(Call::Kind kind);

  /// The next three functions call `WatchList::add`, `remove` and `take_better` on the engine's
  /// thread.
  void watch(const PlanRequest& request, WatchHandler handler);
  void unwatch(std::int64_t request_id);
  void take_better(std::int64_t request_id);
  /// Ends a watch and cancels its planning. The result is true once the daemon has confirmed the
  /// end or the lease is over; false if `until` passes or the network fails.
  std::future<bool> unwatch(std::int64_t request_id, Clock::time_point until);

  /// Returns the next heartbeat; nothing if `until` passes or the network fails.
  std::future<std::optional<DaemonStatus>> next_heartbeat(Clock::time_point until);

  /// Returns whether the caller runs on the engine's own thread, which must not wait for a call.
  bool is_this_thread() const { return std::this_thread::get_id() == thread_.get_id(); }

 private:
  using Key = std::pair<Call::Kind, std::int64_t>;
  /// A caller that waits for a heartbeat.
  struct PendingStatus {
    Clock::time_point until;
    std::promise<std::optional<DaemonStatus>> promise;
  };

  /// A caller that waits for the end of a watch.
  struct PendingUnwatch {
    std::int64_t request_id;
    Clock::time_point until;
    std::promise<bool> promise;
  };

  void listen(const std::string& client_id);
  /// Subscribes to `channel` and passes each message to the call of that kind that it answers.
  template <class Response>
  void take_answers(Call::Kind kind, const std::string& channel, int queue);
  void post(std::function<void()> task);
  void run();
  void run_thread();
  void run_tasks();
  void send_some(Clock::time_point now);
  Clock::time_point next_wake() const;
  void step(Clock::time_point now);
  std::optional<Outcome> step(Call& call, Clock::time_point now);
  void end_waiters(Clock::time_point now);
  void end_leavers(Clock::time_point now);
  void end_all(Outcome outcome);
  void end_calls(Outcome outcome);
  Call* find(Call::Kind kind, std::int64_t request_id);
  void take_missing_pages(std::span<const std::uint8_t> bytes);
  void take_heartbeat(std::span<const std::uint8_t> bytes);

  LcmConnection& connection_;
  const wire::Channels channels_;

  std::mutex mutex_;  ///< guards tasks_
  std::deque<std::function<void()>> tasks_;
  std::atomic<bool> closing_ = false;

  // Only the engine's thread uses the members below.
  std::map<Key, std::shared_ptr<Call>> calls_;
  WatchList watches_;
  std::vector<PendingStatus> pending_statuses_;
  std::vector<PendingUnwatch> pending_unwatches_;
  std::deque<Outgoing> outgoing_;
  Clock::time_point send_at_{};  ///< earliest time to send the next message
  bool broken_ = false;
  bool is_unheard_ = false;  ///< whether the last heartbeat says that the daemon drops our messages
  std::deque<std::shared_ptr<Call>> ending_;  ///< calls that `end_all` has still to finish
  std::vector<std::shared_ptr<Call>> kept_;   ///< calls kept alive: one may run the closing handler
  std::function<void()> release_;

  std::thread thread_;
};

}  // namespace camway
