// SPDX-License-Identifier: MIT
#include "client/python/module/documents.h"

#include <filesystem>
#include <limits>
#include <utility>

#include "client/messages/convert.h"
#include "client/messages/plan.h"
#include "client/messages/plan_faults.h"
#include "client/python/module/lazy.h"
#include "client/python/module/module.h"
#include "daemon/messages/plan.h"
#include "daemon/planning/request/validate.h"
#include "tools/camway/common/request_file.h"
#include "tools/json/json_response.h"
#include "tools/support/client_request.h"
#include "tools/support/client_response.h"

namespace camway::python {
namespace {

template <class Value>
Value value_of(base::Result<Value> result) {
  if (!result) throw Failed{Status::kInvalid, std::move(result.error)};
  return *std::move(result.value);
}

/// Reads an answer. The document has the digest of its scene, but neither name nor revision.
PlanResponse answer_from_json(const std::string& text, const std::string& source) {
  const auto file = value_of(tools::parse_as<tools::ResponseFile>(text, source));
  return to_answer(file, {"", 0, file.scene_digest});
}

std::string answer_to_json(py::handle object, bool has_timing) {
  const auto answer = argument<PlanResponse>(object, "answer");
  if (!tools::has_result(answer.status)) {
    throw Failed{answer.status, "an answer with the status " + to_string(answer.status) +
                                    " has no result, so no JSON: " + answer.error};
  }
  tools::ResponseFormat format;
  format.has_timing = has_timing;
  format.scene = answer.scene;
  format.scene_digest = answer.scene_digest;
  return value_of(tools::write_plan_response(tools::to_plan_result(answer), format));
}

py::object request_from_json(const std::string& text, const std::string& source,
                             const std::string& folder) {
  const tools::RequestFile file = read_request(text, source, folder);
  return to_python(tools::to_client_request(file, file.scene));
}

std::string request_to_json(py::handle object) {
  const auto request = argument<PlanRequest>(object, "request");
  planning::PlanRequest file = to_planning(request);
  file.scene = request.scene;
  return value_of(tools::write_plan_request(file));
}

Path path_from_json(const std::string& text, const std::string& source) {
  const auto file = value_of(tools::parse_as<tools::PathFile>(text, source));
  return to_answer(file, {}).path;
}

std::string path_to_json(const Path& path) {
  PlanResponse answer;
  answer.status = Status::kOk;
  answer.path = path;
  return value_of(tools::write_path(tools::to_plan_result(answer).path));
}

}  // namespace

planning::PlanRequest to_planning(const PlanRequest& request) {
  if (auto fault = fault_in_form(request)) throw Failed{Status::kInvalid, *fault};
  plan_request_t wire{};
  convert(request, wire);
  // A daemon has a largest deadline; here nobody else waits.
  messages::DeadlineLimits limits;
  limits.max_s = std::numeric_limits<double>::max();
  auto mine = messages::from_wire(wire, limits);
  if (!mine) throw Failed{Status::kInvalid, mine.error};
  if (const auto fault = planning::validate(*mine)) throw Failed{Status::kInvalid, fault->message};
  return *std::move(mine.value);
}

tools::RequestFile read_request(const std::string& text, const std::string& source,
                                const std::string& folder) {
  const bool is_here = folder.empty() || folder == ".";
  const std::string name = is_here ? source : (std::filesystem::path(folder) / source).string();
  auto file = tools::read_request_text(text, name);
  if (!file) throw Failed{Status::kInvalid, file.error};
  if (const auto fault = planning::validate(*file)) {
    throw Failed{Status::kInvalid, name + ": " + fault->message};
  }
  return *std::move(file.value);
}

PlanResponse to_answer(const planning::PlanResult& result, const MadeIn& scene) {
  messages::AnswerHeader header;
  header.scene = scene.scene;
  header.scene_revision = scene.revision;
  header.scene_digest = scene.digest;
  const plan_response_t wire = messages::to_wire(result, header);
  PlanResponse answer;
  convert(wire, answer);
  std::vector<Segment> segments;
  convert(wire.segments, segments);
  answer.path = Path(std::move(segments));
  if (!answer.ok()) answer.error = to_string(answer.status) + ": " + answer.message;
  return answer;
}

void add_documents(py::module_& module) {
  module.def("request_from_json", &request_from_json, py::arg("text"), py::arg("source"),
             py::arg("folder"));
  module.def("request_to_json", &request_to_json, py::arg("request"));
  module.def(
      "answer_from_json",
      [](const std::string& text, const std::string& source) {
        return lazy_to_python(answer_from_json(text, source));
      },
      py::arg("text"), py::arg("source"));
  module.def("answer_to_json", &answer_to_json, py::arg("answer"), py::arg("has_timing"));
  module.def("path_from_json", &path_from_json, py::arg("text"), py::arg("source"));
  module.def("path_to_json", &path_to_json, py::arg("path"));
}

}  // namespace camway::python
