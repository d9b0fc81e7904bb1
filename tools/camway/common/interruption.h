// SPDX-License-Identifier: MIT
#pragma once

#include <csignal>
#include <ctime>

namespace camway::tools {

/// Blocks SIGINT and SIGTERM, so that a command can cancel its request at the daemon before it
/// ends. Make it before the client, whose thread inherits the signal mask.
class Interruption {
 public:
  Interruption() {
    sigemptyset(&signals_);
    for (const int signal : {SIGINT, SIGTERM}) sigaddset(&signals_, signal);
    pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  }
  /// Returns whether a signal came since the last call.
  [[nodiscard]] bool came() const { return came_within(0); }
  /// Returns whether a signal comes within this time. [Limit: 0 <= value < 1000]
  [[nodiscard]] bool came_within(long milliseconds) const {
    const timespec wait{.tv_sec = 0, .tv_nsec = milliseconds * 1'000'000};
    return sigtimedwait(&signals_, nullptr, &wait) > 0;
  }
  /// Ends this process by SIGINT, as if it had been neither blocked nor ignored.
  void end_process() const {
    std::signal(SIGINT, SIG_DFL);
    pthread_sigmask(SIG_UNBLOCK, &signals_, nullptr);
    raise(SIGINT);
  }

 private:
  sigset_t signals_{};
};

}  // namespace camway::tools
