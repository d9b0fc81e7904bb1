// SPDX-License-Identifier: MIT
#include "daemon/scene/import/points/pcd_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "daemon/scene/import/readers/decimal.h"
#include "daemon/scene/import/readers/tokens.h"

namespace camway::scene::point_readers {
namespace {

using mesh_readers::parse_integer;
using mesh_readers::take_token;

/// Far beyond any file, and small enough for sums and products of two.
constexpr std::int64_t kMostValues = 1'000'000;
constexpr std::int64_t kMostPoints = std::int64_t{1} << 40;

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (auto word = take_token(line); !word.empty(); word = take_token(line)) words.push_back(word);
  return words;
}

bool is_number(const PcdField& field) {
  const std::size_t bytes = field.bytes;
  if (field.type == 'F') return bytes == 4 || bytes == 8;
  return (field.type == 'I' || field.type == 'U') &&
         (bytes == 1 || bytes == 2 || bytes == 4 || bytes == 8);
}

class HeaderReader {
 public:
  base::Result<PcdHeader> take(std::string_view& bytes) {
    while (!bytes.empty() && !is_over_) {
      ++header_.lines;
      // Not `take_line`: of binary data that follow, a first byte must not count as an end of line.
      const std::size_t end = std::min(bytes.find('\n'), bytes.size());
      std::string_view line = bytes.substr(0, end);
      bytes.remove_prefix(std::min(end + 1, bytes.size()));
      if (std::string fault = read_line(words_of(line.substr(0, line.find('#')))); !fault.empty()) {
        return base::Failure{fmt::format("line {}: {}", header_.lines, fault)};
      }
    }
    if (!is_over_) return base::Failure{"is no PCD file: it has no line DATA"};
    if (std::string fault = finish(); !fault.empty()) return base::Failure{fault};
    return std::move(header_);
  }

 private:
  std::string read_line(std::vector<std::string_view> words) {
    if (words.empty()) return {};
    const std::string_view key = words.front();
    words.erase(words.begin());
    if (key == "VERSION") return {};
    if (key == "FIELDS" || key == "COLUMNS") return read_fields(words);
    if (key == "SIZE") return read_numbers(words, &PcdField::bytes, "SIZE");
    if (key == "COUNT") return read_numbers(words, &PcdField::count, "COUNT");
    if (key == "TYPE") return read_types(words);
    if (key == "WIDTH") return read_count(words, width_, "WIDTH");
    if (key == "HEIGHT") return read_count(words, height_, "HEIGHT");
    if (key == "POINTS") return read_count(words, points_, "POINTS");
    if (key == "VIEWPOINT") return read_viewpoint(words);
    if (key == "DATA") return read_data(words);
    return fmt::format("'{}' is no word of a PCD header", key.substr(0, kLongestShown));
  }

  std::string read_fields(const std::vector<std::string_view>& words) {
    if (!header_.fields.empty()) return "fields are named twice";
    if (words.size() > kMostFields) return "has too many fields";
    for (const std::string_view word : words) header_.fields.push_back({.name = word});
    return {};
  }

  std::string read_numbers(const std::vector<std::string_view>& words,
                           std::size_t PcdField::*member, std::string_view key) {
    if (words.size() != header_.fields.size()) return other_number(words.size(), key);
    for (std::size_t i = 0; i < words.size(); ++i) {
      const std::optional<std::int64_t> value = parse_integer(words[i]);
      if (!value || *value < 1 || *value > kMostValues) {
        return fmt::format("{} {} is no number from 1 to {}", key,
                           words[i].substr(0, kLongestShown), kMostValues);
      }
      header_.fields[i].*member = static_cast<std::size_t>(*value);
    }
    return {};
  }

  std::string read_types(const std::vector<std::string_view>& words) {
    if (words.size() != header_.fields.size()) return other_number(words.size(), "TYPE");
    for (std::size_t i = 0; i < words.size(); ++i) header_.fields[i].type = words[i].front();
    return {};
  }

