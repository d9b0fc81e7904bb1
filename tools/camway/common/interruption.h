// SPDX-License-Identifier: MIT
#pragma once

#include <csignal>
#include <ctime>

namespace camway::tools {

/// Keeps SIGINT and SIGTERM from ending this process at once, so that the daemon can be told first.
/// To be made before the client, whose thread takes it over.
class Interruption {
 public:
  Interruption() {
    sigemptyset(&signals_);
    for (const int signal : {SIGINT, SIGTERM}) sigaddset(&signals_, signal);
    pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  }
  /// Whether one came since the last time.
  [[nodiscard]] bool came() const { return came_within(0); }
  /// Whether one comes within so many milliseconds [Limit: 0 <= value < 1000].
  [[nodiscard]] bool came_within(long milliseconds) const {
    const timespec wait{.tv_sec = 0, .tv_nsec = milliseconds * 1'000'000};
    return sigtimedwait(&signals_, nullptr, &wait) > 0;
  }
  /// Ends this process as if none were kept from that.
  void end_process() const {
    pthread_sigmask(SIG_UNBLOCK, &signals_, nullptr);
    raise(SIGINT);
  }

 private:
  sigset_t signals_{};
};

}  // namespace camway::tools
