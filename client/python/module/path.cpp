// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string>

#include "client/python/module/convert.h"
#include "client/python/module/exit_gate.h"
#include "client/python/module/module.h"

namespace camway::python {
namespace {

/// Returns why the segments are no path, as the client says it of an answer; empty if they are one.
std::string fault_in(const std::vector<Segment>& segments) {
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Segment& segment = segments[i];
    const std::string name = "segments[" + std::to_string(i) + "]: ";
    const double* const positions = segment.position_m.front().data();
    const double* const orientations = segment.orientation_wxyz.front().data();
    const auto finite = [](double number) { return std::isfinite(number); };
    if (!finite(segment.t0_s) || !finite(segment.t1_s) ||
        !std::all_of(positions, positions + 4 * 3, finite) ||
        !std::all_of(orientations, orientations + 7 * 4, finite)) {
      return name + "holds numbers that are not finite";
    }
    if (!(segment.t0_s < segment.t1_s)) return name + "does not end after it begins";
    if (i > 0 && segments[i - 1].t1_s != segment.t0_s) {
      return name + "does not begin where the one before ends";
    }
  }
  return {};
}

Path make_path(py::handle list) {
  auto segments = argument<std::vector<Segment>>(list, "segments");
  if (const std::string fault = fault_in(segments); !fault.empty()) throw py::value_error(fault);
  return Path(std::move(segments));
}

/// Evaluates the path at an array of times of any shape.
py::tuple evaluate(const Path& path, py::handle times) {
  const CountedCall counted;
  using Times = py::array_t<double, py::array::c_style | py::array::forcecast>;
  const Times given = Times::ensure(times);
  if (!given) {
    forget_error();
    throw py::type_error("times_s: must be an array of numbers, not " + type_name(times));
  }
  std::vector<py::ssize_t> shape(given.shape(), given.shape() + given.ndim());
  shape.push_back(3);
  py::array_t<double> positions(shape);
  shape.back() = 4;
  py::array_t<double> orientations(shape);
  const double* time = given.data();
  double* position = positions.mutable_data();
  double* orientation = orientations.mutable_data();
  const py::ssize_t count = given.size();
  {
    const WithoutGil others_may_run;
    for (py::ssize_t i = 0; i < count; ++i) {
      const Pose pose = path.pose(time[i]);
      position = std::copy_n(pose.position_m.data(), 3, position);
      orientation = std::copy_n(pose.orientation_wxyz.data(), 4, orientation);
    }
  }
  return py::make_tuple(positions, orientations);
}

bool equal(const Path& one, const Path& other) {
  const auto same = [](const Segment& a, const Segment& b) {
    return a.t0_s == b.t0_s && a.t1_s == b.t1_s && a.position_m == b.position_m &&
           a.orientation_wxyz == b.orientation_wxyz;
  };
  return std::equal(one.segments().begin(), one.segments().end(), other.segments().begin(),
                    other.segments().end(), same);
}

std::string text_of(const Path& path) {
  if (path.empty()) return "<camway.Path, empty>";
  const auto number = [](double value) { return std::string(py::str(py::float_(value))); };
  return "<camway.Path of " + std::to_string(path.segments().size()) + " segments, from " +
         number(path.begin()) + " s to " + number(path.end()) + " s>";
}

}  // namespace

void add_path(py::module_& module) {
  py::class_<Path>(module, "Path",
                   "A motion over time: consecutive segments, each beginning where the one before "
                   "ends. Immutable, so threads may share it.")
      .def(
          py::init(&make_path), py::arg("segments") = py::tuple(),
          "Makes a path of `camway.Segment`s in order of time. Raises ValueError for segments that "
          "are no path.")
      .def_property_readonly("begin_s", &Path::begin, "The first instant; 0 for an empty path.")
      .def_property_readonly("end_s", &Path::end, "The last instant; 0 for an empty path.")
      .def_property_readonly(
          "segments", [](const Path& path) { return to_python(path.segments()); },
          "A new list of the segments, with the numbers that were proved.")
      .def(
          "pose", [](const Path& path, double time_s) { return to_python(path.pose(time_s)); },
          py::arg("time_s"),
          "Returns the `camway.Pose` at a time. A time outside of the path gives its first or last "
          "pose; NaN, or an empty path, gives NaN.")
      .def(
          "evaluate", &evaluate, py::arg("times_s"),
          "Returns the positions and the orientations (w, x, y, z) at an array of times, as `pose` "
          "does: for N times, two arrays of N rows, with three and four columns. Other threads run "
          "meanwhile.")
      .def("__len__", [](const Path& path) { return path.segments().size(); })
      .def(
          "__eq__", [](const Path& one, const Path& other) { return equal(one, other); },
          py::is_operator())
      .def("__repr__", &text_of)
      .def("__reduce__", [](const Path& path) {
        return py::make_tuple(py::type::of<Path>(), py::make_tuple(to_python(path.segments())));
      });
}

}  // namespace camway::python
