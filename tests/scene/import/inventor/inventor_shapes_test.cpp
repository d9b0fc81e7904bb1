// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>
#include <sstream>

#include "tests/scene/import/inventor/inventor_scene.h"
#include "tests/support/random.h"

namespace camway::scene {
namespace {

constexpr std::uint64_t kTransformSeed = 3301;

using geometry::Vec3;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class InventorShapes : public InventorScene {};

const std::string kSquare = "Coordinate3 { point [ 0 0 0, 2 0 0, 2 2 0, 0 2 0 ] } ";

TEST_F(InventorShapes, FacesOfAllKindsAreTheSame) {
  const auto expected = triangles_of(
      *read(kInventor, kSquare + "IndexedFaceSet { coordIndex [ 0,1,2,-1,0,2,3 ] }").mesh);
  ASSERT_EQ(expected.size(), 2U);
  const std::string vertices =
      "vertexProperty VertexProperty { vertex [ 0 0 0, 2 0 0, 2 2 0, 0 2 0 ] } ";
  for (const std::string& text : {
           kSquare + "IndexedFaceSet { coordIndex [ 0,1,2,3,-1 ] }",
           kSquare + "FaceSet { numVertices [ 4 ] }",
           kSquare + "FaceSet { numVertices [ -1 ] }",
           "FaceSet { " + vertices + "numVertices 4 }",
           "IndexedFaceSet { " + vertices + "coordIndex [ 0,1,2,3 ] }",
           std::string("Coordinate4 { point [ 0 0 0 1, 4 0 0 2, 2 2 0 1, 0 1 0 0.5 ] } "
                       "IndexedFaceSet { coordIndex [ 0,1,2,3,-1 ] }"),
       }) {
    EXPECT_EQ(triangles_of(*read(kInventor, text).mesh).size(), 2U) << text;
    EXPECT_NEAR(area_of(*read(kInventor, text).mesh), 4.0, 1e-12) << text;
    EXPECT_GT(read(kInventor, text).mesh->triangle(0)[0].allFinite(), 0) << text;
  }
  EXPECT_EQ(triangles_of(*read(kVrml97,
                               "Shape { geometry IndexedFaceSet { coord Coordinate { point [ 0 "
                               "0 0 2 0 0 2 2 0 0 2 0 ] } coordIndex [ 0 1 2 -1 0 2 3 -1 ] } }")
                              .mesh),
            expected);
}

TEST_F(InventorShapes, StripsAndGridsTurnAsFacesDo) {
  const std::string points = "Coordinate3 { point [ 0 0 0, 0 2 0, 2 0 0, 2 2 0, 4 0 0, 4 2 0 ] } ";
  for (const std::string text : {"TriangleStripSet { numVertices 6 }",
                                 "IndexedTriangleStripSet { coordIndex [ 0,1,2,3,4,5,-1 ] }",
                                 "QuadMesh { verticesPerRow 2 verticesPerColumn 3 }"}) {
    const ImportResult result = read(kInventor, points + text);
    EXPECT_EQ(result.mesh->triangles.size(), 4U) << text;
    EXPECT_NEAR(area_of(*result.mesh), 8.0, 1e-12) << text;
    const auto normal = [&](std::size_t i) {
      const auto t = result.mesh->triangle(i);
      return (t[1] - t[0]).cross(t[2] - t[0]).z();
    };
    for (std::size_t i = 1; i < 4; ++i) EXPECT_GT(normal(i) * normal(0), 0.0) << text;
  }
}

TEST_F(InventorShapes, ConcavePolygonsAreCoveredExactly) {
  // An L of area 3, said to be convex.
  const ImportResult result = read(kInventor,
                                   "ShapeHints { faceType CONVEX } Coordinate3 { point [ 2 1 0, 1 "
                                   "1 0, 1 2 0, 0 2 0, 0 0 0, 2 0 0 ] } "
                                   "FaceSet { numVertices 6 }");
  EXPECT_DOUBLE_EQ(area_of(*result.mesh), 3.0);
}

TEST_F(InventorShapes, WhatTurnsTheOtherWayIsTurned) {
  const std::string cube = "Cube { }";
  EXPECT_DOUBLE_EQ(volume_of(*read(kInventor, cube).mesh), 8.0);
  EXPECT_DOUBLE_EQ(volume_of(*read(kInventor, "Scale { scaleFactor -1 1 1 } " + cube).mesh), 8.0);
  const std::string face = "IndexedFaceSet { coordIndex [ 0,1,2,-1 ] }";
  const auto normal_z = [&](const std::string& text) {
    const auto t = read(kInventor, kSquare + text + face).mesh->triangle(0);
    return (t[1] - t[0]).cross(t[2] - t[0]).z();
  };
  EXPECT_GT(normal_z(""), 0.0);
  EXPECT_LT(normal_z("ShapeHints { vertexOrdering CLOCKWISE } "), 0.0);
}

TEST_F(InventorShapes, SmoothShapesAreWithinTheStatedError) {
  struct Case {
    std::string text;
    double volume;
  };
  constexpr double kPi = std::numbers::pi;
  for (const Case& c : {Case{"Sphere { radius 3 }", 4.0 / 3.0 * kPi * 27.0},
                        Case{"Cylinder { radius 2 height 5 }", kPi * 4.0 * 5.0},
                        Case{"Cone { bottomRadius 2 height 6 }", kPi * 4.0 * 2.0}}) {
    const ImportResult plain = read(kInventor, c.text);
    EXPECT_GT(plain.report.surface_error_m, 0.0);
    EXPECT_LE(plain.report.surface_error_m, 3e-3);
    EXPECT_LT(volume_of(*plain.mesh), c.volume);
    EXPECT_GT(volume_of(*plain.mesh), (1.0 - 4e-3) * c.volume);
    const ImportResult vrml = read(kVrml97, "Shape { geometry " + c.text + " }");
    EXPECT_EQ(triangles_of(*vrml.mesh), triangles_of(*plain.mesh));
    EXPECT_EQ(vrml.report.unit_m, 1.0);
    // A transform's scale applies to the error: to its largest stretch.
    const ImportResult large =
        read(kInventor, "Rotation { rotation 1 2 3 1 } Scale { scaleFactor 10 1 1 } " + c.text);
    EXPECT_NEAR(large.report.surface_error_m, 10.0 * plain.report.surface_error_m,
                1e-5 * large.report.surface_error_m);
  }
}

TEST_F(InventorShapes, NurbsAreWithinTheStatedErrorOfTheirCircle) {
  const std::string w = "0.70710678";
  const ImportResult result =
      read(kInventor, "Coordinate4 { point [ 1 0 0 1, " + w + " " + w + " 0 " + w +
                          ", 0 1 0 1, 1 0 2 1, " + w + " " + w + " 1.41421356 " + w +
                          ", 0 1 2 1 ] } NurbsSurface { numUControlPoints 3 numVControlPoints 2 "
                          "uKnotVector [ 0 0 0 1 1 1 ] vKnotVector [ 0 0 1 1 ] }");
  EXPECT_GT(result.report.surface_error_m, 0.0);
  EXPECT_LT(result.report.surface_error_m, 2e-3);
  for (const Vec3& v : result.mesh->vertices) EXPECT_NEAR(std::hypot(v.x(), v.y()), 1.0, 1e-6);
  EXPECT_NEAR(area_of(*result.mesh), std::numbers::pi, 5e-3);
}

TEST_F(InventorShapes, SurfacesThatCannotBeReadAreCounted) {
  const ImportResult result =
      read(kInventor,
           "Cube { } Coordinate3 { point [ 0 0 0, 1 0 0, 0 1 0 ] } NurbsSurface { "
           "numUControlPoints 2 numVControlPoints 2 uKnotVector [ 0 0 1 1 ] vKnotVector "
           "[ 0 0 1 1 ] }");
  EXPECT_EQ(result.report.dropped_freeform, 1U);
  EXPECT_THAT(result.report.notes, Contains(HasSubstr("another number of control points")));
}

TEST_F(InventorShapes, ElevationsExtrusionsAndTextsHaveSurfaces) {
  const ImportResult grid =
      read(kVrml97,
           "Shape { geometry ElevationGrid { xDimension 3 zDimension 2 xSpacing 2 zSpacing "
           "3 height [ 0 0 0 0 0 0 ] } }");
  EXPECT_DOUBLE_EQ(area_of(*grid.mesh), 12.0);
  EXPECT_GT((grid.mesh->triangle(0)[1] - grid.mesh->triangle(0)[0])
                .cross(grid.mesh->triangle(0)[2] - grid.mesh->triangle(0)[0])
                .y(),
            0.0);
  const ImportResult tube =
      read(kVrml97,
           "Shape { geometry Extrusion { crossSection [ 1 1, 1 -1, -1 -1, -1 1, 1 1 ] spine [ 0 "
           "0 0, 0 5 0 ] } }");
  EXPECT_NEAR(area_of(*tube.mesh), 48.0, 1e-4);
  EXPECT_GT(read(kInventor, "Text3 { string \"Camway\" parts ALL }").mesh->triangles.size(), 50U);
}

TEST_F(InventorShapes, TransformsMoveAsTheirNumbersSay) {
  testing::Random random(kTransformSeed);
  for (int trial = 0; trial < 25; ++trial) {
    Eigen::Affine3d total = Eigen::Affine3d::Identity();
    std::ostringstream text;
    text.precision(17);
    for (int link = random.integer(1, 5); link-- > 0;) {
      const Vec3 move = random.in_cube(100.0);
      const Vec3 centre = random.in_cube(100.0);
      const Vec3 axis = random.in_cube(1.0);
      const Vec3 factors = random.in_cube(1.0) + Vec3::Constant(1.5);
      const double angle = random.uniform(-3.0, 3.0);
      const Eigen::AngleAxisd turn(angle, axis.normalized());
      switch (random.integer(0, 3)) {
        case 0:
          text << "Translation { translation " << move.transpose() << " }\n";
          total.translate(move);
          break;
        case 1:
          text << "Rotation { rotation " << axis.transpose() << " " << angle << " }\n";
          total.rotate(turn);
          break;
        case 2:
          text << "Scale { scaleFactor " << factors.transpose() << " }\n";
          total.scale(factors);
          break;
        default:
          text << "Transform { translation " << move.transpose() << " rotation " << axis.transpose()
               << " " << angle << " scaleFactor " << factors.transpose() << " center "
               << centre.transpose() << " }\n";
          total.translate(move + centre).rotate(turn).scale(factors).translate(-centre);
      }
    }
    const std::array<Vec3, 3> corners = {Vec3(1, 2, 3), Vec3(-4, 5, 6), Vec3(7, -8, 9)};
    const ImportResult result =
        read(kInventor, text.str() +
                            "Coordinate3 { point [ 1 2 3, -4 5 6, 7 -8 9 ] } FaceSet { "
                            "numVertices 3 }");
    ASSERT_EQ(result.mesh->vertices.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 off = result.mesh->vertices[i] - total * corners[i];
      EXPECT_LE(off.cwiseAbs().maxCoeff(), result.report.rounding_m) << text.str();
    }
    EXPECT_LT(result.report.rounding_m, 1.0);
  }
}

TEST_F(InventorShapes, TheRoundingOfTransformsThatCancelIsBounded) {
  const ImportResult result =
      read(kInventor,
           "Translation { translation 12345678.6 0 0 } Translation { translation -12345677.9 0 "
           "0 } Coordinate3 { point [ 0 0 0, 0 1 0, 0 0 1 ] } FaceSet { numVertices 3 }");
  const double off = std::abs(result.mesh->vertices[0].x() - 0.7);
  EXPECT_GT(off, 0.0) << "floats hold the sum, and the case shows nothing";
  EXPECT_LE(off, result.report.rounding_m);
}

TEST_F(InventorShapes, TheSameSceneAsObjHasTheSameTriangles) {
  const ImportResult obj = import_mesh(
      folder_.write("scene.obj",
                    "v 5 0 0\nv 7 0 0\nv 7 4 0\nv 5 4 0\nf 1 2 3 4\nv 0 0 8\nv 0 2 8\nv "
                    "-2 2 8\nf 5 6 7\n"),
      {});
  const ImportResult inventor = read(
      kInventor, kSquare +
                     "Separator { Translation { translation 5 0 0 } Scale { scaleFactor 1 2 1 } "
                     "IndexedFaceSet { coordIndex [ 0,1,2,3,-1 ] } } Translation { translation 0 "
                     "0 8 } MatrixTransform { matrix 0 1 0 0 -1 0 0 0 0 0 1 0 0 0 0 1 } "
                     "IndexedFaceSet { coordIndex [ 0,1,2,-1 ] }");
  ASSERT_TRUE(obj.mesh);
  EXPECT_EQ(triangles_of(*inventor.mesh), triangles_of(*obj.mesh));
}

TEST_F(InventorShapes, UnitsScaleAndNestAsTheSpecificationSays) {
  const ImportResult result =
      read(kInventor,
           "Units { units CENTIMETERS } Cube { width 100 } Units { units METERS } Cube { "
           "width 7 }");
  EXPECT_NEAR(result.report.bounds_m.sizes().x(), 7.0, 1e-6);
  EXPECT_NEAR(
      read(kInventor, "Units { units INCHES } Cube { width 100 }").report.bounds_m.sizes().x(),
      2.54, 1e-6);
}

TEST_F(InventorShapes, ObjectsAreNamedByTheNearestName) {
  const ImportResult result =
      read(kInventor,
           "DEF house Separator { Cube { } DEF door Cube { width 3 } Separator { Cone { } } } "
           "Sphere { }");
  EXPECT_THAT(names_of(*result.mesh), ElementsAre("house", "door", "house", "Sphere"));
}

TEST_F(InventorShapes, EachUseIsAnObject) {
  const ImportResult result =
      read(kVrml97,
           "DEF table Transform { children Shape { geometry Box { } } } Transform { "
           "translation 5 0 0 children [ USE table USE table ] }");
  EXPECT_THAT(names_of(*result.mesh), ElementsAre("table", "table", "table"));
  EXPECT_EQ(result.report.triangles, 36U);
  EXPECT_DOUBLE_EQ(result.report.bounds_m.max().x(), 6.0);
}

TEST_F(InventorShapes, ASwitchShowsWhatItChooses) {
  const auto count = [&](const std::string& which) {
    return read(kInventor,
                "Cube { } Switch { whichChild " + which + " Cube { } Cube { } Cube { } }")
        .report.objects;
  };
  EXPECT_EQ(count("-1"), 1U);
  EXPECT_EQ(count("1"), 2U);
  EXPECT_EQ(count("-3"), 4U);
  EXPECT_THAT(read(kInventor, "Cube { } Switch { whichChild 1 Cube { } Cube { } }").report.notes,
              Contains("1 children of switches are not chosen, and were not read"));
  EXPECT_EQ(read(kVrml97,
                 "Switch { whichChoice 1 choice [ Shape { geometry Sphere { } } Shape { "
                 "geometry Box { } } ] }")
                .report.triangles,
            12U);
}

TEST_F(InventorShapes, OfLevelsOfDetailTheFinestCounts) {
  for (const std::string text :
       {"LOD { range [ 0.001, 0.002 ] Cube { } Sphere { } Cone { } }",
        "LevelOfDetail { screenArea [ 1e9, 1e8 ] Cube { } Sphere { } Cone { } }"}) {
    const ImportResult result = read(kInventor, text);
    EXPECT_EQ(result.report.triangles, 12U) << text;
    EXPECT_THAT(result.report.notes, Contains(HasSubstr("2 coarser levels"))) << text;
  }
  EXPECT_EQ(read(kVrml97,
                 "LOD { range [ 0.001 ] level [ Shape { geometry Box { } } Shape { geometry "
                 "Sphere { } } ] }")
                .report.triangles,
            12U);
}

TEST_F(InventorShapes, ArraysAndCopiesAreObjects) {
  const ImportResult array =
      read(kInventor,
           "Array { numElements1 3 separation1 5 0 0 numElements2 2 separation2 0 7 0 Cube { } }");
  EXPECT_EQ(array.report.objects, 6U);
  EXPECT_EQ(array.report.bounds_m.max(), Vec3(11, 8, 1));
}

TEST_F(InventorShapes, TimeStandsStill) {
  // A rotor turns by the clock; so would the scene.
  const std::string text = "Rotor { speed 1000 rotation 0 0 1 0.3 } Cube { width 4 }";
  const auto once = triangles_of(*read(kInventor, text).mesh);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(triangles_of(*read(kInventor, text).mesh), once);
}

TEST_F(InventorShapes, PointsLinesAndWhatIsInvisibleAreCounted) {
  const ImportResult result = read(
      kInventor, "Cube { } " + kSquare +
                     "IndexedLineSet { coordIndex [ 0,1,-1,1,2,3,-1 ] } LineSet { "
                     "numVertices [ 2, 2 ] } PointSet { } Text2 { string \"a\" } DrawStyle { style "
                     "INVISIBLE } Sphere { }");
  EXPECT_EQ(result.report.triangles, 12U);
  EXPECT_EQ(result.report.dropped_points_and_lines, 2U + 2U + 4U + 1U);
  EXPECT_THAT(result.report.notes, Contains("1 shapes of draw style INVISIBLE were not read"));
}

TEST_F(InventorShapes, IndicesWithoutAVertexAreCounted) {
  const ImportResult result = read(
      kInventor, kSquare +
                     "IndexedFaceSet { coordIndex [ 0,1,2,-1, 0,1,99,-1 ] } FaceSet { "
                     "numVertices [ 3, 2000000000 ] } TriangleStripSet { numVertices 2000000 }");
  EXPECT_EQ(result.report.dropped_bad_index, 3U);
}

TEST_F(InventorShapes, WhatIsNotFiniteIsLeftOut) {
  const ImportResult result = read(kInventor,
                                   "Cube { } Separator { Scale { scaleFactor 1e38 1e38 1e38 } "
                                   "Scale { scaleFactor 1e38 1e38 1e38 } Cone { } }");
  EXPECT_EQ(result.report.triangles, 12U);
  EXPECT_GT(result.report.dropped_nonfinite, 0U);
  EXPECT_TRUE(std::isfinite(result.report.surface_error_m));
  EXPECT_TRUE(std::isfinite(result.report.rounding_m));
}

}  // namespace
}  // namespace camway::scene