  [[nodiscard]] std::string other_number(std::size_t words, std::string_view key) const {
    return fmt::format("{} has {} words for {} fields", key, words, header_.fields.size());
  }

  static std::string read_count(const std::vector<std::string_view>& words,
                                std::optional<std::size_t>& count, std::string_view key) {
    const std::optional<std::int64_t> value =
        words.size() == 1 ? parse_integer(words[0]) : std::nullopt;
    if (!value || *value < 0 || *value > kMostPoints) {
      return fmt::format("{} is no number from 0 to {}", key, kMostPoints);
    }
    count = static_cast<std::size_t>(*value);
    return {};
  }

  std::string read_viewpoint(const std::vector<std::string_view>& words) {
    constexpr std::size_t kW = 3;  // x y z qw qx qy qz
    for (std::size_t i = 0; i < words.size(); ++i) {
      const double value = mesh_readers::parse_decimal(words[i]);
      if (value != (i == kW ? 1.0 : 0.0)) header_.has_viewpoint = true;
    }
    return {};
  }

  std::string read_data(const std::vector<std::string_view>& words) {
    is_over_ = true;
    const std::string_view kind = words.empty() ? std::string_view() : words[0];
    if (kind == "ascii") header_.data = PcdData::kAscii;
    if (kind == "binary") header_.data = PcdData::kBinary;
    if (kind == "binary_compressed") header_.data = PcdData::kCompressed;
    const bool is_known = kind == "ascii" || kind == "binary" || kind == "binary_compressed";
    return is_known ? "" : "DATA is neither ascii nor binary nor binary_compressed";
  }

  std::string finish() {
    for (PcdField& field : header_.fields) {
      field.offset = header_.point_bytes;
      field.column = header_.columns;
      header_.point_bytes += field.bytes * field.count;
      header_.columns += field.count;
    }
    if (header_.point_bytes > static_cast<std::size_t>(kMostValues)) {
      return "has points of more than a million bytes";
    }
    if (std::string fault = find_xyz(); !fault.empty()) return fault;
    // A product that overflows is more than any file has.
    const std::size_t width = width_.value_or(0);
    const std::size_t height = height_.value_or(1);
    const bool is_sound = width == 0 || height <= static_cast<std::size_t>(kMostPoints) / width;
    if (!is_sound) return fmt::format("WIDTH {} and HEIGHT {} are too large", width, height);
    const std::size_t by_size = width * height;
    if (points_ && width_ && *points_ != by_size) {
      return fmt::format("POINTS is {}, but WIDTH times HEIGHT is {}", *points_, by_size);
    }
    header_.points = points_.value_or(by_size);
    return header_.points == 0 ? "holds no point" : "";
  }

  std::string find_xyz() {
    constexpr std::array<std::string_view, 3> kNames = {"x", "y", "z"};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto found = std::ranges::find(header_.fields, kNames[k], &PcdField::name);
      if (found == header_.fields.end()) return fmt::format("has no field {}", kNames[k]);
      if (found->count != 1 || !is_number(*found)) {
        return fmt::format("its field {} is no single number (TYPE {}, SIZE {}, COUNT {})",
                           kNames[k], found->type, found->bytes, found->count);
      }
      header_.xyz[k] = static_cast<std::size_t>(found - header_.fields.begin());
    }
    return {};
  }

  static constexpr std::size_t kLongestShown = 40;
  static constexpr std::size_t kMostFields = 10'000;

  PcdHeader header_;
  std::optional<std::size_t> width_;
  std::optional<std::size_t> height_;
  std::optional<std::size_t> points_;
  bool is_over_ = false;
};

}  // namespace

base::Result<PcdHeader> take_pcd_header(std::string_view& bytes) {
  return HeaderReader().take(bytes);
}

}  // namespace camway::scene::point_readers
