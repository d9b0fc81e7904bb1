// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "tools/camway/replay/session.h"

namespace camway::tools {

/// A value of a request or its answer, by the name that it has in tables and messages: a number, a
/// text or a truth value; null if there is none.
struct AnswerColumn {
  std::string_view name;
  nlohmann::ordered_json value;
};

/// Returns the values of a request, in the same order for all requests.
std::vector<AnswerColumn> answer_columns(const RecordedRequest& request);

/// Returns the names of all columns, in their order.
std::vector<std::string_view> answer_column_names();

}  // namespace camway::tools
