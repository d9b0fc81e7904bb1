// SPDX-License-Identifier: MIT
#include "daemon/process/settings/bounds_text.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <system_error>

namespace camway::process {
namespace {

/// An empty text means no limit. Returns false if the text is no finite number.
bool read_limit(std::string_view text, double& limit_m) {
  if (text.empty()) return true;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), limit_m);
  return error == std::errc{} && end == text.data() + text.size() && std::isfinite(limit_m);
}

}  // namespace

base::Result<geometry::Bounds> parse_bounds(std::string_view text) {
  const auto fail = [&](const std::string& reason) {
    return base::Failure{"bounds '" + std::string(text) + "': " + reason};
  };
  geometry::Bounds bounds;
  std::string_view rest = text;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const std::size_t slash = rest.find('/');
    if ((slash == std::string_view::npos) != (axis == 2))
      return fail(std::string("must be ") + kBoundsForm);
    const std::string_view range = rest.substr(0, slash);
    const std::size_t dots = range.find("..");
    if (dots == std::string_view::npos || !read_limit(range.substr(0, dots), bounds.min_W[axis]) ||
        !read_limit(range.substr(dots + 2), bounds.max_W[axis]))
      return fail("'" + std::string(range) + "' must be two numbers with '..' between, or either");
    if (axis < 2) rest.remove_prefix(slash + 1);
  }
  if (const auto fault = geometry::fault_in(bounds))
    return fail(fault->field + " " + fault->reason);
  return bounds;
}

std::string bounds_text(const geometry::Bounds& bounds) {
  std::string text;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (axis > 0) text += '/';
    if (std::isfinite(bounds.limit_m(axis))) text += fmt::format("{}", bounds.limit_m(axis));
    text += "..";
    if (std::isfinite(bounds.limit_m(axis + 3)))
      text += fmt::format("{}", bounds.limit_m(axis + 3));
  }
  return text;
}

}  // namespace camway::process
