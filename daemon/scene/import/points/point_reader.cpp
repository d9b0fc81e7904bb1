// SPDX-License-Identifier: MIT
#include "daemon/scene/import/points/point_reader.h"

#include <array>
#include <cmath>
#include <limits>

#include "daemon/scene/import/points/las_reader.h"
#include "daemon/scene/import/points/pcd_reader.h"
#include "daemon/scene/import/points/xyz_reader.h"
#include "daemon/scene/import/readers/decimal.h"
#include "daemon/scene/import/readers/tokens.h"

namespace camway::scene::point_readers {
namespace {

using Reader = base::Result<import_record::Record> (*)(std::string_view);

struct Format {
  std::string_view extension;
  Reader read;
};

constexpr std::array<Format, 3> kFormats = {
    {{".pcd", read_pcd}, {".xyz", read_xyz}, {".las", read_las}}};

const Format* format_of(std::string_view extension) {
  for (const Format& format : kFormats) {
    if (mesh_readers::equals_ignoring_case(extension, format.extension)) return &format;
  }
  return nullptr;
}

}  // namespace

bool is_point_extension(std::string_view extension) { return format_of(extension) != nullptr; }

base::Result<import_record::Record> read_points(std::string_view extension,
                                                std::string_view bytes) {
  base::Result<import_record::Record> read = format_of(extension)->read(bytes);
  if (read) read->header.is_cloud = 1;
  return read;
}

std::optional<double> number_in(std::string_view token) {
  const double value = mesh_readers::parse_decimal(token);
  if (!std::isnan(value)) return value;
  if (token.starts_with('-') || token.starts_with('+')) token.remove_prefix(1);
  // "nan(ind)" and the like, as C writes them.
  if (!mesh_readers::equals_ignoring_case(token.substr(0, 3), "nan")) return std::nullopt;
  token.remove_prefix(3);
  const bool is_nan = token.empty() || (token.starts_with('(') && token.ends_with(')'));
  return is_nan ? std::optional(std::numeric_limits<double>::quiet_NaN()) : std::nullopt;
}

}  // namespace camway::scene::point_readers
