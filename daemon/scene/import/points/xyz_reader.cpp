// SPDX-License-Identifier: MIT
#include "daemon/scene/import/points/xyz_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "daemon/geometry/rounding.h"
#include "daemon/scene/import/points/point_reader.h"
#include "daemon/scene/import/readers/tokens.h"

namespace camway::scene::point_readers {
namespace {

namespace layout = import_record;
using mesh_readers::equals_ignoring_case;
using mesh_readers::take_line;
using mesh_readers::take_token;
using mesh_readers::trimmed;

std::string_view without_remark(std::string_view line) {
  return line.substr(0, std::min(line.find('#'), line.find("//")));
}

/// Splits a line at its commas, else at its semicolons, else at its blanks. Between commas and
/// semicolons, the last item may be missing: lines may end with one.
void split(std::string_view line, std::vector<std::string_view>& columns) {
  columns.clear();
  const char separator = line.find(',') != std::string_view::npos   ? ','
                         : line.find(';') != std::string_view::npos ? ';'
                                                                    : '\0';
  if (separator == '\0') {
    for (auto word = take_token(line); !word.empty(); word = take_token(line)) {
      columns.push_back(word);
    }
    return;
  }
  while (!line.empty()) {
    const std::size_t end = std::min(line.find(separator), line.size());
    columns.push_back(trimmed(line.substr(0, end)));
    line.remove_prefix(std::min(end + 1, line.size()));
  }
}

/// The columns of x, y and z.
using Places = std::array<std::size_t, 3>;

/// The columns that a header names.
Places places_in(const std::vector<std::string_view>& names) {
  constexpr std::array<std::string_view, 3> kNames = {"x", "y", "z"};
  Places places{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto found = std::ranges::find_if(names, [&](std::string_view name) {
      if (name.size() > 2 && name.front() == '"' && name.back() == '"') {
        name = name.substr(1, name.size() - 2);
      }
      return equals_ignoring_case(name, kNames[k]);
    });
    if (found == names.end()) return {0, 1, 2};
    places[k] = static_cast<std::size_t>(found - names.begin());
  }
  return places;
}

class XyzReader {
 public:
  base::Result<layout::Record> read(std::string_view bytes) {
    for (std::size_t number = 1; !bytes.empty(); ++number) {
      split(trimmed(without_remark(take_line(bytes))), columns_);
      if (columns_.empty()) continue;
      const bool may_be_header = !is_header_over_;
      is_header_over_ = true;
      if (may_be_header && !number_in(columns_.front())) {
        places_ = places_in(columns_);
        continue;
      }
      if (std::string fault = add_point(); !fault.empty()) {
        return base::Failure{fmt::format("line {}: {}", number, fault)};
      }
    }
    if (record_.vertices.empty()) return base::Failure{"holds no point"};
    record_.text = "XYZ, points";
    record_.header.relative_rounding = geometry::kUnitRoundoff;
    return std::move(record_);
  }

 private:
  std::string add_point() {
    if (columns_.size() <= *std::ranges::max_element(places_)) {
      return fmt::format("has {} columns, which are too few for a point", columns_.size());
    }
    layout::Vertex point{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::optional<double> value = number_in(columns_[places_[k]]);
      if (!value) {
        return fmt::format("'{}' is no number{}", columns_[places_[k]].substr(0, kLongestShown),
                           columns_[places_[k]].find(' ') == std::string_view::npos
                               ? ""
                               : " (commas between digits are not read)");
      }
      point[k] = *value;
    }
    record_.vertices.push_back(point);
    return {};
  }

  static constexpr std::size_t kLongestShown = 40;

  layout::Record record_;
  std::vector<std::string_view> columns_;
  Places places_{0, 1, 2};
  bool is_header_over_ = false;
};

}  // namespace

base::Result<layout::Record> read_xyz(std::string_view bytes) { return XyzReader().read(bytes); }

}  // namespace camway::scene::point_readers
