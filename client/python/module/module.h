// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

/// The parts of the module `camway._native`. Each function adds what its name says.
namespace camway::python {

void add_path(pybind11::module_& module);
void add_client(pybind11::module_& module);
void add_documents(pybind11::module_& module);
void add_lazy(pybind11::module_& module);
void add_scene(pybind11::module_& module);
void add_planning(pybind11::module_& module);

}  // namespace camway::python
