// SPDX-License-Identifier: MIT
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <IGESControl_Controller.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Writer.hxx>
#include <TopoDS_Shape.hxx>

#include "daemon/scene/import/import.h"
#include "tests/support/temporary_folder.h"

namespace camway::scene {

/// Writes shapes, whose lengths are millimetres, as files, and imports them.
class CadScene : public ::testing::Test {
 protected:
  CadScene() {
    Message::DefaultMessenger()->ChangePrinters().Clear();
    STEPControl_Controller::Init();
    IGESControl_Controller::Init();
    Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  }

  std::string write_step(const TopoDS_Shape& shape, const std::string& unit = "MM",
                         const std::string& name = "part.step") {
    Interface_Static::SetCVal("write.step.unit", unit.c_str());
    STEPControl_Writer writer;
    EXPECT_EQ(writer.Transfer(shape, STEPControl_AsIs), IFSelect_RetDone);
    const std::string file = (folder_.path() / name).string();
    EXPECT_EQ(writer.Write(file.c_str()), IFSelect_RetDone);
    return file;
  }
  std::string write_iges(const TopoDS_Shape& shape, const std::string& unit = "MM",
                         const std::string& name = "part.igs") {
    IGESControl_Writer writer(unit.c_str(), 1);  // 1: solids stay solids
    EXPECT_TRUE(writer.AddShape(shape));
    writer.ComputeModel();
    const std::string file = (folder_.path() / name).string();
    EXPECT_TRUE(writer.Write(file.c_str()));
    return file;
  }

  /// Imports and expects success.
  static ImportResult read(const std::string& file) {
    ImportResult result = import_mesh(file, {});
    EXPECT_EQ(result.error, "");
    if (!result.mesh) result.mesh.emplace();
    return result;
  }
  /// Imports and expects a refusal.
  static std::string refusal(const std::string& file) {
    const ImportResult result = import_mesh(file, {});
    EXPECT_FALSE(result.mesh);
    return result.error;
  }
  static std::vector<std::string> names_of(const Mesh& mesh) {
    std::vector<std::string> names;
    for (const MeshObject& object : mesh.objects) names.push_back(object.name);
    return names;
  }

  testing::TemporaryFolder folder_;
};

}  // namespace camway::scene
