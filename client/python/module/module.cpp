// SPDX-License-Identifier: MIT
#include "client/python/module/module.h"

#include "client/python/module/convert.h"
#include "client/python/module/exit_gate.h"
#include "client/python/module/faults.h"

PYBIND11_MODULE(_native, module) {
  namespace py = pybind11;
  using namespace camway::python;
  module.doc() = "The part of the package camway that is written in C++.";
  module.attr("__version__") = CAMWAY_VERSION;
  add_path(module);
  add_lazy(module);
  add_client(module);
  add_documents(module);
  add_scene(module);
  add_planning(module);
  // The classes of data need the class Path of this module, so they are loaded when that is there.
  module.def(
      "load_classes",
      [](const py::module_& types, const py::module_& errors) {
        load_classes(types);
        register_faults(errors);
      },
      py::arg("types"), py::arg("errors"),
      "Looks up the classes of data and of errors. Called once, by the package.");
  module.def("close_exit_gate", &close_exit_gate,
             "Has calls of other threads end or wait for the end of the process. Called at exit.");
}
