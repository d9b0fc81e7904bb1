// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "tools/view/answer.h"

namespace camway::view {

/// A file of a path for another program, or why there is none.
struct ExportFile {
  std::string bytes;
  std::string name;  ///< "camera.csv"
  int code = code::kOk;
  std::string error = {};  ///< a sentence; empty with `code::kOk`
};

/// Writes the path of `{"request": ..., "answer": ...}` in a format of `camway export`, with a pose
/// for each frame. What is played between frames is not proved.
ExportFile make_export(const nlohmann::json& document, std::string_view format);

/// Returns the formats: `[{"name": ..., "extension": ..., "help": ...}, ...]`.
nlohmann::ordered_json export_formats();

}  // namespace camway::view
