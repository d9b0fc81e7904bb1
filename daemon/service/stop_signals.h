// SPDX-License-Identifier: MIT
#pragma once

#include <csignal>
#include <functional>
#include <thread>

namespace camway::service {

/// Keeps SIGTERM and SIGINT from ending the process. To be called before other threads begin, so
/// that they inherit it.
void block_stop_signals();

/// Calls `on_stop` once, from a thread of its own, when SIGTERM or SIGINT comes. No signal handler
/// and so no global state. Precondition: `block_stop_signals` was called in this process.
class StopSignals {
 public:
  explicit StopSignals(std::function<void(int signal)> on_stop);
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

 private:
  std::jthread waiter_;
};

}  // namespace camway::service
