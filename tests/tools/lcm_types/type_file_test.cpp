// SPDX-License-Identifier: MIT
#include "tools/lcm_types/type_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <camway/plan_request_t.hpp>
#include <camway/plan_response_t.hpp>
#include <camway/scene_request_t.hpp>
#include <camway/status_t.hpp>
#include <robot/pose_t.hpp>
#include <robot/track_t.hpp>

namespace camway::tools {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

LcmTypes types_in(const fs::path& folder) {
  LcmTypes types;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".lcm") continue;
    EXPECT_EQ(read_lcm_types(text_of(entry.path()), types), "") << entry.path();
  }
  return types;
}

template <class Message>
void expect_fingerprint(const LcmTypes& types, const std::string& name) {
  const auto found = lcm_fingerprint(types, name);
  ASSERT_TRUE(found) << found.error;
  EXPECT_EQ(*found, static_cast<std::uint64_t>(Message::getHash())) << name;
}

std::string fault_of_text(const std::string& text) {
  LcmTypes types;
  return read_lcm_types(text, types);
}

// The oracle is lcm-gen.
TEST(LcmTypeFile, HasTheFingerprintsOfGeneratedCode) {
  const LcmTypes own = types_in(CAMWAY_LCMTYPES_FOLDER);
  expect_fingerprint<plan_request_t>(own, "camway.plan_request_t");
  expect_fingerprint<plan_response_t>(own, "camway.plan_response_t");
  expect_fingerprint<scene_request_t>(own, "camway.scene_request_t");
  expect_fingerprint<status_t>(own, "camway.status_t");
  const LcmTypes samples = types_in(CAMWAY_LCM_SAMPLES_FOLDER);
  expect_fingerprint<robot::pose_t>(samples, "robot.pose_t");
  expect_fingerprint<robot::track_t>(samples, "robot.track_t");
}

TEST(LcmTypeFile, ReadsDeclarationsAndLeavesOutConstantsAndComments) {
  const LcmTypes types = types_in(CAMWAY_LCM_SAMPLES_FOLDER);
  const LcmStruct& track = types.at("robot.track_t");
  ASSERT_EQ(track.members.size(), 10U);
  EXPECT_EQ(track.members[6].type, "robot.pose_t");
  EXPECT_EQ(track.members[9].written, (std::vector<std::string>{"2", "poses"}));
  EXPECT_EQ(types.at("robot.pose_t").members.size(), 4U);
  EXPECT_EQ(types.at("robot.point_t").members[2].name, "z");
}

TEST(LcmTypeFile, NamesTheLineOfAMistake) {
  EXPECT_EQ(fault_of_text("struct a_t {\n  int32_t n\n}"), "line 3: expected ';', not '}'");
  EXPECT_EQ(fault_of_text("package x;\nclass a {}"),
            "line 2: expected 'package' or 'struct', not 'class'");
  EXPECT_EQ(fault_of_text("struct a_t { double v[n]; }"),
            "line 1: the size 'n' is neither a number nor a member before it, not 'n'");
  EXPECT_EQ(fault_of_text("struct a_t { double v;"),
            "line 1: expected a name, not the end of the file");
  EXPECT_EQ(fault_of_text("struct a_t { const int8_t A = 1"),
            "line 1: expected ';', not the end of the file");
  EXPECT_EQ(fault_of_text("/* open"), "");
  for (std::size_t length = 0; length < 400; ++length) {
    static_cast<void>(fault_of_text(
        text_of(fs::path(CAMWAY_LCM_SAMPLES_FOLDER) / "robot_track_t.lcm").substr(0, length)));
  }
}

TEST(LcmTypeFile, NamesAStructThatIsMissing) {
  LcmTypes types;
  ASSERT_EQ(read_lcm_types("package p; struct a_t { b_t b; }", types), "");
  EXPECT_EQ(lcm_fingerprint(types, "p.a_t").error, "no file defines the struct 'p.b_t'");
}

TEST(LcmTypeFile, EndsWhereStructsHoldEachOther) {
  LcmTypes types;
  ASSERT_EQ(read_lcm_types("struct a_t { b_t b; } struct b_t { a_t a; }", types), "");
  EXPECT_TRUE(lcm_fingerprint(types, "a_t"));
  // Each level holds the next one twice: 2^40 structs.
  std::string text;
  for (int i = 0; i < 40; ++i) {
    const std::string next = "t" + std::to_string(i + 1);
    text += "struct t" + std::to_string(i) + " { " + next + " a, b; }\n";
  }
  types.clear();
  ASSERT_EQ(read_lcm_types(text + "struct t40 { double x; }", types), "");
  EXPECT_FALSE(lcm_fingerprint(types, "t0"));
}

}  // namespace
}  // namespace camway::tools
