// SPDX-License-Identifier: MIT
#include "daemon/service/core/answer_cache.h"

#include <gtest/gtest.h>

#include "daemon/messages/plan.h"
#include "tests/messages/plan_samples.h"
#include "tests/messages/request_on_wire.h"

namespace camway::service {
namespace {

using Known = AnswerCache::Known;

const RequestDigest kDigest{1, 2};
const RequestDigest kOtherDigest{1, 3};

Pages answer_of(std::size_t bytes) { return one_page(Bytes(bytes)); }

void plan(AnswerCache& cache, const RequestKey& key, std::size_t bytes) {
  ASSERT_EQ(cache.find_or_begin(key, kDigest).known, Known::kNew);
  cache.finish(key, answer_of(bytes));
}

TEST(AnswerCache, FollowsARequestFromNewToAnswered) {
  AnswerCache cache;
  const RequestKey key{"a", 1};
  EXPECT_EQ(cache.find_or_begin(key, kDigest).known, Known::kNew);
  EXPECT_EQ(cache.find_or_begin(key, kDigest).known, Known::kRunning);
  EXPECT_EQ(cache.find_or_begin(key, kOtherDigest).known, Known::kConflict);
  const Pages pages = answer_of(10);
  cache.finish(key, pages);
  const AnswerCache::Found found = cache.find_or_begin(key, kDigest);
  EXPECT_EQ(found.known, Known::kAnswered);
  EXPECT_EQ(found.pages, pages);
  EXPECT_EQ(cache.find_or_begin(key, kOtherDigest).known, Known::kConflict);
}

TEST(AnswerCache, KeepsClientsAndIdsApart) {
  AnswerCache cache;
  plan(cache, {"a", 1}, 10);
  EXPECT_EQ(cache.find_or_begin({"b", 1}, kOtherDigest).known, Known::kNew);
  EXPECT_EQ(cache.find_or_begin({"a", 2}, kOtherDigest).known, Known::kNew);
}

TEST(AnswerCache, ForgottenRequestsAreNewAgain) {
  AnswerCache cache;
  EXPECT_EQ(cache.find_or_begin({"a", 1}, kDigest).known, Known::kNew);
  cache.forget({"a", 1});
  EXPECT_EQ(cache.find_or_begin({"a", 1}, kOtherDigest).known, Known::kNew);
  cache.finish({"a", 1}, answer_of(1));
  cache.forget({"a", 1});
  EXPECT_EQ(cache.find_or_begin({"a", 1}, kOtherDigest).known, Known::kAnswered)
      << "answers are not forgotten";
}

TEST(AnswerCache, IsBoundedInCountAndDropsWhatWasLongestNotAskedFor) {
  AnswerCache cache({.max_answers = 3, .max_bytes = 1'000'000});
  for (std::int64_t id = 0; id < 3; ++id) plan(cache, {"a", id}, 10);
  EXPECT_EQ(cache.find_or_begin({"a", 0}, kDigest).known, Known::kAnswered);
  plan(cache, {"a", 3}, 10);
  EXPECT_EQ(cache.answers(), 3U);
  EXPECT_EQ(cache.find_or_begin({"a", 0}, kDigest).known, Known::kAnswered);
  EXPECT_EQ(cache.find_or_begin({"a", 1}, kDigest).known, Known::kNew);
}

TEST(AnswerCache, IsBoundedInBytes) {
  AnswerCache cache({.max_answers = 1000, .max_bytes = 100});
  for (std::int64_t id = 0; id < 50; ++id) {
    plan(cache, {"a", id}, 30);
    EXPECT_LE(cache.bytes(), 100U);
  }
  EXPECT_EQ(cache.answers(), 3U);
  plan(cache, {"a", 50}, 101);
  EXPECT_EQ(cache.answers(), 0U) << "one answer that is too large empties it";
  EXPECT_EQ(cache.bytes(), 0U);
}

TEST(AnswerCache, RunningRequestsAreNeverDropped) {
  AnswerCache cache({.max_answers = 1, .max_bytes = 100});
  EXPECT_EQ(cache.find_or_begin({"slow", 1}, kDigest).known, Known::kNew);
  for (std::int64_t id = 0; id < 10; ++id) plan(cache, {"a", id}, 30);
  EXPECT_EQ(cache.find_or_begin({"slow", 1}, kDigest).known, Known::kRunning);
}

// A path may be watched for longer than its answer is kept, and the ids be used again by then.
TEST(AnswerCache, AnAnswerReplacesNoneOfAnotherRequest) {
  AnswerCache cache;
  const RequestKey key{"client", 1};
  cache.find_or_begin(key, kOtherDigest);
  cache.replace(key, kDigest, answer_of(10));
  EXPECT_EQ(cache.find_or_begin(key, kOtherDigest).known, Known::kRunning);
  const Pages own = answer_of(20);
  cache.finish(key, own);
  cache.replace(key, kDigest, answer_of(10));
  EXPECT_EQ(cache.find_or_begin(key, kOtherDigest).pages, own);
}

TEST(RequestDigest, IsOfContentAlone) {
  testing::Random random(testing::kSeed);
  const plan_request_t request =
      messages::to_wire(testing::sample_request(3, random), {"tester", 5, 1'000'000});
  plan_request_t resent = request;
  resent.utime = 2'000'000;
  EXPECT_EQ(digest_of(request), digest_of(resent));
  plan_request_t changed = request;
  changed.keyframes[1].position_m[2] += 1e-9;
  EXPECT_NE(digest_of(request), digest_of(changed));
  changed = request;
  changed.deadline_s += 1.0;
  EXPECT_NE(digest_of(request), digest_of(changed));
  changed = request;
  changed.clearance_m += 0.25;
  EXPECT_NE(digest_of(request), digest_of(changed));
  changed = request;
  changed.objective = static_cast<std::int8_t>(3 - changed.objective);
  EXPECT_NE(digest_of(request), digest_of(changed));
  changed = request;
  changed.orientation.max_turn_rad += 0.25;
  EXPECT_NE(digest_of(request), digest_of(changed));
  changed = request;
  changed.seed += 1;
  EXPECT_NE(digest_of(request), digest_of(changed));
  changed = request;
  changed.body = messages::wire_body(motion::SphereShape{{0, 0, 0}, 0.5});
  const RequestDigest with_ball = digest_of(changed);
  EXPECT_NE(digest_of(request), with_ball);
  changed.body.radius_m = 0.25;
  EXPECT_NE(with_ball, digest_of(changed));
}

}  // namespace
}  // namespace camway::service
