// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>
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
  const py::array any = py::array::ensure(times);
  if (!any || !has_numbers(any)) {
    forget_error();
    throw py::type_error("times_s: must be an array of numbers, not " + type_name(times));
  }
  const auto given = Times::ensure(any);
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

/// Returns an array of `points` by `numbers` for each segment, which begin at `offset` in it. The
/// array is a read-only view: its memory is the path's, which it keeps.
py::array view_of(const py::object& owner, std::size_t offset, py::ssize_t points,
                  py::ssize_t numbers) {
  constexpr auto kNumber = static_cast<py::ssize_t>(sizeof(double));
  const std::vector<Segment>& segments = owner.cast<const Path&>().segments();
  const auto count = static_cast<py::ssize_t>(segments.size());
  if (count == 0) return py::array_t<double>({count, points, numbers});
  py::array view(py::dtype::of<double>(), {count, points, numbers},
                 {static_cast<py::ssize_t>(sizeof(Segment)), numbers * kNumber, kNumber},
                 reinterpret_cast<const std::byte*>(segments.data()) + offset, owner);
  view.attr("setflags")(py::arg("write") = false);
  return view;
}

py::array joints_of(const Path& path) {
  const std::vector<Segment>& segments = path.segments();
  py::array_t<double> joints(static_cast<py::ssize_t>(segments.empty() ? 0 : segments.size() + 1));
  double* time = joints.mutable_data();
  for (const Segment& segment : segments) *time++ = segment.t0_s;
  if (!segments.empty()) *time = segments.back().t1_s;
  return joints;
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
      .def_property_readonly(
          "joints_s", &joints_of,
          "A new array of the instants at which segments begin, and the last one: N + 1 for N "
          "segments.")
      .def_property_readonly(
          "control_positions_m",
          [](const py::object& path) { return view_of(path, offsetof(Segment, position_m), 4, 3); },
          "`Segment.position_m` of all N segments, as a read-only array of shape (N, 4, 3).")
      .def_property_readonly(
          "control_orientations_wxyz",
          [](const py::object& path) {
            return view_of(path, offsetof(Segment, orientation_wxyz), 7, 4);
          },
          "`Segment.orientation_wxyz` of all N segments, as a read-only array of shape (N, 7, 4).")
      .def(
          "pose",
          [](const Path& path, py::handle time_s) {
            return to_python(path.pose(argument<double>(time_s, "time_s")));
          },
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
