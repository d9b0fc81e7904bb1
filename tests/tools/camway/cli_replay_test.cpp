// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include <nlohmann/json.hpp>

#include "daemon/planning/plan.h"
#include "lcmtypes/wire/check.h"
#include "tests/tools/camway/cli_runner.h"

namespace camway::tools {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(CliReplayLog, SaysThatALogIsOfAnotherVersion) {
  std::vector<std::uint8_t> older =
      wire::encode(messages::to_wire(simple_request({{1, 0, 1}, {1, 0, -1}}), {"c", 1, 0}));
  older[3] ^= 1;  // within the fingerprint
  LogBuilder log;
  log.add_event("CAMWAY_PLAN_REQUEST", older);
  log.add_event("CAMWAY_PLAN_REQUEST", older);
  const TemporaryFolder folder;
  const std::string file = folder.write("log", log.bytes());
  const CliRun run = run_camway({"replay", file});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr(file + ": its 2 messages on CAMWAY_* are of another version of "
                                        "the wire types: replay it with the camway"));
}

TEST(CliReplayLog, ShowsABodyAndItsWitnesses) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("wall.obj", wall_obj());
  planning::PlanRequest request = simple_request({{0, 0, 1}, {0, 0, -1}});
  request.camera = {};
  request.body = motion::SphereShape{{0, 0, 0}, 0.25};
  request.options.clearance_m = 0.125;
  LogBuilder log;
  log.add_request(request, {"c", 1, 0});
  const std::string file = folder.write("log", log.bytes());
  const std::string responses = folder.file("responses");
  const CliRun run =
      run_camway({"replay", file, "--scene", "wall=" + scene, "--responses", responses});
  EXPECT_THAT(run.out, HasSubstr("no answer in the log"));
  const std::string text = read_all(responses + "/0000_c_1.json");
  EXPECT_THAT(text, HasSubstr("\"object\": \"wall\""));
  EXPECT_THAT(text, HasSubstr("\"feature\": \"surface\""));
}

/// A recording in our maze, unpacked, whose contents of scenes are gone.
class CliReplayWithoutContents : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string pack = std::string(CAMWAY_SCENES_FOLDER) + "/sessions/live.camway-session";
    EXPECT_EQ(run_camway({"unpack", pack, recorded_}).exit_code, 0);
    EXPECT_GT(std::filesystem::remove_all(recorded_ + "/blobs"), 0U);
    std::filesystem::create_directory(root_);
  }

  TemporaryFolder folder_;
  const std::string recorded_ = folder_.file("recorded");
  const std::string root_ = folder_.file("root");
};

TEST_F(CliReplayWithoutContents, SaysThatTheyAreMissingAndTakesThemFromRoots) {
  const CliRun none = run_camway({"replay", recorded_, "--tolerance-m", "1e-4"});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.out, HasSubstr(": is missing"));
  EXPECT_THAT(none.out, Not(HasSubstr("damaged")));
  std::filesystem::copy(std::string(CAMWAY_SCENES_FOLDER) + "/maze.obj", root_);
  const CliRun found = run_camway({"replay", recorded_, "--root", root_, "--tolerance-m", "1e-4"});
  EXPECT_EQ(found.exit_code, 2) << "those in the changed scene are not compared";
  EXPECT_THAT(found.out, HasSubstr("4 requests: 2 same")) << found.err;
}

TEST_F(CliReplayWithoutContents, SaysThatNoFileOfAPlainLogIsBelowTheRoot) {
  const std::string log = std::string(CAMWAY_SCENES_FOLDER) + "/sessions/maze.lcmlog";
  const CliRun run = run_camway({"replay", log, "--root", root_});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err,
              HasSubstr("asks for the scene 'maze': no file below " + root_ + " has its digest "));
  EXPECT_THAT(run.err, HasSubstr("add --scene maze=FILE with the options of the daemon's scene"));
}

/// Logs of four requests past an obstacle: the first has the answer that this build gives, the
/// second the path of the first, the third a worse status, the fourth none.
class CliReplayCompare : public ::testing::Test {
 protected:
  CliReplayCompare() {
    const auto snapshot = scene::make_snapshot("wall", wall_mesh()).snapshot;
    for (int id = 1; id <= 4; ++id) {
      const planning::PlanRequest request =
          simple_request({{1.0 + 0.1 * id, 0, 1}, {1.0 + 0.1 * id, 0, -1}});
      planning::PlanResult result = planning::plan(*snapshot, request);
      requests_.add_request(request, {"client", id, 0});
      requests_.add_answer(result, header(id));
      log_.add_request(request, {"client", id, 0});
      if (id == 1) first_ = result;
      if (id == 2) result.path = first_.path;
      if (id == 3) result.status = planning::Status::kPartial;
      if (id < 4) log_.add_answer(result, header(id));
    }
    file_ = folder_.write("log", log_.bytes());
    truth_ = folder_.write("truth", requests_.bytes());
  }

