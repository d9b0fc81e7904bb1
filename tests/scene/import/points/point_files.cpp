// SPDX-License-Identifier: MIT
#include "tests/scene/import/points/point_files.h"

#include <fmt/format.h>
#include <liblzf/lzf.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace camway::scene::point_files {
namespace {

using camway::testing::Random;

template <class T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class T>
void put_at(std::string& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

struct Field {
  std::string name;
  PcdType type;
  int count = 1;
  int axis = -1;  ///< of x, y and z
};

std::vector<Field> fields_of(PcdType type, Random* random) {
  std::vector<Field> fields;
  for (int axis = 0; axis < 3; ++axis)
    fields.push_back({std::string(1, "xyz"[axis]), type, 1, axis});
  if (random == nullptr) return fields;
  const std::vector<PcdType> types = {{'U', 1}, {'I', 2}, {'U', 4}, {'F', 4}, {'I', 8}, {'F', 8}};
  for (int i = random->integer(1, 4); i > 0; --i) {
    const PcdType other = types[static_cast<std::size_t>(random->integer(0, 5))];
    fields.push_back({fmt::format("other{}", i), other, random->integer(1, 5), -1});
  }
  std::shuffle(fields.begin(), fields.end(), *random);
  return fields;
}

void put_number(std::string& bytes, PcdType type, double value) {
  if (type.type == 'F') {
    type.bytes == 4 ? put(bytes, static_cast<float>(value)) : put(bytes, value);
    return;
  }
  // Two's complement: the lower bytes are those of the shorter type.
  const auto whole = static_cast<std::int64_t>(value);
  bytes.append(reinterpret_cast<const char*>(&whole), static_cast<std::size_t>(type.bytes));
}

/// All values of a field of a point.
void put_field(std::string& bytes, const Field& field, const std::array<double, 3>& point) {
  for (int i = 0; i < field.count; ++i) {
    put_number(bytes, field.type,
               field.axis < 0 ? 7.0 : point[static_cast<std::size_t>(field.axis)]);
  }
}

std::string header_of(const std::vector<Field>& fields, std::size_t points,
                      std::string_view encoding) {
  std::string names;
  std::string sizes;
  std::string types;
  std::string counts;
  for (const Field& field : fields) {
    names += " " + field.name;
    sizes += fmt::format(" {}", field.type.bytes);
    types += fmt::format(" {}", field.type.type);
    counts += fmt::format(" {}", field.count);
  }
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS{}\nSIZE{}\nTYPE{}\n"
      "COUNT{}\nWIDTH {}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA {}\n",
      names, sizes, types, counts, points, points, encoding);
}

std::string text_of(const PointList& points, const std::vector<Field>& fields) {
  std::string text;
  for (const auto& point : points) {
    std::string line;
    for (const Field& field : fields) {
      for (int i = 0; i < field.count; ++i) {
        line +=
            fmt::format("{} ", field.axis < 0 ? 7.0 : point[static_cast<std::size_t>(field.axis)]);
      }
    }
    text += line + "\n";
  }
  return text;
}

std::string compressed(const std::string& values) {
  std::string packed(values.size() + values.size() / 16 + 64, '\0');
  const unsigned size = lzf_compress(values.data(), static_cast<unsigned>(values.size()),
                                     packed.data(), static_cast<unsigned>(packed.size()));
  packed.resize(size);
  std::string bytes;
  put(bytes, static_cast<std::uint32_t>(packed.size()));
  put(bytes, static_cast<std::uint32_t>(values.size()));
  return bytes + packed;
}

}  // namespace

PointList random_points(Random& random, std::size_t count, double half,
                        const std::array<double, 3>& middle) {
  constexpr double kPerUnit = 1024.0;
  PointList points(count);
  for (auto& point : points) {
    for (std::size_t k = 0; k < 3; ++k) {
      point[k] = std::round((middle[k] + random.uniform(-half, half)) * kPerUnit) / kPerUnit;
    }
  }
  return points;
}

std::string write_pcd(const PointList& points, PcdEncoding encoding, PcdType type, Random* random) {
  const std::vector<Field> fields = fields_of(type, random);
  if (encoding == PcdEncoding::kText) {
    return header_of(fields, points.size(), "ascii") + text_of(points, fields);
  }
  std::string values;
  if (encoding == PcdEncoding::kBinary) {
    for (const auto& point : points) {
      for (const Field& field : fields) put_field(values, field, point);
    }
    return header_of(fields, points.size(), "binary") + values;
  }
  for (const Field& field : fields) {
    for (const auto& point : points) put_field(values, field, point);
  }
  return header_of(fields, points.size(), "binary_compressed") + compressed(values);
}

std::string write_xyz(const PointList& points, std::string_view separator,
                      std::string_view header) {
  std::string text(header);
  for (const auto& point : points) {
    text += fmt::format("{}{}{}{}{}\n", point[0], separator, point[1], separator, point[2]);
  }
  return text;
}

std::string write_las(const PointList& points, const LasKind& kind) {
  constexpr std::array<int, 11> kBytes = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  const std::size_t header_bytes = kind.minor_version == 4   ? 375
                                   : kind.minor_version == 3 ? 235
                                                             : 227;
  const int record_bytes = kBytes[static_cast<std::size_t>(kind.format)] + kind.extra_bytes;
  std::string bytes(header_bytes, '\0');
  bytes.replace(0, 4, "LASF");
  put_at<std::uint8_t>(bytes, 24, 1);
  put_at(bytes, 25, static_cast<std::uint8_t>(kind.minor_version));
  put_at(bytes, 94, static_cast<std::uint16_t>(header_bytes));
  put_at(bytes, 96, static_cast<std::uint32_t>(header_bytes));
  put_at(bytes, 104, static_cast<std::uint8_t>(kind.format));
  put_at(bytes, 105, static_cast<std::uint16_t>(record_bytes));
  // From version 1.4 on the old count may be 0.
  if (kind.minor_version == 4) {
    put_at(bytes, 247, static_cast<std::uint64_t>(points.size()));
  } else {
    put_at(bytes, 107, static_cast<std::uint32_t>(points.size()));
  }
  put_at(bytes, 131, kind.scale);
  put_at(bytes, 155, kind.offset);
  for (const auto& point : points) {
    for (std::size_t k = 0; k < 3; ++k) {
      put(bytes,
          static_cast<std::int32_t>(std::lround((point[k] - kind.offset[k]) / kind.scale[k])));
    }
    bytes.append(static_cast<std::size_t>(record_bytes) - 12, '\0');
  }
  return bytes;
}

}  // namespace camway::scene::point_files
