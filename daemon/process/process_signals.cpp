// SPDX-License-Identifier: MIT
#include "daemon/process/process_signals.h"

#include <pthread.h>

#include <initializer_list>
#include <utility>

namespace camway::process {
namespace {

sigset_t set_of(std::initializer_list<int> signals) {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : signals) sigaddset(&set, signal);
  return set;
}

void block(const sigset_t& set) { pthread_sigmask(SIG_BLOCK, &set, nullptr); }

}  // namespace

void block_reload_signal() { block(set_of({SIGHUP})); }
void block_stop_signals() { block(set_of({SIGTERM, SIGINT})); }

SignalWaiter::SignalWaiter(std::function<void(int)> on_stop, std::function<void()> on_reload)
    : waiter_([on_stop = std::move(on_stop),
               on_reload = std::move(on_reload)](const std::stop_token& ended) {
        const sigset_t set = set_of({SIGTERM, SIGINT, SIGHUP});
        while (true) {
          int signal = 0;
          if (sigwait(&set, &signal) != 0 || ended.stop_requested()) return;
          if (signal != SIGHUP) {
            on_stop(signal);
            return;
          }
          on_reload();
        }
      }) {}

SignalWaiter::~SignalWaiter() {
  waiter_.request_stop();
  // Ends the wait if no signal came. The signal is blocked everywhere and directed at that thread,
  // so no other thread receives it.
  pthread_kill(waiter_.native_handle(), SIGINT);
}

}  // namespace camway::process