  static messages::AnswerHeader header(int id) { return {{"client", id, 0}, "wall", 1, ""}; }

  CliRun replay(std::vector<std::string> flags, const std::string& log = {}) const {
    std::vector<std::string> words{"replay", log.empty() ? file_ : log, "--scene",
                                   "wall=" + scene_};
    words.insert(words.end(), flags.begin(), flags.end());
    return run_camway(words);
  }

  TemporaryFolder folder_;
  std::string scene_ = folder_.write("wall.obj", wall_obj());
  LogBuilder log_, requests_;
  planning::PlanResult first_;
  std::string file_, truth_;
};

TEST_F(CliReplayCompare, ItsExitCodeFollowsTheVerdictsThatFail) {
  const CliRun run = replay({});
  EXPECT_EQ(run.exit_code, 3) << run.out << run.err;
  EXPECT_THAT(run.out, HasSubstr("verdict: DIFFERENT: 4 requests: 1 same, 1 better, 1 different, "
                                 "0 worse, 0 regressed, 1 not compared"));
  EXPECT_EQ(replay({"--fail-on", "worse,regressed"}).exit_code, 0);
  EXPECT_EQ(replay({"--fail-on", "nothing"}).exit_code, 0);
  EXPECT_EQ(replay({"--fail-on", "better"}).exit_code, 3);
  EXPECT_EQ(replay({"--tolerance-m", "0.2"}).exit_code, 0);
  EXPECT_EQ(replay({"--tolerance-m", "0.2", "--tolerance-shift-deg", "1"}).exit_code, 3);
  EXPECT_EQ(replay({"--fail-on", "wrong"}).exit_code, 2);
}

TEST_F(CliReplayCompare, SelectsRequests) {
  EXPECT_EQ(replay({"--id", "1"}).exit_code, 0);
  const CliRun third = replay({"--status", "partial"});
  EXPECT_THAT(third.out, HasSubstr("BETTER: status partial -> ok"));
  EXPECT_THAT(third.out, HasSubstr("note: 3 requests are not selected"));
  EXPECT_EQ(replay({"--from", "0.003", "--to", "2023-11-14T22:13:20.005Z"}).exit_code, 0);
  const CliRun none = replay({"--client", "nobody"});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.err, HasSubstr("none of its 4 requests is selected"));
  EXPECT_EQ(replay({"--id", "1..x"}).exit_code, 2);
  EXPECT_EQ(replay({"--from", "yesterday"}).exit_code, 2);
}

TEST_F(CliReplayCompare, WritesReports) {
  const std::string json = folder_.file("report.json");
  const std::string html = folder_.file("report.html");
  const CliRun run = replay({"--json", json, "--html", html, "--no-timing", "--pictures", "1"});
  EXPECT_EQ(run.exit_code, 3) << run.err;
  const auto document = nlohmann::json::parse(read_all(json));
  EXPECT_EQ(document["counts"]["different"], 1);
  EXPECT_EQ(document["requests"].size(), 4U);
  const std::string page = read_all(html);
  EXPECT_THAT(page, HasSubstr("data:image/svg+xml;base64,"));
  const std::string image = "<img alt=";
  EXPECT_EQ(page.find(image), page.rfind(image)) << "one picture";
  replay({"--json", folder_.file("again.json"), "--html", folder_.file("again.html"), "--no-timing",
          "--pictures", "1", "--threads", "3"});
  EXPECT_EQ(read_all(json), read_all(folder_.file("again.json")));
  EXPECT_EQ(page, read_all(folder_.file("again.html")));
  EXPECT_EQ(replay({"--json", folder_.file("nowhere/report.json")}).exit_code, 2);
}

TEST_F(CliReplayCompare, WritesNoReportOverItsInputOrToStandardOutput) {
  for (const std::string flag : {"--json", "--html"}) {
    const CliRun over = replay({flag, file_});
    EXPECT_EQ(over.exit_code, 2);
    EXPECT_THAT(over.err, HasSubstr(file_ + ": is read, so it is not written"));
    EXPECT_EQ(replay({flag, "-"}).exit_code, 2);
  }
  EXPECT_EQ(read_all(file_), log_.bytes());
  EXPECT_FALSE(std::filesystem::exists("-"));
}

