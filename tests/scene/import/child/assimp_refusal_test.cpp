// SPDX-License-Identifier: MIT
#include "daemon/scene/import/child/assimp_refusal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace camway::scene {
namespace {

using ::testing::HasSubstr;

TEST(AssimpRefusal, SaysWhatToDoAboutCompressedFiles) {
  EXPECT_THAT(refusal_of_assimp(".glb", R"({"extensionsUsed":["EXT_meshopt_compression"]})", "bad"),
              HasSubstr("write the file without compression"));
  EXPECT_EQ(refusal_of_assimp(".obj", "EXT_meshopt_compression", "bad"), "bad");
}

TEST(AssimpRefusal, SaysMoreThanTheNameOfAnException) {
  EXPECT_THAT(refusal_of_assimp(".ifc", "", "std::bad_cast"), HasSubstr("it is damaged"));
  EXPECT_THAT(refusal_of_assimp(".ifc", "FILE_SCHEMA(('IFC4'))", "std::bad_cast"),
              HasSubstr("IFC2x3"));
}

}  // namespace
}  // namespace camway::scene
