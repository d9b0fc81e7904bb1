// SPDX-License-Identifier: MIT
#include <future>
#include <memory>
#include <string>
#include <thread>

#include <nlohmann/json.hpp>

#include "client/python/module/documents.h"
#include "client/python/module/exit_gate.h"
#include "client/python/module/interruption.h"
#include "client/python/module/lazy.h"
#include "client/python/module/module.h"
#include "client/python/module/scene.h"
#include "daemon/base/deadline.h"
#include "tools/answers/check_input.h"
#include "tools/answers/check_report.h"
#include "tools/answers/plan_answer.h"

namespace camway::python {
namespace {

using std::chrono::steady_clock;

/// Runs `work(deadline)` in another thread. A signal stops it; `on_progress`, if there is one, is
/// called in this thread.
template <class Work>
auto run(double deadline_s, const py::object& on_progress, const Work& work) {
  using Answer = decltype(work(std::declval<const base::Deadline&>()));
  std::stop_source stop;
  const auto progress = std::make_shared<base::Progress>();
  const base::Deadline deadline =
      base::Deadline::after_s(deadline_s).watched(stop.get_token(), progress);
  std::packaged_task<Answer()> task([&] { return work(deadline); });
  std::future<Answer> answer = task.get_future();
  std::jthread thread(std::move(task));
  const auto end = [&] {
    stop.request_stop();
    thread.join();
  };
  const auto look = [&] {
    if (on_progress.is_none()) return;
    PlanProgress now;
    now.stage = static_cast<PlanProgress::Stage>(progress->stage.load());
    now.num_collisions = progress->collisions;
    now.num_corrected = progress->corrected;
    now.since_receipt_s = deadline.elapsed_ms() / 1000.0;
    now.deadline_s = deadline_s;
    try {
      on_progress(to_python(now));
    } catch (const py::error_already_set&) {
      const WithoutGil others_may_run;
      end();
      throw;
    }
  };
  wait_for(answer, no_end(), end, look);
  const WithoutGil others_may_run;
  thread.join();
  return answer.get();
}

py::tuple plan_given(const LoadedScene& scene, const tools::RequestFile& request,
                     const py::object& on_progress) {
  const CountedCall counted;
  tools::PlanAnswer answer;
  answer.scene_reading = scene.reading;
  run(request.options.deadline_s, on_progress, [&](const base::Deadline& deadline) {
    tools::plan_in_scene(*scene.snapshot, request, deadline, answer);
    return true;
  });
  std::vector<std::string> warnings = answer.scene_warnings;
  warnings.insert(warnings.end(), answer.request_warnings.begin(), answer.request_warnings.end());
  const scene::Snapshot& snapshot = *scene.snapshot;
  const MadeIn made_in{snapshot.name, static_cast<std::int64_t>(snapshot.revision),
                       snapshot.digest};
  py::list list;
  for (const std::string& warning : warnings) list.append(warning);
  return py::make_tuple(lazy_to_python(to_answer(answer.result, made_in)), list);
}

tools::RequestFile file_of(py::handle object) {
  tools::RequestFile file;
  static_cast<planning::PlanRequest&>(file) = to_planning(argument<PlanRequest>(object, "request"));
  return file;
}

py::tuple plan_request(const LoadedScene& scene, py::handle request,
                       const py::object& on_progress) {
  return plan_given(scene, file_of(request), on_progress);
}

py::tuple plan_json(const LoadedScene& scene, const std::string& text, const std::string& source,
                    const std::string& folder, const py::object& on_progress) {
  return plan_given(scene, read_request(text, source, folder), on_progress);
}

/// Checks a path against a scene; both documents are JSON texts.
py::tuple check(const LoadedScene& scene, const std::string& request_text,
                const std::string& path_text, const std::string& folder) {
  const CountedCall counted;
  const tools::RequestFile request = read_request(request_text, "request", folder);
  const auto file = tools::parse_as<tools::PathFile>(path_text, "answer");
  if (!file) throw Failed{Status::kInvalid, file.error};
  auto input = tools::check_input(request, *file, {"request", "answer"});
  if (!input) throw Failed{Status::kInvalid, input.error};
  input->snapshot = scene.snapshot;
  const tools::PathSearch search =
      run(request.options.deadline_s, py::none(),
          [&](const base::Deadline& deadline) { return tools::search_path(*input, deadline); });
  return py::make_tuple(search.certificate.certified, tools::check_json(*input, search).dump(),
                        tools::check_text(*input, search));
}

}  // namespace

void add_planning(py::module_& module) {
  module.def("plan_request", &plan_request, py::arg("scene"), py::arg("request"),
             py::arg("on_progress"), "Plans; returns the answer and warnings.");
  module.def("plan_json", &plan_json, py::arg("scene"), py::arg("text"), py::arg("source"),
             py::arg("folder"), py::arg("on_progress"), "Plans a request file.");
  module.def("check", &check, py::arg("scene"), py::arg("request"), py::arg("path"),
             py::arg("folder"),
             "Checks a path; returns whether it is free, the report as JSON, and as text.");
}

}  // namespace camway::python
