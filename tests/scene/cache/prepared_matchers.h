// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <cstring>

#include "daemon/scene/cache/prepared_scene.h"

namespace camway::testing {

/// Whether both have the same bits; 0 and -0 differ.
template <class Values>
bool has_same_bits(const Values& a, const Values& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(a[0])) == 0;
}

inline bool has_same_bits(const geometry::Box& a, const geometry::Box& b) {
  return has_same_bits(a.min(), b.min()) && has_same_bits(a.max(), b.max());
}

inline void expect_same_report(const scene::ImportReport& a, const scene::ImportReport& b) {
  EXPECT_EQ(a.format, b.format);
  EXPECT_EQ(a.scale, b.scale);
  EXPECT_EQ(a.up, b.up);
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.objects, b.objects);
  EXPECT_TRUE(has_same_bits(a.bounds_m, b.bounds_m));
  EXPECT_EQ(a.degenerate_triangles, b.degenerate_triangles);
  EXPECT_EQ(a.dropped_nonfinite, b.dropped_nonfinite);
  EXPECT_EQ(a.dropped_bad_index, b.dropped_bad_index);
  EXPECT_EQ(a.dropped_points_and_lines, b.dropped_points_and_lines);
  EXPECT_EQ(a.dropped_freeform, b.dropped_freeform);
  EXPECT_EQ(a.ignored_statements, b.ignored_statements);
  EXPECT_EQ(a.single_precision, b.single_precision);
  EXPECT_EQ(a.rounding_m, b.rounding_m);
  EXPECT_EQ(a.surface_error_m, b.surface_error_m);
}

inline void expect_same_mesh(const scene::Mesh& a, const scene::Mesh& b) {
  EXPECT_TRUE(has_same_bits(a.vertices, b.vertices));
  EXPECT_EQ(a.triangles, b.triangles);
  ASSERT_EQ(a.objects.size(), b.objects.size());
  for (std::size_t i = 0; i < a.objects.size(); ++i) {
    EXPECT_EQ(a.objects[i].name, b.objects[i].name);
    EXPECT_EQ(a.objects[i].first_triangle, b.objects[i].first_triangle);
    EXPECT_EQ(a.objects[i].triangle_count, b.objects[i].triangle_count);
  }
}

inline void expect_same(const scene::PreparedScene& a, const scene::PreparedScene& b) {
  expect_same_mesh(*a.indexed->mesh, *b.indexed->mesh);
  EXPECT_TRUE(a.indexed->tree.arrays() == b.indexed->tree.arrays());
  EXPECT_TRUE(has_same_bits(a.indexed->tree.bounds(), b.indexed->tree.bounds()));
  expect_same_report(a.report, b.report);
  ASSERT_EQ(a.field == nullptr, b.field == nullptr);
  if (a.field) {
    EXPECT_TRUE(a.field->codes() == b.field->codes());
    EXPECT_TRUE(a.field->statistics() == b.field->statistics());
  }
  EXPECT_EQ(a.why_no_field, b.why_no_field);
  EXPECT_EQ(a.digest, b.digest);
}

}  // namespace camway::testing
