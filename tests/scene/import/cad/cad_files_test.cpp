// SPDX-License-Identifier: MIT
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRep_Builder.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_OffsetSurface.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopoDS_Compound.hxx>
#include <gp_Trsf.hxx>

#include "daemon/scene/import/import_process.h"
#include "tests/scene/import/cad/cad_scene.h"
#include "tests/support/random.h"

namespace camway::scene {
namespace {

constexpr std::uint64_t kFilesSeed = 41;

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class CadFiles : public CadScene {
 protected:
  static TopoDS_Shape brick() {
    return BRepPrimAPI_MakeBox(gp_Pnt(100, 0, 0), gp_Pnt(600, 200, 300)).Shape();
  }

  static void expect_brick(const ImportResult& result) {
    EXPECT_LT((result.report.bounds_m.min() - geometry::Vec3(0.1, 0, 0)).norm(), 1e-11);
    EXPECT_LT((result.report.bounds_m.max() - geometry::Vec3(0.6, 0.2, 0.3)).norm(), 1e-11);
    EXPECT_EQ(result.report.triangles, 12U);
    EXPECT_LE(result.report.surface_error_m, 1e-8);
  }

  std::string text_of(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
};

TEST_F(CadFiles, StepUnitsBecomeMetres) {
  const std::vector<std::pair<std::string, double>> units = {
      {"MM", 1e-3}, {"M", 1.0}, {"INCH", 0.0254}, {"CM", 0.01}, {"FT", 0.3048}};
  for (const auto& [unit, metres] : units) {
    SCOPED_TRACE(unit);
    const ImportResult result = read(write_step(brick(), unit));
    expect_brick(result);
    EXPECT_EQ(result.report.format, "STEP");
    EXPECT_DOUBLE_EQ(result.report.unit_m, metres);
    EXPECT_FALSE(result.report.single_precision);
  }
}

TEST_F(CadFiles, IgesUnitsBecomeMetres) {
  const std::vector<std::pair<std::string, double>> units = {
      {"MM", 1e-3}, {"M", 1.0}, {"INCH", 0.0254}, {"CM", 0.01}};
  for (const auto& [unit, metres] : units) {
    SCOPED_TRACE(unit);
    const ImportResult result = read(write_iges(brick(), unit));
    expect_brick(result);
    EXPECT_EQ(result.report.format, "IGES");
    EXPECT_DOUBLE_EQ(result.report.unit_m, metres);
  }
}

TEST_F(CadFiles, TheNameMayBeInAnyCase) {
  expect_brick(read(write_step(brick(), "MM", "a.STP")));
  expect_brick(read(write_step(brick(), "MM", "a.Step")));
  expect_brick(read(write_iges(brick(), "MM", "a.IGES")));
}

TEST_F(CadFiles, ScaleIsBesideTheUnit) {
  ImportOptions options;
  options.scale = 2.0;
  const ImportResult result = import_mesh(write_step(brick()), options);
  EXPECT_NEAR(result.report.bounds_m.max().x(), 1.2, 1e-12);
  EXPECT_NEAR(result.report.scale, 2e-3, 1e-18);
}

TEST_F(CadFiles, AssembliesArePlaced) {
  // The same post three times, one of them turned.
  const TopoDS_Shape post = BRepPrimAPI_MakeCylinder(10, 100).Shape();
  TopoDS_Compound all;
  BRep_Builder().MakeCompound(all);
  for (int i = 0; i < 3; ++i) {
    gp_Trsf move;
    if (i == 2) move.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(1, 0, 0)), -M_PI / 2);
    move.SetTranslationPart(gp_Vec(1000.0 * i, 0, 0));
    BRep_Builder().Add(all, post.Moved(move));
  }
  Interface_Static::SetIVal("write.step.assembly", 1);
  const ImportResult result = read(write_step(all));
  Interface_Static::SetIVal("write.step.assembly", 0);
  EXPECT_EQ(result.report.objects, 3U);
  const geometry::Vec3 max = result.report.bounds_m.max();
  EXPECT_NEAR(max.x(), 2.01, 1e-5);
  EXPECT_NEAR(max.y(), 0.1, 1e-12);
  EXPECT_NEAR(max.z(), 0.1, 1e-12);
  EXPECT_EQ(result.mesh->objects[0].triangle_count, result.mesh->objects[2].triangle_count);
}

TEST_F(CadFiles, ObjectsAreNamedAfterProductsAndSolids) {
  Interface_Static::SetCVal("write.step.product.name", "bracket");
  const std::string file = write_step(brick());
  EXPECT_THAT(names_of(*read(file).mesh), ElementsAre(StartsWith("bracket")));
  std::string text = text_of(file);
  const std::size_t at = text.find("MANIFOLD_SOLID_BREP('");
  ASSERT_NE(at, std::string::npos);
  text.insert(at + std::string("MANIFOLD_SOLID_BREP('").size(), "rib");
  EXPECT_THAT(names_of(*read(folder_.write("named.step", text)).mesh),
              ElementsAre(AllOf(StartsWith("bracket"), EndsWith("/rib"))));
  Interface_Static::SetCVal("write.step.product.name", "");
  EXPECT_THAT(names_of(*read(write_iges(brick())).mesh), ElementsAre("part_1"));
}

/// A face that is offset from a wavy surface.
TopoDS_Shape offset_face() {
  TColgp_Array2OfPnt poles(1, 3, 1, 3);
  for (int i = 1; i <= 3; ++i) {
    for (int j = 1; j <= 3; ++j)
      poles(i, j) = gp_Pnt(50.0 * i, 50.0 * j, i == 2 && j == 2 ? 40 : 0);
  }
  TColStd_Array1OfReal knots(1, 2);
  knots(1) = 0;
  knots(2) = 1;
  TColStd_Array1OfInteger counts(1, 2);
  counts.Init(3);
  const Handle(Geom_BSplineSurface) wavy =
      new Geom_BSplineSurface(poles, knots, knots, counts, counts, 2, 2);
  return BRepBuilderAPI_MakeFace(new Geom_OffsetSurface(wavy, 5.0), 1e-6).Shape();
}

TEST_F(CadFiles, FacesWithoutAnExactFormAreLeftOutAndCounted) {
  TopoDS_Compound all;
  BRep_Builder().MakeCompound(all);
  BRep_Builder().Add(all, brick());
  BRep_Builder().Add(all, offset_face());
  const ImportResult result = read(write_step(all));
  expect_brick(result);
  EXPECT_EQ(result.report.dropped_freeform, 1U);
  EXPECT_THAT(
      result.report.notes,
      ::testing::Contains("1 faces could not be read: each is offset from another surface"));
  EXPECT_THAT(refusal(write_step(offset_face())),
              EndsWith("holds no face that could be read: 1 that is offset from another surface"));
}

TEST_F(CadFiles, WhatIsNoCadFileIsRefusedInWords) {
  for (const std::string name : {"a.step", "a.stp", "a.igs", "a.iges"}) {
    SCOPED_TRACE(name);
    const bool is_step = name.find("st") != std::string::npos;
    EXPECT_THAT(refusal(folder_.write(name, "hello\n")),
                EndsWith(is_step ? "is no STEP file, or damaged" : "is no IGES file, or damaged"));
    EXPECT_THAT(refusal(folder_.write(name, std::string(1000, '\0'))), HasSubstr(name + ": "));
    EXPECT_THAT(refusal(folder_.write(name, "")), EndsWith("is empty"));
  }
  const TopoDS_Shape wire = BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 0), gp_Pnt(1, 0, 0)).Shape();
  EXPECT_THAT(refusal(write_step(wire)), HasSubstr("holds no "));
  EXPECT_THAT(refusal(write_iges(wire)), HasSubstr("holds no "));
}

