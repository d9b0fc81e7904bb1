// SPDX-License-Identifier: MIT
#pragma once

#include <csignal>
#include <functional>
#include <thread>

namespace camway::service {

/// Keeps SIGHUP from ending the process, and leaves it for a `SignalWaiter`. To be called before
/// other threads begin, so that they inherit it; so is `block_stop_signals`.
void block_reload_signal();
/// Likewise SIGTERM and SIGINT.
void block_stop_signals();

/// Waits for signals on a thread of its own: `on_reload` for each SIGHUP, `on_stop` once, at the
/// first SIGTERM or SIGINT. No signal handler and so no global state. Precondition: both kinds are
/// blocked in this process.
class SignalWaiter {
 public:
  SignalWaiter(std::function<void(int signal)> on_stop, std::function<void()> on_reload);
  ~SignalWaiter();
  SignalWaiter(const SignalWaiter&) = delete;
  SignalWaiter& operator=(const SignalWaiter&) = delete;

 private:
  std::jthread waiter_;
};

}  // namespace camway::service
