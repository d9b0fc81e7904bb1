// SPDX-License-Identifier: MIT
#include "tools/cameras/formats/scene_file_format.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/support/collada_camera.h"
#include "tests/support/temporary_folder.h"
#include "tools/cameras/formats/camera_file.h"

namespace camway::tools {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The notes of a COLLADA file.
std::vector<std::string> notes_of(const std::string& text) {
  const testing::TemporaryFolder folder;
  const auto file = camera_file(folder.write("a.dae", text));
  const auto track = file ? read_scene_file(*file, {}) : base::Failure{file.error};
  EXPECT_EQ(track.error, "");
  return track ? track->notes : std::vector<std::string>();
}

/// `text` with an addition before a word.
std::string with(std::string text, const std::string& addition, const std::string& before) {
  return text.insert(text.find(before), addition);
}

TEST(SceneFileFormat, SaysThatALensChangesOnlyWhereOneDoes) {
  const std::string plain = testing::collada_camera("eye/transform");
  EXPECT_THAT(notes_of(plain), IsEmpty());
  EXPECT_THAT(notes_of(with(plain, R"(<channel source="#s" target="lens/xfov"/>)", "</animation>")),
              Contains(HasSubstr("the file animates a lens, which is not read")));
}

TEST(SceneFileFormat, NamesTheOtherCameras) {
  const std::string other = R"(<node id="b" name="b"><instance_camera url="#lens"/></node>)";
  EXPECT_THAT(notes_of(with(testing::collada_camera("eye/transform"), other, "<node id=\"arm\"")),
              Contains(HasSubstr("camera 'eye' was taken of several")));
}

}  // namespace
}  // namespace camway::tools
