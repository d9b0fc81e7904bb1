// SPDX-License-Identifier: MIT
#pragma once

#include <csignal>
#include <functional>
#include <thread>

namespace camway::process {

/// Blocks SIGHUP, so that it does not end the process but waits for a `SignalWaiter`. Requires, as
/// does `block_stop_signals`, that no other thread has begun: threads inherit the mask.
void block_reload_signal();
/// Blocks SIGTERM and SIGINT in the same way.
void block_stop_signals();

/// Waits for signals on a thread of its own, and calls `on_reload` for each SIGHUP and `on_stop`
/// once, at the first SIGTERM or SIGINT. Uses no signal handler and so no global state. Requires
/// that these signals are blocked in the whole process.
class SignalWaiter {
 public:
  SignalWaiter(std::function<void(int signal)> on_stop, std::function<void()> on_reload);
  ~SignalWaiter();
  SignalWaiter(const SignalWaiter&) = delete;
  SignalWaiter& operator=(const SignalWaiter&) = delete;

 private:
  std::jthread waiter_;
};

}  // namespace camway::process
