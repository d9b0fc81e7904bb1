// SPDX-License-Identifier: MIT
#include "daemon/scene/import/camera_import.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <system_error>
#include <utility>

#include "daemon/scene/import/import.h"

namespace camway::scene {
namespace {

/// More animations than any file has.
constexpr double kMostTakes = 1e6;

/// Removes the first word, and the blank after it.
std::string_view take_word(std::string_view& line) {
  const std::size_t size = std::min(line.find(' '), line.size());
  const std::string_view word = line.substr(0, size);
  line.remove_prefix(std::min(size + 1, line.size()));
  return word;
}

/// Reads numbers to the end of a line. Returns false if there are others than `numbers.size()`.
template <std::size_t N>
bool take_numbers(std::string_view line, std::array<double, N>& numbers) {
  for (double& number : numbers) {
    const std::string_view word = take_word(line);
    const char* const end = word.data() + word.size();
    const auto [read, error] = std::from_chars(word.data(), end, number);
    if (error != std::errc{} || read != end || !std::isfinite(number)) return false;
  }
  return line.empty();
}

std::optional<double> if_known(double value) {
  return value > 0.0 ? std::optional(value) : std::nullopt;
}

bool take_lens(std::string_view line, double unit_m, SceneFileCamera& camera) {
  std::array<double, 3> n{};
  if (!take_numbers(line, n)) return false;
  camera.fov_x_rad = if_known(n[0]);
  camera.aspect = if_known(n[1]);
  camera.near_m = if_known(n[2] * unit_m);
  return true;
}

bool take_takes(std::string_view line, SceneFileCamera& camera) {
  std::array<double, 1> n{};
  if (!take_numbers(line, n) || !(n[0] >= 0.0 && n[0] <= kMostTakes)) return false;
  camera.takes = static_cast<int>(n[0]);
  return true;
}

bool take_key(std::string_view line, double unit_m, SceneFileCamera& camera) {
  std::array<double, 8> n{};
  if (!take_numbers(line, n)) return false;
  camera.keys.push_back(
      {n[0], unit_m * geometry::Vec3(n[1], n[2], n[3]), geometry::Quat(n[4], n[5], n[6], n[7])});
  return true;
}

}  // namespace

base::Result<std::vector<SceneFileCamera>> cameras_from(const std::string& text, double unit_m) {
  std::vector<SceneFileCamera> cameras;
  std::string_view rest = text;
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const std::string_view word = take_word(line);
    bool is_sound = word == "camera";
    if (is_sound) {
      cameras.emplace_back().name = line;
    } else if (!cameras.empty()) {
      is_sound = (word == "lens" && take_lens(line, unit_m, cameras.back())) ||
                 (word == "takes" && take_takes(line, cameras.back())) ||
                 (word == "key" && take_key(line, unit_m, cameras.back()));
    }
    if (!is_sound) {
      return base::Failure{"its cameras are wrong in line " + std::to_string(number)};
    }
  }
  return cameras;
}

}  // namespace camway::scene
