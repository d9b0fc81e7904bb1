// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include <memory>

#include "client/python/module/convert.h"

namespace camway::python {

/// A function of Python that threads of C++ may call, copy and destroy. They hold no GIL: it is
/// taken for each call. What the function raises is reported as "unraisable"
/// (`sys.unraisablehook`), since nothing waits for it.
class Callback {
 public:
  /// Requires the GIL.
  explicit Callback(py::function function)
      : function_(new py::function(std::move(function)), [](py::function* held) {
          const py::gil_scoped_acquire gil;
          delete held;
        }) {}

  template <class Argument>
  void operator()(const Argument& argument) const {
    const py::gil_scoped_acquire gil;
    try {
      (*function_)(to_python(argument));
    } catch (py::error_already_set& raised) {
      raised.discard_as_unraisable("a handler of a camway.Client");
    }
  }

 private:
  std::shared_ptr<py::function> function_;
};

}  // namespace camway::python
