// SPDX-License-Identifier: MIT
#include "daemon/scene/import/import_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace camway::scene {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(ImportWarnings, AreSilentAboutASoundImport) {
  ImportReport report;
  report.rounding_m = 1e-3;
  report.dropped_points_and_lines = 5;  // no surface, nothing to collide with
  EXPECT_THAT(import_warnings(report, 1e-3), IsEmpty());
  EXPECT_THAT(import_warnings(report, std::nullopt), IsEmpty());
}

TEST(ImportWarnings, CountWhatIsLeftOut) {
  ImportReport report;
  report.dropped_nonfinite = 1;
  report.dropped_bad_index = 2;
  report.dropped_freeform = 3;
  report.degenerate_triangles = 4;
  EXPECT_THAT(
      import_warnings(report, std::nullopt),
      ElementsAre("the scene is without faces of its file: 1 with a coordinate that is no "
                  "usable number, 2 with a vertex that does not exist, 3 that are free-form "
                  "surfaces, 4 of zero area"));
  report = {};
  report.dropped_bad_index = 7;
  EXPECT_THAT(import_warnings(report, 1.0),
              ElementsAre("the scene is without faces of its file: 7 with a vertex that does not "
                          "exist"));
}

TEST(ImportWarnings, KnowWhatARequestIsAbout) {
  EXPECT_EQ(finest_length_m(1e-3, 0.0), 1e-3);
  EXPECT_EQ(finest_length_m(1e-3, 0.1), 1e-3);
  EXPECT_EQ(finest_length_m(1e-3, 1e-4), 1e-4);
}

TEST(ImportWarnings, SetRoundingAgainstWhatIsAskedFor) {
  ImportReport report;
  report.rounding_m = 0.06;
  report.single_precision = true;
  EXPECT_THAT(import_warnings(report, 1e-3),
              ElementsAre("the scene's coordinates may be off by 0.06 m, which is more than the "
                          "0.001 m that the request asks for: files of this format are read in "
                          "single precision"));
  report.single_precision = false;
  EXPECT_THAT(import_warnings(report, 1e-3),
              ElementsAre(::testing::HasSubstr("doubles are no finer")));
}

TEST(ImportWarnings, SetSmoothSurfacesAgainstWhatIsAskedFor) {
  ImportReport report;
  report.surface_error_m = 0.02;
  EXPECT_THAT(import_warnings(report, 0.01, kOfDefault),
              ElementsAre(HasSubstr("the 0.01 m that requests ask for by default: ")));
  EXPECT_THAT(import_warnings(report, 0.02), IsEmpty());
  EXPECT_THAT(import_warnings(report, std::nullopt), IsEmpty());
  EXPECT_THAT(
      import_warnings(report, 0.01),
      ElementsAre("the scene's smooth surfaces are flat facets within 0.02 m, which is more "
                  "than the 0.01 m that the request asks for: paths keep that far from all of the "
                  "scene"));
}

}  // namespace
}  // namespace camway::scene
