// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "daemon/base/result.h"
#include "tools/view/backend.h"
#include "tools/view/mesh_desk.h"
#include "tools/view/page_files.h"

namespace camway::view {

/// A plan that is to be shown without a door.
struct ReviewOrder {
  PlanOrder plan;
  std::string answer;  ///< to that request, as JSON
};

/// Reads `{"request": ..., "answer": ...}`. The answer must be one (`planning::PlanResult`).
base::Result<ReviewOrder> read_review(const nlohmann::json& document);

/// A page that is one file, or why there is none.
struct ReviewFile {
  std::string html;
  int code = code::kOk;
  std::string error = {};  ///< a sentence; empty with `code::kOk`
};

/// Makes the page of a plan: script, style and data in one file of HTML, which shows the plan
/// without a server and may ask nobody. The scene is as `backend` has it now, as its meshes are for
/// display. Waits for the backend, so it is not for threads of it.
ReviewFile make_review(const ReviewOrder& order, const PageFiles& page, Backend& backend,
                       MeshDesk& meshes);

}  // namespace camway::view
