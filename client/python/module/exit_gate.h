// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

/// The exit gate keeps threads from returning out of C++ while the interpreter ends. Python kills a
/// thread that takes the GIL then, by an unwinding that C++ turns into an abort. So the package
/// closes the gate before: it waits for the threads that are about to take the GIL, and later
/// threads wait for the end of the process.
namespace camway::python {

/// Counts a call of Python into C++, from its beginning to its end. For `pybind11::call_guard`.
class CountedCall {
 public:
  CountedCall();
  ~CountedCall();
  CountedCall(const CountedCall&) = delete;
  CountedCall& operator=(const CountedCall&) = delete;
};

/// Gives the GIL away for a part of a counted call, which does not count until it has come back.
class WithoutGil {
 public:
  WithoutGil();
  ~WithoutGil();
  WithoutGil(const WithoutGil&) = delete;
  WithoutGil& operator=(const WithoutGil&) = delete;

 private:
  PyThreadState* state_;
};

/// Closes the gate. Called once, with the GIL, by the thread that ends the interpreter.
void close_exit_gate();

}  // namespace camway::python