TEST_F(CliReplayCompare, RefusesOptionsWithoutEffect) {
  const std::vector<std::string> logs{"replay", "--baseline", truth_, "--against", file_};
  const auto compare = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = logs;
    words.insert(words.end(), more.begin(), more.end());
    return run_camway(words);
  };
  EXPECT_THAT(compare({"--threads", "2"}).err, HasSubstr("--threads"));
  const CliRun scene = compare({"--scene", "wall=" + scene_});
  EXPECT_EQ(scene.exit_code, 2);
  EXPECT_THAT(scene.err, HasSubstr("only pictures of --html use them"));
  EXPECT_EQ(replay({"--no-timing", "--slower-than", "2"}).exit_code, 2);
  const CliRun backwards = replay({"--from", "5", "--to", "1"});
  EXPECT_EQ(backwards.exit_code, 2);
  EXPECT_THAT(backwards.err, HasSubstr("--from is after --to, so no request is selected"));
}

TEST_F(CliReplayCompare, ComparesTwoLogsWithoutPlanning) {
  const CliRun run = run_camway({"replay", "--baseline", truth_, "--against", file_});
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_THAT(run.out, HasSubstr("1 same, 0 better, 1 different, 0 worse, 1 regressed, 1 not"));
  EXPECT_EQ(run_camway({"replay", "--baseline", truth_, "--against", truth_}).exit_code, 0);
  EXPECT_EQ(run_camway({"replay", file_, "--baseline", truth_, "--against", truth_}).exit_code, 2);
  EXPECT_EQ(run_camway({"replay", "--baseline", truth_}).exit_code, 2);
  EXPECT_EQ(run_camway({"replay"}).exit_code, 2);
}

TEST_F(CliReplayCompare, ReadsATruncatedLogToTheLastGoodEvent) {
  const std::string cut = folder_.write("cut", log_.bytes().substr(0, log_.offsets()[5] + 9));
  const CliRun run = run_camway({"replay", "--baseline", truth_, "--against", cut, "--id", "1"});
  EXPECT_EQ(run.exit_code, 2) << run.out;
  EXPECT_THAT(run.err, HasSubstr("the log breaks off inside the head of the event; 5 good events "
                                 "before it"));
  EXPECT_THAT(run.out, HasSubstr(cut + ": the log is damaged: 5 good events were used"));
}

TEST_F(CliReplayCompare, ComparesWithAnotherBuild) {
  const CliRun itself = replay({"--baseline-build", CAMWAY_BINARY});
  EXPECT_EQ(itself.exit_code, 0) << itself.out << itself.err;
  EXPECT_THAT(itself.out, HasSubstr("verdict: SAME: 4 requests: 4 same"));

  // A build whose first answer is its second one.
  const std::string other =
      folder_.write("other", "#!/bin/sh\n'" CAMWAY_BINARY
                             "' \"$@\"\n"
                             "while [ \"$1\" != --responses ]; do shift; done\n"
                             "cp \"$2\"/0001_* \"$2\"/0000_client_1.json\n"
                             "exit 3\n");
  std::filesystem::permissions(other, std::filesystem::perms::owner_all);
  const CliRun changed = replay({"--baseline-build", other});
  EXPECT_EQ(changed.exit_code, 3) << changed.out << changed.err;
  EXPECT_THAT(changed.out, HasSubstr("verdict: DIFFERENT: 4 requests: 3 same, 0 better, 1 diff"));

  // A build that says what it is asked for. It has no answers, and its output is shown.
  const std::string echo = folder_.write("echo", "#!/bin/sh\necho \"$@\"\n");
  std::filesystem::permissions(echo, std::filesystem::perms::owner_all);
  const CliRun asked = replay({"--baseline-build", echo, "--least-deadline-s", "600.5"});
  EXPECT_THAT(asked.err, HasSubstr("--least-deadline-s 600.5"));
  EXPECT_THAT(replay({"--baseline-build", echo}).err, Not(HasSubstr("--least-deadline-s")));

  // It is asked for the selected requests alone.
  const std::vector<std::string> selected{
      "--baseline-build", echo,           "--id", "1,3..9", "--from", "0",        "--client",
      "client",           "--scene-name", "wall", "--to",   "1e3",    "--status", "ok,partial"};
  EXPECT_THAT(replay(selected).err,
              HasSubstr("--from=0 --to=1000 --id=1..1,3..9 --client=client --status=ok,partial "
                        "--scene-name=wall"));
  const CliRun part = replay({"--baseline-build", CAMWAY_BINARY, "--id", "2..3"});
  EXPECT_EQ(part.exit_code, 0) << part.out << part.err;
  EXPECT_THAT(part.out, HasSubstr("verdict: SAME: 2 requests: 2 same"));

  const CliRun none = replay({"--baseline-build", folder_.file("nowhere")});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.err, HasSubstr("cannot be run"));
  const CliRun mute = replay({"--baseline-build", "/bin/true"});
  EXPECT_EQ(mute.exit_code, 2);
  EXPECT_THAT(mute.err, HasSubstr("wrote no responses"));
}

TEST_F(CliReplayCompare, StepsNeedATerminal) {
  const CliRun run = replay({"--step"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("--step: asks after each request, which needs a terminal"));
}

}  // namespace
}  // namespace camway::tools
