// SPDX-License-Identifier: MIT
#include "tools/camway/door_request.h"

#include <filesystem>
#include <memory>
#include <utility>
#include <variant>

#include "daemon/planning/request/validate.h"
#include "tools/camway/common/request_file.h"
#include "tools/json/json_document.h"

namespace camway::tools {

base::Result<DoorRequest> read_door_request(const std::string& file) {
  const base::Result<std::string> text = read_text(file);
  if (!text) return base::Failure{text.error};
  base::Result<RequestFile> request = read_request_text(*text, file);
  if (!request) return base::Failure{request.error};
  if (const auto fault = planning::validate(*request)) {
    return base::Failure{source_of(file) + ": " + fault->message};
  }
  return DoorRequest{*std::move(request), nlohmann::json::parse(*text)};
}

view::PlanOrder plan_order(DoorRequest request, const std::string& scene) {
  request.document["scene"] = scene;
  if (request.request.body_file && request.request.body) {
    const auto& mesh = std::get<motion::MeshShape>(*request.request.body);
    nlohmann::json vertices = nlohmann::json::array();
    for (const geometry::Vec3& v : mesh.vertices_C) vertices.push_back({v.x(), v.y(), v.z()});
    request.document["body"] = {{"type", "mesh"},
                                {"vertices", std::move(vertices)},
                                {"triangles", mesh.triangles},
                                {"solid", mesh.solid}};
  }
  return {scene, std::move(request.request),
          std::make_shared<const std::string>(request.document.dump())};
}

std::string place_name(const std::string& file) {
  std::string name = std::filesystem::path(file).stem().string();
  for (char& c : name) {
    const bool is_kept = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                         (c >= '0' && c <= '9') || c == '-' || c == '.';
    if (!is_kept) c = '_';
  }
  return name.empty() ? "scene" : name;
}

}  // namespace camway::tools
