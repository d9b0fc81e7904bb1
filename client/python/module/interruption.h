// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <type_traits>

#include "client/python/module/exit_gate.h"

namespace camway::python {

/// Time between two looks for signals while a call waits. Python's handlers, as that of Ctrl-C, run
/// only then.
inline constexpr std::chrono::milliseconds kSignalPeriod{50};

/// Whether this is the thread in which Python runs the handlers of signals.
inline bool is_main_thread() {
  // The function is looked up once, and never destroyed: other modules may end later.
  static PyObject* const main_thread =
      pybind11::object(pybind11::module_::import("threading").attr("main_thread")).release().ptr();
  return pybind11::handle(main_thread)().attr("ident").cast<unsigned long>() ==
         PyThread_get_thread_ident();
}

/// The `look` of a wait that looks at nothing.
struct NoLook {
  void operator()() const {}
};

/// Waits for `answer` without the GIL, until `end` at the latest. In the main thread, runs the
/// handlers of signals meanwhile; if one raises, calls `stop`, waits no longer and throws what it
/// raised. Calls `look` with the GIL after each period. Other threads without a `look` take the GIL
/// at the end alone: a thread that takes it while the interpreter ends is killed. Returns whether
/// the answer came. Requires the GIL.
template <class Answer, class Stop, class Look = NoLook>
bool wait_for(std::future<Answer>& answer, std::chrono::steady_clock::time_point end,
              const Stop& stop, const Look& look = {}) {
  const auto comes_within = [&](std::chrono::nanoseconds time) {
    const WithoutGil others_may_run;
    return answer.wait_for(time) == std::future_status::ready;
  };
  if (std::is_same_v<Look, NoLook> && !is_main_thread()) {
    return comes_within(end - std::chrono::steady_clock::now());
  }
  while (true) {
    const auto rest = end - std::chrono::steady_clock::now();
    if (comes_within(std::min<std::chrono::nanoseconds>(rest, kSignalPeriod))) return true;
    const bool is_interrupted = PyErr_CheckSignals() != 0;
    if (!is_interrupted) look();
    if (is_interrupted) {
      const pybind11::error_already_set raised;
      const WithoutGil others_may_run;
      stop();
      throw raised;
    }
    if (std::chrono::steady_clock::now() >= end) return false;
  }
}

/// The end of a wait without one. Not the largest time, to which nothing could be added.
inline std::chrono::steady_clock::time_point no_end() {
  return std::chrono::steady_clock::now() + std::chrono::hours(24 * 365);
}

}  // namespace camway::python
