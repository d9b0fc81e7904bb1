// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <lcm/lcm-cpp.hpp>
#include <nlohmann/json.hpp>

#include "lcmtypes/wire/channels.h"
#include "tests/integration/fixture.h"

namespace camway::integration {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// `camway plan`, by itself and by a daemon.
class PlanCommandTest : public IntegrationTest {
 protected:
  /// Plans with these flags. Returns the exit code; the output is in `output_`.
  int plan(const std::string& request, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{CAMWAY_BINARY, "plan", "--request", request};
    arguments.insert(arguments.end(), more.begin(), more.end());
    Process process(arguments, file("plan.log"));
    const int code = process.wait().value_or(-1);
    output_ = process.output();
    return code;
  }

  json answer(const std::string& name) const { return json::parse(read_file(file(name))); }

  std::string output_;
};

/// The paths of all values of a document that differ from those of another one, without the times.
void differences(const json& a, const json& b, const std::string& where,
                 std::set<std::string>& found) {
  if (where == "/timing_ms") return;
  if (!a.is_object() || !b.is_object()) {
    if (a != b) found.insert(where);
    return;
  }
  for (const auto& [key, value] : a.items()) {
    if (b.contains(key)) {
      differences(value, b[key], where + "/" + key, found);
    } else {
      found.insert(where + "/" + key);
    }
  }
  for (const auto& [key, value] : b.items()) {
    if (!a.contains(key)) found.insert(where + "/" + key);
  }
}

/// Hears whether a message comes on a channel.
class Listener {
 public:
  explicit Listener(const std::string& channel) {
    lcm_.subscribeFunction(channel, &Listener::note, this);
  }
  bool has_heard() {
    while (!heard_ && lcm_.handleTimeout(1) > 0) {
    }
    return heard_;
  }

 private:
  static void note(const lcm::ReceiveBuffer*, const std::string&, Listener* self) {
    self->heard_ = true;
  }
  lcm::LCM lcm_;
  bool heard_ = false;
};

TEST_F(PlanCommandTest, ADaemonGivesTheAnswerThatTheCommandGives) {
  start_daemon();
  int told = 0;
  for (const std::string name :
       {"office-free-timed", "office-graze-column", "office-graze-slalom", "office-wall-tour",
        "office-impossible-safe", "office-impossible-shaft"}) {
    SCOPED_TRACE(name);
    const std::string request = request_file(name);
    const int here = plan(request, {"--response", file("here.json")});
    const int there = plan(request, {"--response", file("there.json"), "--daemon", "office"});
    EXPECT_EQ(there, here) << output_;
    const json mine = answer("here.json");
    const json theirs = answer("there.json");
    std::set<std::string> found;
    differences(mine, theirs, "", found);
    // The daemon's scene has a name instead of a file. Messages do not say how it was read.
    EXPECT_THAT(found, ElementsAre("/scene", "/scene_reading"));
    told += mine.contains("viewing_distance_m") ? 1 : 0;
    EXPECT_EQ(theirs["scene"], "office");
    EXPECT_TRUE(theirs["timing_ms"].contains("total"));
    EXPECT_EQ(theirs["timing_ms"].value("load_scene", 0.0), 0.0);
  }
  EXPECT_EQ(told, 3) << "the paths that are corrected";
}

TEST_F(PlanCommandTest, PlansSeveralRequestsByADaemon) {
  start_daemon();
  EXPECT_EQ(plan(request_file("office-free-door"),
                 {"--request", request_file("office-free-timed"), "--response-dir", file("answers"),
                  "--daemon", "office"}),
            0)
      << output_;
  EXPECT_THAT(output_, HasSubstr("2 of 2 requests ok"));
  EXPECT_EQ(answer("answers/office-free-timed.json")["status"], "ok");
}

TEST_F(PlanCommandTest, SaysWhatIsWrong) {
  EXPECT_EQ(plan(request_file("office-free-door"), {"--daemon", "office", "--response", file("r")}),
            4);
  EXPECT_THAT(output_, HasSubstr("no daemon"));
  EXPECT_FALSE(std::filesystem::exists(file("r")));
  EXPECT_EQ(plan(request_file("office-free-door"), {"--url", "udpm://239.255.76.67:7668?ttl=0"}),
            2);
  EXPECT_THAT(output_, HasSubstr("--daemon"));
  EXPECT_EQ(plan(request_file("office-free-door"), {"--daemon", "office", "--scene", "x.obj"}), 2);
  EXPECT_EQ(plan(file("nowhere.json"), {"--daemon", "office"}), 2);

  start_daemon();
  EXPECT_EQ(plan(request_file("office-free-door"), {"--daemon", "cellar"}), 2);
  EXPECT_THAT(output_, HasSubstr("cellar"));
  const std::string refused = file("keyframe.json");
  json request = json::parse(read_file(request_file("office-free-door")));
  request["keyframes"][1]["position"] = {0, 0, -1000};
  request["options"]["clearance_m"] = -1;
  write_file(refused, request.dump());
  EXPECT_EQ(plan(refused, {"--daemon", "office"}), 2);
  EXPECT_THAT(output_, HasSubstr("options.clearance_m"));
}

TEST_F(PlanCommandTest, ASignalCancelsTheRequestAtTheDaemon) {
  start_daemon();
  // The daemon is stopped, so the request is not answered before it is cancelled.
  daemon().signal(SIGSTOP);
  Listener requests(wire::Channels{}.plan_request());
  Listener cancels(wire::Channels{}.cancel());
  Process process(
      {CAMWAY_BINARY, "plan", "--request", request_file("office-wall-tour"), "--daemon", "office"},
      file("cancelled.log"));
  ASSERT_TRUE(eventually([&] { return requests.has_heard(); })) << process.output();
  process.signal(SIGINT);
  ASSERT_TRUE(eventually([&] { return cancels.has_heard(); })) << process.output();
  daemon().signal(SIGCONT);
  EXPECT_EQ(process.wait(), 3) << process.output();
  EXPECT_THAT(process.output(), HasSubstr("cancelled"));
}

}  // namespace
}  // namespace camway::integration
