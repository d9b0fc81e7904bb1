// SPDX-License-Identifier: MIT
#include "client/python/module/convert.h"

namespace camway::python {
namespace {

/// The table of members here must be the list of the class's arguments there.
template <IsDescribed T>
void load_class(const py::module_& types) {
  py::object type = types.attr(Described<T>::kName);
  py::tuple names(Described<T>::kMembers.size());
  for (std::size_t i = 0; i < Described<T>::kMembers.size(); ++i) {
    PyTuple_SET_ITEM(names.ptr(), static_cast<py::ssize_t>(i),
                     PyUnicode_InternFromString(Described<T>::kMembers[i]));
  }
  if (!names.equal(type.attr("__match_args__"))) {
    throw py::import_error(std::string("camway._types.") + Described<T>::kName +
                           " is not of the same build as camway._native");
  }
  class_of<T>() = {type.release().ptr(), names.release().ptr()};
}

}  // namespace

void load_classes(const py::module_& types) {
  const auto load = [&]<class... T>(std::tuple<T...>*) { (load_class<T>(types), ...); };
  load(static_cast<DescribedTypes*>(nullptr));
}

void register_faults(const py::module_& errors) {
  static PyObject* const make = py::object(errors.attr("error_of")).release().ptr();
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(thrown);
    } catch (const ConversionFault& fault) {
      PyErr_SetString(
          fault.kind() == ConversionFault::Kind::kType ? PyExc_TypeError : PyExc_ValueError,
          fault.what());
    } catch (const Failed& failed) {
      const py::object error = py::handle(make)(to_python(failed.status), to_python(failed.text));
      PyErr_SetObject(py::type::handle_of(error).ptr(), error.ptr());
    }
  });
}

}  // namespace camway::python
