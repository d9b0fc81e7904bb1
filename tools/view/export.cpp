// SPDX-License-Identifier: MIT
#include "tools/view/export.h"

#include <fmt/format.h>

#include <utility>

#include "tools/cameras/export/path_export.h"
#include "tools/view/review/review.h"

namespace camway::view {

ExportFile make_export(const nlohmann::json& document, std::string_view format) {
  const auto fail = [](std::string error) {
    return ExportFile{{}, {}, code::kInvalid, std::move(error)};
  };
  const tools::CameraFormat* const found = tools::camera_format(format);
  if (found == nullptr || found->write == nullptr) {
    std::string names;
    for (const auto& each : export_formats()) names += " " + each.at("name").get<std::string>();
    return fail(fmt::format("format: is none of:{}", names));
  }
  base::Result<ReviewOrder> order = read_review(document);
  if (!order) return fail(order.error);
  const tools::ExportDocuments documents{*order->plan.text, "request", order->answer, "answer"};
  const base::Result<tools::PathExport> path =
      tools::path_export(order->plan.request, documents, *found, {});
  if (!path) return fail(path.error);
  base::Result<std::string> bytes = tools::written_file(*path, tools::dense_track(*path));
  if (!bytes) return fail("answer: " + bytes.error);
  return {*std::move(bytes), fmt::format("camera{}", found->extension)};
}

nlohmann::ordered_json export_formats() {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const tools::CameraFormat& format : tools::camera_formats()) {
    if (format.write == nullptr) continue;
    list.push_back(
        {{"name", format.name}, {"extension", format.extension}, {"help", format.description}});
  }
  return list;
}

}  // namespace camway::view
