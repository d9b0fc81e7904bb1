// SPDX-License-Identifier: MIT
#include "tools/camway/replay/compare/comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tools/camway/replay/log_builder.h"

namespace camway::tools {
namespace {

/// A log of requests with answers that are invalid, since planning is not what matters here.
class ComparisonTest : public ::testing::Test {
 protected:
  static planning::PlanRequest request(double x) { return simple_request({{x, 0, 1}, {x, 0, -1}}); }
  static void add(LogBuilder& log, double x, const std::string& client, std::int64_t id,
                  planning::Status status = planning::Status::kPartial) {
    log.add_request(request(x), {client, id, 0});
    planning::PlanResult result;
    result.status = status;
    log.add_answer(result, {{client, id, 0}, "wall", 1, "digest"});
  }
  [[nodiscard]] Session read(const LogBuilder& log, const std::string& name) const {
    return read_session(folder_.write(name, log.bytes()), "CAMWAY");
  }

  TemporaryFolder folder_;
};

TEST_F(ComparisonTest, JoinsByIdsAndElseByContent) {
  LogBuilder then, now;
  add(then, 1, "a", 1);
  add(then, 2, "a", 2);
  add(then, 3, "a", 3);
  add(then, 3, "a", 4);
  add(now, 3, "b", 77);
  add(now, 1, "a", 1, planning::Status::kOk);
  add(now, 3, "b", 78, planning::Status::kOk);
  add(now, 9, "b", 79);
  const Session before = read(then, "then");
  Session after = read(now, "now");
  const auto compared = compare(before, after, {});
  ASSERT_EQ(compared.size(), 5U);
  EXPECT_EQ(compared[0].verdict, Verdict::kBetter);
  EXPECT_EQ(compared[1].note, "only in the baseline");
  EXPECT_EQ(compared[2].verdict, Verdict::kSame) << compared[2].note;
  EXPECT_EQ(compared[3].verdict, Verdict::kBetter) << "the second of the same content";
  EXPECT_EQ(compared[4].note, "only in the new log");
  EXPECT_EQ(compared[4].recorded->ids.request_id, 79);
  EXPECT_TRUE(has_failed(compared, {Verdict::kBetter}));
  EXPECT_FALSE(has_failed(compared, kFailing));
}

TEST_F(ComparisonTest, DoesNotCompareAnIdThatHasAnotherRequestNow) {
  LogBuilder then, now;
  add(then, 1, "a", 1);
  add(now, 2, "a", 1);
  const Session before = read(then, "then");
  Session after = read(now, "now");
  const auto compared = compare(before, after, {});
  ASSERT_EQ(compared.size(), 1U);
  EXPECT_EQ(compared[0].note, "another request has this id now");
}

TEST_F(ComparisonTest, ContentIsWithoutIdsAndTheTimeOfSending) {
  LogBuilder log;
  log.add_request(request(1), {"a", 1, 5});
  log.add_request(request(1), {"b", 2, 6});
  planning::PlanRequest other = request(1);
  other.options.seed = 7;
  log.add_request(other, {"b", 3, 6});
  const Session session = read(log, "log");
  ASSERT_EQ(session.requests.size(), 3U);
  EXPECT_EQ(session.requests[0].content_digest, session.requests[1].content_digest);
  EXPECT_NE(session.requests[0].content_digest, session.requests[2].content_digest);
  EXPECT_EQ(session.requests[0].received_s, 0.0);
  EXPECT_NEAR(session.requests[1].received_s, 0.001, 1e-9) << "events are 1 ms apart";
}

}  // namespace
}  // namespace camway::tools
