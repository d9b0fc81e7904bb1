// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "daemon/planning/plan.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tests/tools/camway/cli_runner.h"

namespace camway::tools {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// Cuts a table into fields, as RFC 4180 has them.
std::vector<std::vector<std::string>> rows_in(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> row(1);
  bool is_quoted = false;
  for (std::size_t i = 0; i < csv.size(); ++i) {
    const char c = csv[i];
    if (is_quoted && c == '"' && csv[i + 1] == '"') {
      row.back() += csv[++i];
    } else if (c == '"') {
      is_quoted = !is_quoted;
    } else if (!is_quoted && c == ',') {
      row.emplace_back();
    } else if (!is_quoted && c == '\r' && csv[i + 1] == '\n') {
      rows.push_back(row);
      row.assign(1, "");
      ++i;
    } else {
      row.back() += c;
    }
  }
  return rows;
}

class CliSession : public ::testing::Test {
 protected:
  /// A session with a request that is corrected, one that is invalid, and one without an answer.
  LogBuilder session() {
    const auto scene = scene::make_snapshot("wall", wall_mesh()).snapshot;
    LogBuilder log;
    planning::PlanRequest request = simple_request({{0.1, 0, 1}, {0.1, 0, -1}});
    log.add_request(request, {"a", 1, 0});
    messages::AnswerHeader header{{"a", 1, 0}, "wall", 1, "digest, \"with\" all\r\nsigns"};
    log.add_answer(planning::plan(*scene, request), header);
    request.keyframes.pop_back();
    log.add_request(request, {"b", 7, 0});
    header.ids = {"b", 7, 0};
    log.add_answer(planning::plan(*scene, request), header);
    log.add_request(simple_request({{9, 0, 1}, {9, 0, -1}}), {"b", 8, 0});
    return log;
  }

