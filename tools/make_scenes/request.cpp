// SPDX-License-Identifier: MIT
#include "tools/make_scenes/request.h"

#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace camway::make_scenes {
namespace {

/// Returns cosine and sine of half the angle with this cosine and sine, in (-90, 90] degrees. Uses
/// square roots only.
std::array<double, 2> half_angle(double cosine, double sine) {
  if (cosine >= 0.0) {
    const double c = std::sqrt((1.0 + cosine) / 2.0);
    return {c, sine / (2.0 * c)};
  }
  const double s = std::copysign(std::sqrt((1.0 - cosine) / 2.0), sine);
  return {sine / (2.0 * s), s};
}

Direction between(const Point& from, const Point& to) {
  Direction d{};
  for (std::size_t i = 0; i < 3; ++i) d[i] = static_cast<double>(to[i] - from[i]);
  return d;
}

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.12f", value == 0.0 ? 0.0 : value);
  return text;
}

}  // namespace

Quaternion look_along(const Direction& f) {
  const double level = std::sqrt(f[0] * f[0] + f[2] * f[2]);
  const double length = std::sqrt(level * level + f[1] * f[1]);
  if (!(length > 0.0)) throw std::logic_error("a view looks nowhere");
  const std::array<double, 2> yaw =
      level > 0.0 ? half_angle(-f[2] / level, -f[0] / level) : std::array<double, 2>{1.0, 0.0};
  const std::array<double, 2> pitch = half_angle(level / length, f[1] / length);
  return {yaw[0] * pitch[0], yaw[0] * pitch[1], yaw[1] * pitch[0], -yaw[1] * pitch[1]};
}

Quaternion rolled_90(const Quaternion& q) {
  const double h = std::sqrt(0.5);
  return {h * (q[0] - q[3]), h * (q[1] + q[2]), h * (q[2] - q[1]), h * (q[3] + q[0])};
}

std::vector<View> along(const std::vector<Point>& eyes) {
  std::vector<View> views;
  for (std::size_t i = 0; i < eyes.size(); ++i) {
    const Point& before = eyes[i == 0 ? 0 : i - 1];
    const Point& after = eyes[i + 1 == eyes.size() ? i : i + 1];
    views.push_back({eyes[i], look_along(between(before, after))});
  }
  return views;
}

std::vector<View> facing(const std::vector<Point>& eyes, const Direction& forward) {
  std::vector<View> views;
  for (const Point& eye : eyes) views.push_back({eye, look_along(forward)});
  return views;
}

std::string to_json(const Request& request, const std::string& scene) {
  std::string text = "{\n  \"scene\": \"../" + scene + "\",\n  \"camera\": {\"fov_x_deg\": " +
                     std::to_string(request.lens.fov_x_deg) +
                     ", \"fov_y_deg\": " + std::to_string(request.lens.fov_y_deg) +
                     ", \"near\": " + metres(request.lens.near) + "},\n  \"keyframes\": [\n";
  for (std::size_t i = 0; i < request.views.size(); ++i) {
    const View& view = request.views[i];
    text += "    {";
    if (!request.times_ms.empty()) {
      text += "\"time\": " + metres(Um{request.times_ms.at(i)} * 1000) + ", ";
    }
    text += "\"position\": [" + metres(view.eye[0]) + ", " + metres(view.eye[1]) + ", " +
            metres(view.eye[2]) + "], \"orientation\": [";
    for (std::size_t k = 0; k < 4; ++k) text += (k == 0 ? "" : ", ") + number(view.orientation[k]);
    text += i + 1 < request.views.size() ? "]},\n" : "]}\n";
  }
  return text + "  ]\n}\n";
}

}  // namespace camway::make_scenes
