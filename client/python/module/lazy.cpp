// SPDX-License-Identifier: MIT
#include "client/python/module/lazy.h"

#include <string>

#include "client/python/module/module.h"

namespace camway::python {
namespace {

/// The member in which an object has its source.
PyObject* source_name() {
  static PyObject* const name = PyUnicode_InternFromString("_source");
  return name;
}

/// Returns an attribute without asking for it from the source; none if the object has it not.
py::object held(py::handle object, PyObject* name) {
  PyObject* const found = PyObject_GenericGetAttr(object.ptr(), name);
  if (found == nullptr) forget_error();
  return py::reinterpret_steal<py::object>(found);
}

void hold(py::handle object, PyObject* name, const py::object& value) {
  if (PyObject_GenericSetAttr(object.ptr(), name, value.ptr()) != 0) {
    throw py::error_already_set();
  }
}

/// Gives an object a member that it does not have yet, and returns it.
py::object fill_member(const py::object& object, const py::str& name) {
  const py::object source = held(object, source_name());
  py::object made = source ? source.cast<const Source&>().member(name) : py::object();
  if (!made) {
    throw py::attribute_error("'" + type_name(object) + "' object has no attribute " +
                              std::string(py::str(py::repr(name))));
  }
  // Python ran meanwhile. Another thread may have been first, and all must see the same object.
  if (py::object first = held(object, name.ptr())) return first;
  hold(object, name.ptr(), made);
  return made;
}

}  // namespace

py::object object_of(const ClassOf& known, std::unique_ptr<Source> source) {
  auto* const type = reinterpret_cast<PyTypeObject*>(known.type);
  const auto made =
      py::reinterpret_steal<py::object>(type->tp_new(type, py::tuple().ptr(), nullptr));
  if (!made) throw py::error_already_set();
  hold(made, source_name(), py::cast(std::move(source)));
  return made;
}

void add_lazy(py::module_& module) {
  py::class_<Source>(module, "Source", "A value of C++ whose members an object gets one by one.");
  module.def("fill_member", &fill_member, py::arg("object"), py::arg("name"),
             "Gives an object a member of its source that it does not have yet, and returns it.");
}

}  // namespace camway::python
