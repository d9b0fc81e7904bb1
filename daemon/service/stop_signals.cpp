// SPDX-License-Identifier: MIT
#include "daemon/service/stop_signals.h"

#include <pthread.h>

#include <utility>

namespace camway::service {
namespace {

sigset_t stop_set() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGTERM);
  sigaddset(&set, SIGINT);
  return set;
}

}  // namespace

void block_stop_signals() {
  const sigset_t set = stop_set();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

StopSignals::StopSignals(std::function<void(int)> on_stop)
    : waiter_([on_stop = std::move(on_stop)](const std::stop_token& ended) {
        const sigset_t set = stop_set();
        int signal = 0;
        if (sigwait(&set, &signal) == 0 && !ended.stop_requested()) on_stop(signal);
      }) {}

StopSignals::~StopSignals() {
  waiter_.request_stop();
  // Ends the wait if no signal came; blocked and directed at that thread, it reaches nobody else.
  pthread_kill(waiter_.native_handle(), SIGINT);
}

}  // namespace camway::service