TEST_F(CadFiles, DamagedFilesNeverCrashTheReaderOfTheResult) {
  camway::testing::Random random(kFilesSeed);
  for (const std::string& file : {write_step(brick()), write_iges(brick())}) {
    const std::string sound = text_of(file);
    const std::string name = "damaged" + std::filesystem::path(file).extension().string();
    for (int i = 0; i < 30; ++i) {
      std::string text = sound;
      if (i % 3 == 0) {
        text.resize(static_cast<std::size_t>(random.integer(1, static_cast<int>(text.size()))));
      } else {
        for (int k = 0; k < 5; ++k) {
          text[static_cast<std::size_t>(random.integer(0, static_cast<int>(text.size()) - 1))] =
              "0123456789#(),.'*$\n Z"[static_cast<std::size_t>(random.integer(0, 20))];
        }
      }
      const ImportResult result = import_mesh(folder_.write(name, text), {});
      EXPECT_EQ(result.mesh.has_value(), result.error.empty()) << i;
    }
  }
}

TEST_F(CadFiles, CamerasAreNotLookedFor) {
  const auto process = run_import_process(write_step(brick()), std::size_t{1} << 30U, 10.0, {},
                                          ImportTask::kCameras);
  EXPECT_EQ(process.detail, "STEP and IGES have no cameras");
}

TEST_F(CadFiles, TwoReadsHaveTheSameBits) {
  const std::string file = write_step(BRepPrimAPI_MakeCylinder(10, 100).Shape());
  const ImportResult a = read(file);
  const ImportResult b = read(file);
  EXPECT_EQ(a.mesh->vertices, b.mesh->vertices);
  EXPECT_EQ(a.mesh->triangles, b.mesh->triangles);
}

}  // namespace
}  // namespace camway::scene
