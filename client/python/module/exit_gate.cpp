// SPDX-License-Identifier: MIT
#include "client/python/module/exit_gate.h"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace camway::python {
namespace {

/// Longest wait for threads that are about to take the GIL: after a fork, threads of the parent
/// never come.
constexpr std::chrono::seconds kLongestWait{5};
constexpr std::chrono::milliseconds kPause{1};

// Atomic numbers and no lock, which a fork could leave locked.
std::atomic<int> calls_inside = 0;
std::atomic<bool> is_closed = false;

/// Calls of this thread, as one may call Python, which calls C++ again.
thread_local int depth = 0;

void enter() {
  if (depth++ == 0) ++calls_inside;
}
void leave() {
  if (--depth == 0) --calls_inside;
}

}  // namespace

CountedCall::CountedCall() { enter(); }
CountedCall::~CountedCall() { leave(); }

WithoutGil::WithoutGil() : state_(PyEval_SaveThread()) {
  if (depth > 0) --calls_inside;
}

WithoutGil::~WithoutGil() {
  if (depth > 0) ++calls_inside;
  // Counted first: either the closing thread sees this one, or this one sees that the gate is
  // closed.
  if (is_closed) {
    if (depth > 0) --calls_inside;
    while (true) ::pause();
  }
  PyEval_RestoreThread(state_);
}

void close_exit_gate() {
  is_closed = true;
  const pybind11::gil_scoped_release others_come_back;
  const auto end = std::chrono::steady_clock::now() + kLongestWait;
  while (calls_inside > 0 && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(kPause);
  }
}

}  // namespace camway::python
