// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "daemon/planning/plan.h"
#include "daemon/planning/result/witness_names.h"
#include "lcmtypes/wire/check.h"
#include "tests/tools/camway/replay/log_builder.h"
#include "tools/camway/replay/compare/report.h"
#include "tools/camway/replay/replay_run.h"
#include "tools/json/json_response.h"

namespace camway::tools {
namespace {

using planning::PlanRequest;
using planning::PlanResult;
using planning::Status;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A time in an answer that the process under test cannot have measured itself.
constexpr double kRecordedMs = 12345.0;

class ReplayTest : public ::testing::Test {
 protected:
  ReplayTest() {
    scene::SnapshotResult made = scene::make_snapshot("wall", wall_mesh());
    EXPECT_TRUE(made.snapshot) << made.error;
    scenes_["wall"] = made.snapshot;
  }

  PlanResult planned(const PlanRequest& request) const {
    PlanResult result = planning::plan(*scenes_.at("wall"), request);
    planning::name_witnesses(scenes_.at("wall")->mesh, request, result);
    result.timing.total_ms = kRecordedMs;
    return result;
  }

  messages::AnswerHeader header(std::int64_t id) const {
    return {{"client", id, 0}, "wall", 1, scenes_.at("wall")->digest};
  }

  /// Adds request `id` with the answer of planning.
  void record(const PlanRequest& request, std::int64_t id) {
    log_.add_request(request, {"client", id, 0});
    log_.add_answer(planned(request), header(id));
  }

  /// A session with paths that are free, that collide, and that cannot be planned.
  void record_session() {
    record(simple_request({{1, 0, 1}, {1, 0, -1}}), 1);
    record(simple_request({{0.1, 0, 1}, {0.1, 0, -1}}), 2);
    record(simple_request({{0.2, 0.3, 1}, {1, 1, 0}, {-0.3, 0.2, -1}}), 3);
    record(simple_request({{0, 0, 0.1}, {1, 0, 1}}), 4);
    for (int i = 0; i < 12; ++i) {
      const double x = 1.91 + 0.015 * i;
      record(simple_request({{x, 0.1, 0.9}, {x, 0.5, -0.9}, {x + 0.3, 0, 0.8}}), 5 + i);
    }
  }

  [[nodiscard]] Session session() const {
    return read_session(folder_.write("log", log_.bytes()), "CAMWAY");
  }

  [[nodiscard]] std::vector<ReplayedRequest> run(const Session& session,
                                                 unsigned threads = 1) const {
    ReplayOptions options;
    options.threads = threads;
    NamedScenes scenes(scenes_);
    return replay(session, scenes, options);
  }

