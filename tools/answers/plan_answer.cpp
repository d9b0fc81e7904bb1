// SPDX-License-Identifier: MIT
#include "tools/answers/plan_answer.h"

#include <fmt/format.h>

#include "daemon/planning/plan.h"
#include "daemon/planning/request/quaternion_order.h"
#include "daemon/planning/result/witness_names.h"
#include "daemon/scene/import/import_warnings.h"
#include "tools/answers/scene_record.h"
#include "tools/json/json_response.h"

namespace camway::tools {

std::vector<std::string> request_warnings(const RequestFile& request) {
  using planning::QuaternionOrder;
  if (request.has_imported_order) return {};
  const auto order = planning::quaternion_order_warning(
      request, request.says_xyzw ? QuaternionOrder::kXyzw : QuaternionOrder::kWxyz);
  if (!order) return {};
  return {fmt::format("{}; {} takes the other order", *order,
                      request.says_xyzw ? "orientation" : "orientation_xyzw")};
}

void plan_in_scene(const scene::Snapshot& snapshot, const RequestFile& request,
                   const base::Deadline& deadline, PlanAnswer& answer) {
  answer.scene_digest = snapshot.digest;
  answer.vertical_axis = vertical_axis(
      answer.scene_reading ? std::optional(answer.scene_reading->up) : std::nullopt, request);
  const planning::PlanOptions& options = request.options;
  answer.scene_warnings = scene::import_warnings(
      snapshot.report, scene::finest_length_m(options.interval_tolerance_m, options.clearance_m));
  answer.request_warnings = request_warnings(request);
  answer.result = planning::plan(snapshot, request, deadline);
  planning::name_witnesses(snapshot.mesh, request, answer.result);
}

base::Result<std::string> answer_text(const PlanAnswer& answer, bool has_timing) {
  ResponseFormat format;
  format.has_timing = has_timing;
  format.scene = answer.scene;
  format.scene_digest = answer.scene_digest;
  format.scene_reading = answer.scene_reading;
  format.vertical_axis = answer.vertical_axis;
  format.warnings = answer.scene_warnings;
  format.warnings.insert(format.warnings.end(), answer.request_warnings.begin(),
                         answer.request_warnings.end());
  return write_plan_response(answer.result, format);
}

}  // namespace camway::tools
