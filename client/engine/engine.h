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
#include "client/engine/link.h"
#include "client/engine/watch_list.h"
#include "lcmtypes/wire/channels.h"

namespace camway {

/// The thread of a client: owns the link, sends questions and repeats them, and gives what comes in
/// to the calls that it is for. Any thread may start and cancel calls.
class Engine {
 public:
  /// `link` is open; both must outlive this. Subscribes, then starts the thread.
  Engine(Link& link, Context& context);
  /// Ends all calls with `Outcome::kClosed`. Not for the engine's own thread, unless
  /// `close_from_handler` was called.
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  /// For a handler, which runs on the engine's own thread and cannot wait for its end: ends all
  /// calls now, so that no handler is called once this returns, and has the thread call `release`
  /// as the last thing that it does.
  void close_from_handler(std::function<void()> release);

  void start(std::shared_ptr<Call> call);
  void cancel(Call::Kind kind, std::int64_t request_id);
  /// All calls of that kind.
  void cancel_all(Call::Kind kind);

  /// As those of `WatchList`.
  void watch(const PlanRequest& request, WatchHandler handler);
  void unwatch(std::int64_t request_id);
  void take_better(std::int64_t request_id);
  /// The same, and cancels its planning: true once the daemon does not watch it any more, as it
  /// said or as the lease is over; false if `until` passes or the network breaks.
  std::future<bool> unwatch(std::int64_t request_id, Clock::time_point until);

  /// The next heartbeat; none if `until` passes or the network breaks.
  std::future<std::optional<DaemonStatus>> next_heartbeat(Clock::time_point until);

  /// Whether this is the engine's own thread, which must not wait for itself.
  bool is_this_thread() const { return std::this_thread::get_id() == thread_.get_id(); }

 private:
  using Key = std::pair<Call::Kind, std::int64_t>;
  struct PendingStatus {
    Clock::time_point until;
    std::promise<std::optional<DaemonStatus>> promise;
  };

  /// Somebody who waits for the end of a watch.
  struct PendingUnwatch {
    std::int64_t request_id;
    Clock::time_point until;
    std::promise<bool> promise;
  };

  void listen(const std::string& client_id);
  /// Gives messages on `channel` to the calls of that kind that they answer.
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

  Link& link_;
  const wire::Channels channels_;

  std::mutex mutex_;  ///< guards tasks_
  std::deque<std::function<void()>> tasks_;
  std::atomic<bool> closing_ = false;

  // All else belongs to the thread.
  std::map<Key, std::shared_ptr<Call>> calls_;
  WatchList watches_;
  std::vector<PendingStatus> pending_statuses_;
  std::vector<PendingUnwatch> pending_unwatches_;
  std::deque<Outgoing> outgoing_;
  Clock::time_point send_at_{};  ///< no message leaves before
  bool broken_ = false;
  bool is_unheard_ = false;  ///< the last heartbeat says that the daemon drops what we send
  std::deque<std::shared_ptr<Call>> ending_;  ///< calls that `end_all` has not come to
  std::vector<std::shared_ptr<Call>> kept_;  ///< one of them may be calling the handler that closes
  std::function<void()> release_;

  std::thread thread_;
};

}  // namespace camway