  TemporaryFolder folder_;
  Scenes scenes_;
  LogBuilder log_;
};

std::vector<ComparedRequest> compared_of(const std::vector<ReplayedRequest>& replayed) {
  std::vector<ComparedRequest> compared;
  for (const ReplayedRequest& each : replayed) compared.push_back(each.compared);
  return compared;
}

std::size_t count(const std::vector<ReplayedRequest>& replayed, Verdict verdict) {
  return tools::count(compared_of(replayed), verdict);
}

std::string report(const Session& session, const std::vector<ReplayedRequest>& replayed,
                   Times times) {
  ReportHead head{.title = "log", .times = times};
  head.notes = notes_of(session);
  return text_report(head, compared_of(replayed));
}

/// Returns all output of a replay as bytes, without times.
std::string bytes_of(const Session& session, const std::vector<ReplayedRequest>& replayed) {
  std::string bytes = report(session, replayed, Times::kHidden);
  ResponseFormat format;
  format.has_timing = false;
  for (const ReplayedRequest& item : replayed) {
    bytes += write_plan_response(item.result, format).value.value_or("unwritable");
  }
  return bytes;
}

TEST_F(ReplayTest, AgreesWithWhatPlanningAnswered) {
  record_session();
  const Session recorded = session();
  ASSERT_EQ(recorded.requests.size(), 16U);
  const auto replayed = run(recorded);
  EXPECT_EQ(count(replayed, Verdict::kSame), 16U) << report(recorded, replayed, Times::kShown);
  EXPECT_EQ(replayed[0].result.status, Status::kOk);
  EXPECT_EQ(replayed[3].result.status, Status::kInvalid);
  for (const ReplayedRequest& item : replayed) EXPECT_EQ(item.compared.difference.path_m, 0.0);
  const std::string table = report(recorded, replayed, Times::kShown);
  EXPECT_THAT(table, HasSubstr("12345.0"));
  EXPECT_THAT(table, HasSubstr("verdict: SAME: 16 requests: 16 same, 0 better, 0 different, 0 "
                               "worse, 0 regressed, 0 not compared"));
}

TEST_F(ReplayTest, GivesTheSameBytesForAnyNumberOfThreads) {
  record_session();
  const Session recorded = session();
  const std::string once = bytes_of(recorded, run(recorded, 1));
  EXPECT_EQ(bytes_of(recorded, run(recorded, 4)), once);
  EXPECT_EQ(bytes_of(recorded, run(recorded, 64)), once);
  // The session needs real correction.
  EXPECT_NE(once.find("\"inserted\""), std::string::npos);
}

TEST_F(ReplayTest, SeesAChangedAnswer) {
  const PlanRequest request = simple_request({{1, 0, 1}, {1, 0, -1}});
  PlanResult changed = planned(request);
  std::vector<motion::Segment> segments(changed.path.segments().begin(),
                                        changed.path.segments().end());
  segments[0].position[1].x() = std::nextafter(segments[0].position[1].x(), 9.0);
  changed.path = motion::Path(segments);
  log_.add_request(request, {"client", 1, 0});
  log_.add_answer(changed, header(1));
  PlanResult wrong_status = planned(request);
  wrong_status.status = Status::kInfeasible;
  log_.add_request(request, {"client", 2, 0});
  log_.add_answer(wrong_status, header(2));

  const Session recorded = session();
  const auto replayed = run(recorded);
  EXPECT_EQ(count(replayed, Verdict::kDifferent), 1U);
  EXPECT_EQ(count(replayed, Verdict::kRegressed), 1U);
  EXPECT_EQ(replayed[0].compared.difference.member, "segments[0].position[1][0]");
  EXPECT_GT(replayed[0].compared.difference.path_m, 0.0);
  EXPECT_EQ(replayed[1].compared.note, "one of the two proofs is wrong");
  EXPECT_THAT(report(recorded, replayed, Times::kHidden), HasSubstr("verdict: REGRESSED"));

  ReplayOptions tolerant;
  tolerant.thresholds.tolerance_m = 1e-9;
  NamedScenes scenes(scenes_);
  const auto within = replay(recorded, scenes, tolerant);
  EXPECT_EQ(within[0].compared.verdict, Verdict::kSame);
  EXPECT_EQ(within[1].compared.verdict, Verdict::kRegressed);
}

TEST_F(ReplayTest, PlansARepeatedRequestOnceAndLeavesOutAnIdUsedTwice) {
  const PlanRequest request = simple_request({{1, 0, 1}, {1, 0, -1}});
  record(request, 1);
  log_.add_request(request, {"client", 1, 99});  // sent again later
  log_.add_answer(planned(request), header(1));
  log_.add_request(simple_request({{2, 0, 1}, {2, 0, -1}}), {"client", 1, 0});
  log_.add_request(request, {"other", 1, 0});
  const Session recorded = session();
  ASSERT_EQ(recorded.requests.size(), 2U);
  EXPECT_EQ(recorded.requests[0].sent, 2U);
  EXPECT_EQ(recorded.conflicts, 1U);
  const auto replayed = run(recorded);
  EXPECT_EQ(replayed[0].compared.verdict, Verdict::kSame);
  EXPECT_EQ(replayed[1].compared.verdict, Verdict::kNotCompared);
  EXPECT_EQ(replayed[1].compared.note, "no answer in the log");
}

TEST_F(ReplayTest, PutsPagesTogether) {
  std::vector<geometry::Vec3> positions;
  for (int i = 0; i < 2500; ++i) positions.emplace_back(3 + 0.01 * i, 0, 0);
  PlanRequest request = simple_request(positions);
  request.options.deadline_s = 60;
  const PlanResult result = planned(request);
  log_.add_request(request, {"client", 1, 0});
  ASSERT_GT(log_.offsets().size(), 2U);
  log_.add_answer(result, header(1));
  const Session recorded = session();
  ASSERT_EQ(recorded.requests.size(), 1U);
  EXPECT_EQ(recorded.requests[0].request->keyframes.size(), 2500U);
  ASSERT_TRUE(recorded.requests[0].answer && recorded.requests[0].answer->result);
  EXPECT_TRUE(difference_of(*recorded.requests[0].answer->result, messages::to_wire(result, {}),
                            {motion::Body(request.camera), 3.0})
                  .has_same_bits());
  EXPECT_EQ(recorded.incomplete, 0U);
}

TEST_F(ReplayTest, CountsWhatItCannotUse) {
  log_.add_event("CAMWAY_PLAN_REQUEST", {1, 2, 3});
  log_.add_event("CAMWAY_PLAN_RESPONSE_client", std::vector<std::uint8_t>(76, 0xFF));
  log_.add_event("SOMETHING_ELSE", {4, 5});
  // An id that would name a file outside of the folder of responses.
  plan_request_t request = messages::to_wire(simple_request({{1, 0, 1}, {1, 0, -1}}), {"c", 1, 0});
  request.client_id = "../c";
  log_.add_event("CAMWAY_PLAN_REQUEST", wire::encode(request));
  log_.add_answer(planned(simple_request({{1, 0, 1}, {1, 0, -1}})), header(77));
  record(simple_request({{1, 0, 1}, {1, 0, -1}}), 1);
  const Session recorded = session();
  EXPECT_EQ(recorded.malformed, 3U);
  EXPECT_EQ(recorded.unasked, 1U);
  EXPECT_EQ(recorded.requests.size(), 1U);
  EXPECT_EQ(recorded.log.events, log_.offsets().size());
}

TEST_F(ReplayTest, DoesNotCompareWhatHangsOnTheMachine) {
  const PlanRequest request = simple_request({{1, 0, 1}, {1, 0, -1}});
  PlanResult timeout = planned(request);
  timeout.status = Status::kTimeout;
  log_.add_request(request, {"client", 1, 0});
  log_.add_answer(timeout, header(1));
  const auto busy = messages::plain_answer(plan_response_t::STATUS_OVERLOADED, "busy", header(2));
  log_.add_request(request, {"client", 2, 0});
  log_.add_event("CAMWAY_PLAN_RESPONSE_client", wire::encode(busy));
  const auto replayed = run(session());
  EXPECT_EQ(count(replayed, Verdict::kNotCompared), 2U);
  EXPECT_THAT(replayed[0].compared.note, HasSubstr("timeout"));
  EXPECT_EQ(replayed[1].compared.note, "recorded: overloaded");
}

TEST_F(ReplayTest, TakesTheAnswerThatCameAfterOverload) {
  const PlanRequest request = simple_request({{1, 0, 1}, {1, 0, -1}});
  const auto busy = messages::plain_answer(plan_response_t::STATUS_OVERLOADED, "busy", header(1));
  log_.add_request(request, {"client", 1, 0});
  log_.add_event("CAMWAY_PLAN_RESPONSE_client", wire::encode(busy));
  record(request, 1);
  const auto replayed = run(session());
  ASSERT_EQ(replayed.size(), 1U);
  EXPECT_EQ(replayed[0].compared.verdict, Verdict::kSame);
}

TEST_F(ReplayTest, KnowsWhichScenesItLacks) {
  PlanRequest request = simple_request({{1, 0, 1}, {1, 0, -1}});
  record(request, 1);
  request.scene = "office";
  log_.add_request(request, {"client", 2, 0});
  request.scene = "nowhere";
  PlanResult unknown;
  unknown.status = Status::kUnknownScene;
  log_.add_request(request, {"client", 3, 0});
  log_.add_answer(unknown, {{"client", 3, 0}, "nowhere", 0, ""});
  const Session recorded = session();
  EXPECT_THAT(missing_scenes(recorded, NamedScenes(scenes_)), ElementsAre("office"));
  EXPECT_THAT(missing_scenes(recorded, NamedScenes({})), ElementsAre("office", "wall"));
  const auto replayed = run(recorded);
  EXPECT_EQ(replayed[2].compared.verdict, Verdict::kSame);
}

TEST_F(ReplayTest, TellsThatTheSceneChanged) {
  const PlanRequest request = simple_request({{1, 0, 1}, {1, 0, -1}});
  messages::AnswerHeader other = header(1);
  other.scene_digest = "0123456789abcdef";
  log_.add_request(request, {"client", 1, 0});
  log_.add_answer(planned(request), other);
  const Session recorded = session();
  const auto replayed = run(recorded);
  EXPECT_TRUE(replayed[0].compared.scene_changed);
  EXPECT_EQ(replayed[0].compared.verdict, Verdict::kSame);
  EXPECT_THAT(report(recorded, replayed, Times::kHidden), HasSubstr("other triangles"));
}

TEST_F(ReplayTest, UsesTheGoodPartOfATruncatedLog) {
  record_session();
  const std::size_t cut = log_.offsets()[7] + 5;  // four requests with three answers, one cut
  const std::string file = folder_.write("log", log_.bytes().substr(0, cut));
  const Session recorded = read_session(file, "CAMWAY");
  EXPECT_EQ(recorded.log.events, 7U);
  EXPECT_NE(recorded.log.damage, "");
  const auto replayed = run(recorded);
  EXPECT_EQ(count(replayed, Verdict::kSame), 3U);
  EXPECT_EQ(count(replayed, Verdict::kNotCompared), 1U);
  EXPECT_THAT(report(recorded, replayed, Times::kHidden),
              HasSubstr("the log is damaged: 7 good events were used"));
}

TEST_F(ReplayTest, ListensToItsPrefixOnly) {
  log_.add_request(simple_request({{1, 0, 1}, {1, 0, -1}}), {"client", 1, 0}, "OTHER");
  EXPECT_TRUE(session().requests.empty());
  EXPECT_EQ(read_session(folder_.file("log"), "OTHER").requests.size(), 1U);
}

TEST_F(ReplayTest, CarriesBodiesAndClearance) {
  PlanRequest request = simple_request({{1.5, 0, 1}, {1.5, 0, -1}});
  request.camera = {};
  request.body = motion::BoxShape{{0, 0, 0}, {0.5, 0.25, 0.125}};
  request.options.clearance_m = 0.0625;
  record(request, 1);
  const Session recorded = session();
  ASSERT_EQ(recorded.requests.size(), 1U);
  ASSERT_TRUE(recorded.requests[0].request);
  const PlanRequest& read = *recorded.requests[0].request;
  ASSERT_TRUE(read.body);
  EXPECT_EQ(std::get<motion::BoxShape>(*read.body).size_m, geometry::Vec3(0.5, 0.25, 0.125));
  EXPECT_EQ(read.options.clearance_m, 0.0625);
  EXPECT_EQ(run(recorded)[0].compared.verdict, Verdict::kSame);
}

// The daemon's scene had bounds, which neither digest nor request contains.
TEST_F(ReplayTest, PlansWithinTheBoundsOfTheAnswer) {
  const auto without = scenes_["wall"];
  auto bounded = std::make_shared<scene::Snapshot>(*without);
  bounded->options.bounds.max_W.y() = 0.9;
  scenes_["wall"] = bounded;
  record(simple_request({{1, 0, 1}, {0.5, 0.75, 0.5}, {-0.5, 0.75, 0.5}, {-1, 0, 1}}), 1);
  record(simple_request({{1, 2, 1}, {1, 0, 1}}), 2);
  scenes_["wall"] = without;
  const auto replayed = run(session());
  ASSERT_EQ(replayed.size(), 2U);
  for (const ReplayedRequest& item : replayed) {
    EXPECT_EQ(item.compared.verdict, Verdict::kSame) << item.compared.difference.what();
    EXPECT_EQ(item.result.bounds, bounded->options.bounds);
  }
  EXPECT_EQ(replayed[1].result.status, planning::Status::kInvalid);
}

TEST_F(ReplayTest, TellsALogOfAnotherVersionFromADamagedOne) {
  std::vector<std::uint8_t> older =
      wire::encode(messages::to_wire(simple_request({{1, 0, 1}, {1, 0, -1}}), {"c", 1, 0}));
  older[3] ^= 1;  // within the fingerprint
  log_.add_event("CAMWAY_PLAN_REQUEST", older);
  log_.add_event("CAMWAY_PLAN_REQUEST", {1, 2, 3});
  record(simple_request({{1, 0, 1}, {1, 0, -1}}), 2);
  const Session recorded = session();
  EXPECT_EQ(recorded.malformed, 2U);
  EXPECT_EQ(recorded.other_version, 1U);
  const std::string table = report(recorded, run(recorded), Times::kHidden);
  EXPECT_THAT(table, HasSubstr("note: 1 message left out: malformed\n"));
  EXPECT_THAT(table, HasSubstr("note: 1 message left out: of another version of the wire types"));
}

}  // namespace
}  // namespace camway::tools
