// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "daemon/base/result.h"
#include "tools/view/backend.h"
#include "tools/view/mesh_desk.h"
#include "tools/view/page_files.h"
#include "tools/view/review/review_data.h"

namespace camway::view {

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

/// The page of a review before its data, which is an object of JSON (`json_for_html`), and after.
struct ReviewFrame {
  std::string begin, end;
};

/// Returns the frame of the page's files; nothing if the page has no places for them.
std::optional<ReviewFrame> review_frame(const PageFiles& page);

/// The reason why there are no reviews in a program without its page, a sentence.
inline constexpr char kNoPage[] = "there is no review: this program was built without its page";

}  // namespace camway::view
