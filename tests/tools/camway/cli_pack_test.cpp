// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/tools/camway/cli_runner.h"
#include "tests/tools/camway/replay/recorded_wall.h"

namespace camway::tools {
namespace {

namespace fs = std::filesystem;

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class CliPack : public ::testing::Test {
 protected:
  /// A recording with three revisions of a scene and a request in each.
  void record() { record_wall(recorded_); }

  /// Changes a bit of the content of the box, which requests 2 and 3 need. Returns its digest.
  std::string damage_box() const {
    fs::path largest;
    for (const auto& blob : fs::directory_iterator(recorded_ + "/blobs")) {
      if (largest.empty() || blob.file_size() > fs::file_size(largest)) largest = blob.path();
    }
    std::string bytes = read_all(largest.string());
    bytes.back() = static_cast<char>(bytes.back() ^ 1);
    std::ofstream(largest, std::ios::binary) << bytes;
    return largest.filename();
  }

  TemporaryFolder folder_;
  const std::string recorded_ = folder_.file("recorded");
  const std::string pack_ = folder_.file("bug.camway-session");
};

TEST_F(CliPack, KeepsTheSelectedRequestsAndWhatTheyNeed) {
  record();
  const CliRun all = run_camway({"pack", recorded_, "-o", folder_.file("all")});
  ASSERT_EQ(all.exit_code, 0) << all.err;
  EXPECT_EQ(all.err, "");
  EXPECT_THAT(run_camway({"replay", folder_.file("all")}).out, HasSubstr("3 requests: 3 same"));
  const CliRun run = run_camway({"pack", recorded_, "-o", pack_, "--id", "1", "--status", "ok"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("left out: 2 of 3 requests, and all messages about other things"));
  EXPECT_THAT(run.out, HasSubstr(": 3 files, "));  // the log, the wall, and this list
  const CliRun replay = run_camway({"replay", pack_});
  EXPECT_EQ(replay.exit_code, 0) << replay.err;
  EXPECT_THAT(replay.out, AllOf(HasSubstr("1 request: 1 same"),
                                HasSubstr("note: left out of the pack: 2 of 3 requests"),
                                HasSubstr("not selected for the pack")));
  EXPECT_THAT(run_camway({"session", pack_}).out, HasSubstr("left out   2 of 3 requests"));
  const CliRun none = run_camway({"pack", recorded_, "-o", pack_, "--client", "nobody"});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.err, HasSubstr("none of the 3 requests is selected"));
}

TEST_F(CliPack, PacksWhatIsSoundAndSaysWhatIsNot) {
  record();
  const std::string digest = damage_box();
  const CliRun run = run_camway({"pack", recorded_, "-o", pack_});
  EXPECT_EQ(run.exit_code, 2);
  const auto names_all =
      AllOf(HasSubstr("content " + digest + " of object 'box' of scene 'wall' in revision 2,"),
            HasSubstr("which is damaged"),
            HasSubstr("revision 2 of scene 'wall': a request cannot be replayed: client/2"),
            HasSubstr("revision 3 of scene 'wall': a request cannot be replayed: client/3"));
  EXPECT_THAT(run.err, names_all);
  EXPECT_THAT(run.err, Not(HasSubstr(recorded_))) << "a pack tells nothing of the machine";
  const CliRun replay = run_camway({"replay", pack_});
  EXPECT_EQ(replay.exit_code, 2);
  EXPECT_THAT(replay.out,
              AllOf(names_all, HasSubstr("3 requests: 1 same"), HasSubstr("2 not compared")));
  const CliRun unpack = run_camway({"unpack", pack_, folder_.file("unpacked")});
  EXPECT_EQ(unpack.exit_code, 0);
  EXPECT_THAT(unpack.err, AllOf(names_all, HasSubstr("left out when it was packed: ")));
  const CliRun again = run_camway({"replay", folder_.file("unpacked")});
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.out, names_all);
  // A selection that does not need the content is whole.
  EXPECT_EQ(run_camway({"pack", recorded_, "-o", pack_, "--id", "1"}).exit_code, 0);
}

TEST_F(CliPack, SaysWhichScenesOfAPlainLogAreNotFound) {
  const std::string scenes = CAMWAY_SCENES_FOLDER;
  const std::string log = scenes + "/sessions/maze.lcmlog";
  const CliRun run = run_camway({"pack", log, "-o", pack_});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, AllOf(HasSubstr("left out: revision 1 of scene 'maze', digest "),
                             HasSubstr("is not in the session; requests cannot be replayed: ")));
  const CliRun replay = run_camway({"replay", pack_});
  EXPECT_EQ(replay.exit_code, 2);
  EXPECT_THAT(replay.out, AllOf(HasSubstr("left out of the pack: revision 1 of scene 'maze'"),
                                HasSubstr("3 not compared")));
}

/// The times of a plain log are those of its messages, whatever else is in the pack.
TEST_F(CliPack, ASelectionOfAPlainLogHasItsTimesAndScenes) {
  const std::string scenes = CAMWAY_SCENES_FOLDER;
  fs::copy(scenes + "/sessions/office.lcmlog", folder_.file("session.lcmlog"));
  const std::string log = folder_.file("session.lcmlog");
  const std::string scene = "office=" + scenes + "/office.obj";
  const CliRun whole = run_camway({"pack", log, "--scene", scene, "-o", pack_});
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  const std::string table = run_camway({"session", log, "--csv", "-"}).out;
  EXPECT_EQ(run_camway({"session", pack_, "--csv", "-"}).out, table);
  std::istringstream lines(table);
  std::string line;
  for (int row = 0; row < 4; ++row) std::getline(lines, line);
  std::istringstream cells(line);
  std::string id;
  for (int cell = 0; cell < 4; ++cell) std::getline(cells, id, ',');
  const CliRun part = run_camway({"pack", log, "--scene", scene, "-o", pack_, "--id", id});
  ASSERT_EQ(part.exit_code, 0) << part.err;
  const std::string row = run_camway({"session", pack_, "--csv", "-"}).out;
  const std::string head = row.substr(0, row.find('\n') + 1);
  EXPECT_THAT(table, HasSubstr(row.substr(head.size())));
  EXPECT_GT(row.size(), head.size());
  EXPECT_THAT(run_camway({"replay", pack_}).out, HasSubstr("1 request: 1 same"));
}

TEST_F(CliPack, UnpacksNoMoreThanItMay) {
  record();
  ASSERT_EQ(run_camway({"pack", recorded_, "-o", pack_}).exit_code, 0);
  const CliRun run = run_camway({"unpack", pack_, folder_.file("out"), "--most-bytes", "1000"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("holds more than 1000 bytes, the limit of camway unpack "
                                 "--most-bytes"));
  EXPECT_FALSE(fs::exists(folder_.file("out")));
  EXPECT_EQ(run_camway({"unpack", pack_, folder_.file("out"), "--most-bytes", "0"}).exit_code, 2);
  EXPECT_EQ(run_camway({"unpack", pack_, folder_.file("out"), "--most-bytes", "1000000"}).exit_code,
            0);
}

}  // namespace
}  // namespace camway::tools
