// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/base/deadline.h"
#include "daemon/base/result.h"
#include "daemon/planning/result/result.h"
#include "daemon/scene/import/record/import_options.h"
#include "daemon/scene/import/record/vertical_axis.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tools/json/json_request.h"

namespace camway::tools {

/// The answer to a request, with everything that its file says beside the result.
struct PlanAnswer {
  planning::PlanResult result;
  std::string scene;         ///< file or name of the scene
  std::string scene_digest;  ///< empty if no scene was planned in
  /// How this process read the file of the scene; nothing if it did not read it.
  std::optional<scene::ImportOptions> scene_reading;
  std::optional<scene::VerticalAxis> vertical_axis;  ///< nothing if it is not known
  std::vector<std::string> scene_warnings;           ///< warnings of the scene's import
  std::vector<std::string> request_warnings;         ///< a sentence each
};

/// Returns warnings about the request, a sentence each.
std::vector<std::string> request_warnings(const RequestFile& request);

/// Plans in `snapshot`, and sets everything but `answer.scene` and `answer.scene_reading`, which
/// the caller sets before. The answer depends on snapshot and request alone, timing apart, unless
/// `deadline` strikes: whoever plans, its bytes are equal. Requires a request that
/// `planning::validate` accepts. Thread-safe.
void plan_in_scene(const scene::Snapshot& snapshot, const RequestFile& request,
                   const base::Deadline& deadline, PlanAnswer& answer);

/// Returns the answer as JSON text (`write_plan_response`).
base::Result<std::string> answer_text(const PlanAnswer& answer, bool has_timing = true);

}  // namespace camway::tools
