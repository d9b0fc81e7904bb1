// SPDX-License-Identifier: MIT
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/scene/import/import.h"
#include "daemon/scene/import/import_process.h"
#include "tests/support/temporary_folder.h"

namespace camway::scene {

/// Imports Open Inventor and VRML scenes that are written as text.
class InventorScene : public ::testing::Test {
 protected:
  static constexpr std::string_view kInventor = "#Inventor V2.1 ascii\n";
  static constexpr std::string_view kVrml1 = "#VRML V1.0 ascii\n";
  static constexpr std::string_view kVrml97 = "#VRML V2.0 utf8\n";

  /// Imports and expects success.
  ImportResult read(std::string_view header, const std::string& text,
                    const std::string& name = "scene.iv") {
    ImportResult result = import_mesh(folder_.write(name, std::string(header) + text), {});
    EXPECT_EQ(result.error, "") << text;
    EXPECT_TRUE(result.mesh) << text;
    if (!result.mesh) result.mesh.emplace();
    return result;
  }
  /// Imports and expects a refusal.
  std::string refusal(std::string_view header, const std::string& text,
                      const std::string& name = "scene.iv") {
    const ImportResult result = import_mesh(folder_.write(name, std::string(header) + text), {});
    EXPECT_FALSE(result.mesh) << text;
    return result.error;
  }

  /// The triangles, each with its corners in order, in order.
  static std::vector<std::array<std::array<double, 3>, 3>> triangles_of(const Mesh& mesh) {
    std::vector<std::array<std::array<double, 3>, 3>> all;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      auto& corners = all.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const geometry::Vec3 v = mesh.triangle(i)[k];
        corners[k] = {v.x(), v.y(), v.z()};
      }
      std::ranges::sort(corners);
    }
    std::ranges::sort(all);
    return all;
  }
  static std::vector<std::string> names_of(const Mesh& mesh) {
    std::vector<std::string> names;
    for (const MeshObject& object : mesh.objects) names.push_back(object.name);
    return names;
  }
  static double area_of(const Mesh& mesh) {
    double area = 0.0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const auto t = mesh.triangle(i);
      area += 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
    }
    return area;
  }
  /// Positive if triangles turn counter-clockwise as seen from outside.
  static double volume_of(const Mesh& mesh) {
    double volume = 0.0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const auto t = mesh.triangle(i);
      volume += t[0].dot(t[1].cross(t[2])) / 6.0;
    }
    return volume;
  }

  testing::TemporaryFolder folder_;
};

}  // namespace camway::scene
