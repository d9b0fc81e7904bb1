// SPDX-License-Identifier: MIT
#pragma once

#include <nats/nats.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <utility>

#include "daemon/base/result.h"
#include "daemon/nats/connection.h"
#include "daemon/nats/stall_watch.h"

namespace camway::nats {

/// Frees what the library made.
struct NatsDeleter {
  void operator()(natsMsg* message) const { natsMsg_Destroy(message); }
  void operator()(natsOptions* options) const { natsOptions_Destroy(options); }
  void operator()(natsSubscription* subscription) const { natsSubscription_Destroy(subscription); }
  void operator()(char* inbox) const { natsInbox_Destroy(inbox); }
};
template <class T>
using NatsOwned = std::unique_ptr<T, NatsDeleter>;

/// A subscription that was ended. Version 3.4 of the library must not free it at once: its reading
/// thread may have just found it for a message (nats.c pull request 638).
struct RetiredSubscription {
  NatsOwned<natsSubscription> subscription;
  std::chrono::steady_clock::time_point when;
};

/// A connection of the library, closed when nobody uses it any more.
using NatsHandle = std::shared_ptr<natsConnection>;

/// The state of a connection, as the threads of the library tell it. They may do so for a moment
/// longer than the connection lives, so they share it. The library itself cannot be asked: it holds
/// its lock while it tries to connect again, which takes seconds if a server hangs. Thread-safe.
class ConnectionEvents {
 public:
  /// A connection was made.
  void made(natsConnection* connection);
  void lost();
  [[nodiscard]] bool is_connected() const { return is_connected_; }
  [[nodiscard]] std::uint64_t generation() const { return generation_; }
  [[nodiscard]] std::size_t most_bytes() const { return most_bytes_; }
  [[nodiscard]] std::string server();
  /// The id that the server has given itself at its start; empty if none is connected.
  [[nodiscard]] std::string server_id();

  /// See `Connection::on_change`.
  void listen(std::function<void(bool)> changed);
  /// The library has given up the connection, for example because it was refused twice.
  void tell_closed();
  /// No connection will be wanted any more.
  void stop();
  /// Waits until `tell_closed` was called since the last call, or until `stop`. Returns whether a
  /// connection is still wanted.
  bool wait_until_closed();
  /// Waits for a time or until `stop`. Returns whether a connection is still wanted.
  bool pause(std::chrono::milliseconds time);

 private:
  void tell(bool is_connected);

  std::atomic<bool> is_connected_ = false;
  std::atomic<std::uint64_t> generation_ = 0;
  std::atomic<std::size_t> most_bytes_ = 0;
  std::recursive_mutex listener_mutex_;  ///< held while the listener runs, which may replace itself
  std::function<void(bool)> changed_;
  std::mutex mutex_;
  std::condition_variable changed_state_;
  std::string server_;
  std::string server_id_;
  bool is_closed_ = false;
  bool is_stopped_ = false;
};

/// The receiver of the messages of a subject. Shared with the library's threads. Thread-safe.
class Receiver {
 public:
  explicit Receiver(Bus::Handler handler) : handler_(std::move(handler)) {}
  void take(natsMsg* message);
  /// Returns when the handler does not run, or runs on this thread; it is not called any more.
  void end();

 private:
  std::recursive_mutex turn_;  ///< recursive, since a handler may end its own subscription
  Bus::Handler handler_;
  bool has_ended_ = false;
};

/// A subject and its receiver: subscribed again when the library's connection is replaced.
struct Subscribed {
  std::string subject;
  std::shared_ptr<Receiver> receiver;
  NatsOwned<natsSubscription> subscription;  ///< guarded by the mutex of the parts
};

/// A first connection, and why there is none.
struct FirstConnection {
  NatsHandle handle;
  std::string error;        ///< with the server; empty exactly if there is a handle
  bool is_refused = false;  ///< to try again is of no use
};
/// Tries all servers once. The events outlive the connection.
FirstConnection connect_once(const ConnectOptions& options,
                             const std::shared_ptr<ConnectionEvents>& events);
/// The server that a connection of the library is connected to, and the id that it has given itself
/// at its start. Empty if there is none.
std::string server_of(natsConnection* connection);
std::string server_id_of(natsConnection* connection);
/// Returns a URL without user and password.
std::string shown_server(const std::string& url);

struct Connection::Parts {
  ConnectOptions options;
  std::shared_ptr<ConnectionEvents> events = std::make_shared<ConnectionEvents>();
  std::mutex mutex;  ///< guards what follows; never held while a handler runs
  NatsHandle handle;
  std::set<Subscribed*> subscribed;
  std::deque<RetiredSubscription> retired;
  std::unique_ptr<StallWatch> stalls;  ///< set as long as the connection is there
  std::thread reviver;  ///< replaces the library's connection when it has been given up

  [[nodiscard]] NatsHandle connection();
  /// Ends a subscription, and frees it later. Requires that the mutex is held.
  void retire(NatsOwned<natsSubscription> subscription);
  /// Subscribes; requires that the mutex is held. Returns whether that was possible.
  bool subscribe(Subscribed& subscribed);
  void revive_until_stopped();
};

}  // namespace camway::nats