  TemporaryFolder folder_;
};

TEST_F(CliSession, WritesATableWithALineForEachRequest) {
  const std::string file = folder_.write("s.lcmlog", session().bytes());
  const CliRun run = run_camway({"session", file, "--csv", "-"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto rows = rows_in(run.out);
  ASSERT_EQ(rows.size(), 4U);
  for (const auto& row : rows) EXPECT_EQ(row.size(), rows[0].size());
  const auto column = [&](const std::string& name) {
    const auto found = std::ranges::find(rows[0], name);
    EXPECT_NE(found, rows[0].end()) << name;
    std::vector<std::string> values;
    for (std::size_t i = 1; i < rows.size(); ++i) {
      values.push_back(rows[i][static_cast<std::size_t>(found - rows[0].begin())]);
    }
    return values;
  };
  EXPECT_THAT(column("client"), ElementsAre("a", "b", "b"));
  EXPECT_THAT(column("request_id"), ElementsAre("1", "7", "8"));
  EXPECT_THAT(column("status"), ElementsAre("ok", "invalid", ""));
  EXPECT_THAT(column("keyframes"), ElementsAre("2", "1", "2"));
  EXPECT_THAT(column("certified"), ElementsAre("true", "false", ""));
  EXPECT_THAT(column("collisions"), ElementsAre("1", "0", ""));
  EXPECT_GT(std::stod(column("clearance_m")[0]), 0.0);
  EXPECT_EQ(column("clearance_m")[1], "");
  EXPECT_EQ(column("scene_digest")[0], "digest, \"with\" all\r\nsigns");
  EXPECT_LT(std::stod(column("received_s")[1]), std::stod(column("answered_s")[1]));
}

TEST_F(CliSession, NamesTheClientsWithTheMostRequests) {
  LogBuilder log;
  for (int i = 0; i < 20; ++i) {
    log.add_request(simple_request({{1, 0, 1}, {1, 0, -1}}), {"c" + std::to_string(i), 1, 0});
  }
  log.add_request(simple_request({{1, 0, 1}, {1, 0, -1}}), {"c9", 2, 0});
  const CliRun run = run_camway({"session", folder_.write("s.lcmlog", log.bytes())});
  EXPECT_THAT(run.out, HasSubstr("clients    2 c9, 1 c0, "));
  EXPECT_THAT(run.out, HasSubstr(", and 8 more\n"));
}

TEST_F(CliSession, SumsUp) {
  const std::string file = folder_.write("s.lcmlog", session().bytes());
  const CliRun run = run_camway({"session", file});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("requests   3 in 0.00"));
  EXPECT_THAT(run.out, HasSubstr("statuses   1 invalid, 1 ok, 1 unanswered"));
  EXPECT_THAT(run.out, HasSubstr("clients    1 a, 2 b"));
  EXPECT_THAT(run.out, Not(HasSubstr("left out")));
}

TEST_F(CliSession, ReadsADamagedLogUpToTheDamage) {
  const LogBuilder log = session();
  const std::size_t cut = log.offsets()[3] + 40;
  const std::string file = folder_.write("s.lcmlog", log.bytes().substr(0, cut));
  const CliRun run = run_camway({"session", file, "--csv", folder_.file("s.csv")});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("3 good events before it"));
  EXPECT_THAT(run.out, HasSubstr("statuses   1 ok, 1 unanswered"));
  EXPECT_EQ(rows_in(read_all(folder_.file("s.csv"))).size(), 3U);
}

TEST_F(CliSession, WritesMcap) {
  const std::string file = folder_.write("s.lcmlog", session().bytes());
  EXPECT_EQ(run_camway({"session", file, "--mcap", "-"}).exit_code, 2);
  EXPECT_EQ(run_camway({"session", file, "--mcap", file}).exit_code, 2) << "it is read";
  const CliRun run = run_camway({"session", file, "--mcap", folder_.file("s.mcap")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string bytes = read_all(folder_.file("s.mcap"));
  EXPECT_THAT(bytes, StartsWith("\x89MCAP0\r\n"));
  EXPECT_THAT(bytes, HasSubstr(R"("message":"a 1: ok: )"));
}

/// The same requests in a log, a folder of logs, and a pack.
TEST_F(CliSession, TakesFoldersAndPacks) {
  const std::string scenes = CAMWAY_SCENES_FOLDER;
  const std::string log = scenes + "/sessions/maze.lcmlog";
  const std::string pack = folder_.file("maze.camway-session");
  const CliRun packed =
      run_camway({"pack", log, "--scene", "maze=" + scenes + "/maze.obj", "-o", pack});
  ASSERT_EQ(packed.exit_code, 0) << packed.err;
  std::filesystem::create_directory(folder_.file("logs"));
  std::filesystem::copy_file(log, folder_.file("logs/maze.lcmlog"));
  const CliRun table = run_camway({"session", log, "--csv", "-"});
  ASSERT_EQ(rows_in(table.out).size(), 4U);
  for (const std::string& session : {pack, folder_.file("logs")}) {
    const CliRun run = run_camway({"session", session, "--csv", "-"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.out, table.out);
  }
  EXPECT_THAT(run_camway({"session", pack}).out, HasSubstr("requests   3 in "));

  const std::string bytes = read_all(pack);
  const CliRun cut = run_camway(
      {"session", folder_.write("cut.camway-session", bytes.substr(0, bytes.size() / 2))});
  EXPECT_EQ(cut.exit_code, 2);
  EXPECT_THAT(cut.err, HasSubstr("is damaged"));
  std::filesystem::create_directory(folder_.file("empty"));
  const CliRun empty = run_camway({"session", folder_.file("empty")});
  EXPECT_EQ(empty.exit_code, 2);
  EXPECT_THAT(empty.err, HasSubstr("holds no file *.lcmlog"));
}

TEST_F(CliSession, RefusesWhatIsNoLog) {
  EXPECT_EQ(run_camway({"session", folder_.file("none")}).exit_code, 2);
  const CliRun run = run_camway({"session", folder_.write("x", "text, no log at all, but long")});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("there is no event here"));
}

}  // namespace
}  // namespace camway::tools
