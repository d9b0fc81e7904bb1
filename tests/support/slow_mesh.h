// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

namespace camway::testing {

/// Writes an OBJ file that takes minutes to read, longer than an import may, but little memory: one
/// polygon in which every second corner is reflex and may block any ear. The file appears under its
/// name when it is complete.
inline void write_slow_mesh(const std::string& file) {
  constexpr int kCorners = 100'000;
  constexpr double kFullTurn_rad = 6.283185307179586;
  const std::string unfinished = file + ".part";
  std::ofstream out(unfinished);
  for (int i = 0; i < kCorners; ++i) {
    const double angle_rad = kFullTurn_rad * i / kCorners;
    const double scattered = std::fmod(i * 0.618034, 1.0);
    const double radius_m = 1.0 + 0.5 * (i % 2) + 0.3 * scattered;
    out << "v " << radius_m * std::cos(angle_rad) << ' ' << radius_m * std::sin(angle_rad)
        << " 0\n";
  }
  out << 'f';
  for (int i = 1; i <= kCorners; ++i) out << ' ' << i;
  out << '\n';
  out.close();
  std::filesystem::rename(unfinished, file);
}

}  // namespace camway::testing
