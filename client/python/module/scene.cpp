// SPDX-License-Identifier: MIT
#include "client/python/module/scene.h"

#include <pybind11/stl.h>

#include <filesystem>
#include <future>
#include <string>
#include <thread>

#include "client/python/module/convert.h"
#include "client/python/module/exit_gate.h"
#include "client/python/module/interruption.h"
#include "client/python/module/module.h"
#include "daemon/base/named_enum.h"
#include "daemon/scene/cache/mesh_check.h"
#include "daemon/scene/cache/scene_cache.h"
#include "daemon/scene/import/import_process.h"
#include "daemon/scene/import/import_warnings.h"
#include "daemon/scene/import/record/import_words.h"
#include "tools/support/client_request.h"

namespace camway::python {
namespace {

namespace fs = std::filesystem;
using scene::SnapshotOptions;
using scene::SnapshotResult;

template <base::NamedEnum Enum>
Enum choice(const std::string& text, const std::string& name) {
  const std::optional<Enum> value = base::value_of<Enum>(text);
  if (value) return *value;
  std::string known;
  for (const std::string_view each : names_of(Enum{})) {
    known += (known.empty() ? "" : ", ") + std::string(each);
  }
  throw py::value_error(name + ": '" + text + "' is unknown; the values are " + known);
}

geometry::Bounds bounds_of(py::handle object) {
  const auto bounds = argument<Bounds>(object, "body_bounds");
  return geometry::bounds_of({bounds.min_m, bounds.max_m});
}

/// Makes a scene by `make(stop)` in another thread, so that a signal can end the wait.
template <class Make>
LoadedScene made(Make make, std::optional<scene::ImportOptions> reading) {
  std::stop_source stop;
  std::packaged_task<SnapshotResult()> task([&] { return make(stop.get_token()); });
  std::future<SnapshotResult> made = task.get_future();
  std::jthread thread(std::move(task));
  // The thread is joined before the exception leaves, and ends soon after the stop.
  wait_for(made, no_end(), [&] { stop.request_stop(), thread.join(); });
  {
    const WithoutGil others_may_run;
    thread.join();
  }
  SnapshotResult result = made.get();
  if (result.snapshot) return {std::move(result.snapshot), std::move(reading)};
  throw Failed{result.limit == scene::Limit::kNone ? Status::kInvalid : Status::kLimit,
               result.error};
}

void warn(const std::string& text) {
  if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
}

/// Returns the user's cache, and warns of what is wrong with it.
std::optional<scene::SceneCache> usable_cache() {
  scene::UserCache user = scene::cache_of_environment();
  if (!user.fault.empty()) warn(user.fault);
  const std::string fault = user.cache ? user.cache->fault() : "";
  if (fault.empty()) return std::move(user.cache);
  warn(user.cache->folder().string() + ": " + fault + ", so it is not used as the cache of scenes");
  return std::nullopt;
}

LoadedScene load(const std::string& file, double scale, const std::string& up,
                 const std::string& unknown, std::optional<double> voxel_m, py::handle body_bounds,
                 bool use_cache) {
  const CountedCall counted;
  if (!(scale > 0.0)) throw py::value_error("scale: must be above 0");
  SnapshotOptions options;
  options.import.scale = scale;
  options.import.up = choice<scene::UpAxis>(up, "up");
  options.import.unknown = choice<scene::UnknownSpace>(unknown, "unknown");
  options.import.voxel_m = voxel_m;
  options.bounds = bounds_of(body_bounds);
  const std::optional<scene::SceneCache> cache = use_cache ? usable_cache() : std::nullopt;
  const auto read = [&](const std::stop_token& stop) {
    return scene::load_snapshot(file, file, options, stop, cache ? &*cache : nullptr);
  };
  return made(read, options.import);
}

LoadedScene from_arrays(py::handle vertices_m, py::handle triangles, const std::string& name,
                        py::handle body_bounds) {
  const CountedCall counted;
  const auto points = argument<std::vector<std::array<double, 3>>>(vertices_m, "vertices_m");
  const auto corners = argument<std::vector<std::array<std::int64_t, 3>>>(triangles, "triangles");
  scene::Mesh mesh;
  for (const auto& point : points) mesh.vertices.emplace_back(point[0], point[1], point[2]);
  for (const auto& each : corners) {
    for (const std::int64_t index : each) {
      if (!std::in_range<std::uint32_t>(index)) {
        throw py::value_error("triangles: no vertex has the index " + std::to_string(index));
      }
    }
    mesh.triangles.push_back({static_cast<std::uint32_t>(each[0]),
                              static_cast<std::uint32_t>(each[1]),
                              static_cast<std::uint32_t>(each[2])});
  }
  if (mesh.triangles.empty()) throw py::value_error("triangles: are none");
  const std::string fault = scene::fault_in_numbers(mesh, std::thread::hardware_concurrency());
  if (!fault.empty()) throw py::value_error(fault);
  mesh.objects.push_back({name, 0, static_cast<std::uint32_t>(mesh.triangles.size())});
  SnapshotOptions options;
  options.bounds = bounds_of(body_bounds);
  const auto build = [&](const std::stop_token&) {
    return scene::make_snapshot(name, std::move(mesh), options);
  };
  return made(build, std::nullopt);
}

SceneInfo info_of(const LoadedScene& scene) {
  const scene::Snapshot& snapshot = *scene.snapshot;
  SceneInfo info;
  info.name = snapshot.name;
  info.revision = static_cast<std::int64_t>(snapshot.revision);
  info.digest = snapshot.digest;
  info.num_triangles = static_cast<std::int64_t>(snapshot.mesh->triangles.size());
  info.body_bounds = tools::to_client_bounds(snapshot.options.bounds);
  const geometry::Box box = snapshot.mesh->bounds();
  if (info.num_triangles == 0) return info;
  std::copy_n(box.min().data(), 3, info.bounds_min_m.begin());
  std::copy_n(box.max().data(), 3, info.bounds_max_m.begin());
  return info;
}

}  // namespace

void add_scene(py::module_& module) {
  py::class_<LoadedScene>(module, "Scene",
                          "A scene in this process, to plan in without a daemon. Immutable, so "
                          "threads may share it. Made by `load` or `from_arrays`.")
      .def_static("load", &load, py::arg("file"), py::kw_only(), py::arg("scale") = 1.0,
                  py::arg("up") = "as-in-file", py::arg("unknown") = "free",
                  py::arg("voxel_m") = py::none(), py::arg("body_bounds"),
                  py::arg("use_cache") = true)
      .def_static("from_arrays", &from_arrays, py::arg("vertices_m"), py::arg("triangles"),
                  py::kw_only(), py::arg("name") = "scene", py::arg("body_bounds"))
      .def_property_readonly(
          "info", [](const LoadedScene& mine) { return to_python(info_of(mine)); },
          "The `camway.SceneInfo`: name, digest, number of triangles, bounds.")
      .def_property_readonly(
          "warnings",
          [](const LoadedScene& mine) {
            py::list list;
            for (const std::string& each : scene::import_warnings(mine.snapshot->report, {})) {
              list.append(each);
            }
            return list;
          },
          "Sentences about parts of the file that the import left out or rounded.");
  module.def(
      "set_import_program_folder",
      [](const std::string& folder) { scene::set_import_program_folder(folder); },
      py::arg("folder"), "Sets where the programs that read scene files are looked for first.");
}

}  // namespace camway::python
