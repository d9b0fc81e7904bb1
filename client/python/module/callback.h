// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include <condition_variable>
#include <memory>
#include <mutex>
#include <utility>

#include "client/python/module/lazy.h"

namespace camway::python {

/// The way of a client's threads into Python, which closes with the client: a thread that came in
/// while the interpreter ends would be killed there. Thread-safe.
class CallGate {
 public:
  /// Runs `call` with the GIL, unless the gate is closed. Returns whether it ran.
  template <class Call>
  bool pass(const Call& call) {
    {
      const std::scoped_lock lock(mutex_);
      if (is_closed_) return false;
      ++running_;
    }
    ++mine();
    const CallGate* const outer = std::exchange(innermost(), this);
    {
      const py::gil_scoped_acquire gil;
      call();
    }
    innermost() = outer;
    --mine();
    const std::scoped_lock lock(mutex_);
    --running_;
    left_.notify_all();
    return true;
  }

  /// Closes the gate and waits for all that are inside, this thread apart. Requires no GIL.
  void close() {
    std::unique_lock lock(mutex_);
    is_closed_ = true;
    left_.wait(lock, [&] { return running_ <= mine(); });
  }

  /// Whether this thread is in a handler of this gate's client, for whose end all of its answers
  /// wait.
  [[nodiscard]] bool is_this_thread_inside() const { return innermost() == this; }

 private:
  /// The gate that this thread came through last and has not left; null outside of all.
  static const CallGate*& innermost() {
    thread_local const CallGate* gate = nullptr;
    return gate;
  }

  /// Number of calls that this thread is in, of any gate: a handler that closes several clients
  /// waits for none that it is in itself.
  static int& mine() {
    thread_local int count = 0;
    return count;
  }

  std::mutex mutex_;
  std::condition_variable left_;
  int running_ = 0;
  bool is_closed_ = false;
};

/// A function of Python that threads of C++ may call, copy and destroy. They hold no GIL: it is
/// taken for each call. What the function raises is reported as "unraisable"
/// (`sys.unraisablehook`), since nothing waits for it. After its gate is closed, calls have no
/// effect.
class Callback {
 public:
  /// Requires the GIL.
  Callback(std::shared_ptr<CallGate> gate, py::function function)
      : gate_(std::move(gate)),
        function_(new py::function(std::move(function)), [gate = gate_](py::function* held) {
          // If the gate is closed the interpreter may have ended, so the function is left.
          if (!gate->pass([&] { *held = {}; })) static_cast<void>(held->release());
          delete held;
        }) {}

  template <class Argument>
  void operator()(const Argument& argument) const {
    gate_->pass([&] {
      try {
        (*function_)(to_python(argument));
      } catch (py::error_already_set& raised) {
        raised.discard_as_unraisable("a handler of a camway.Client");
      }
    });
  }

 private:
  std::shared_ptr<CallGate> gate_;
  std::shared_ptr<py::function> function_;
};

}  // namespace camway::python
