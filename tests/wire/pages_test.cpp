// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>

#include "daemon/messages/plan.h"
#include "daemon/planning/request/validate.h"
#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/page_assembly.h"
#include "tests/messages/plan_samples.h"
#include "tests/messages/request_on_wire.h"

namespace camway::wire {
namespace {

using messages::AnswerHeader;
using messages::to_wire;
using testing::below;
using testing::kSeed;
using testing::Random;
using testing::sample_request;
using testing::sample_result;

const AnswerHeader kHeader{{"tester", 5, 1'000'000}, "room", 7, "abc"};

plan_request_t request_of(std::size_t keyframes, std::int64_t id, Random& random) {
  return to_wire(sample_request(keyframes, random), {"tester", id, 0});
}

template <class Message>
Message decoded(const Bytes& bytes) {
  wire::Decoded<Message> result = wire::decode<Message>(bytes);
  EXPECT_TRUE(result.message) << result.fault.text("");
  return result.message.value_or(Message{});
}

/// Adds pages in the given order. Only the last may complete the message.
template <class Message>
std::optional<Message> joined(const std::vector<Bytes>& pages) {
  PageAssembly<Message> assembly;
  for (std::size_t i = 0; i < pages.size(); ++i) {
    auto outcome = assembly.add(decoded<Message>(pages[i]));
    EXPECT_EQ(outcome.error, "");
    EXPECT_EQ(outcome.whole.has_value(), i + 1 == pages.size());
    EXPECT_EQ(assembly.half_received(), i + 1 == pages.size() ? 0U : 1U);
    if (outcome.whole) return outcome.whole;
  }
  return std::nullopt;
}

TEST(WirePages, EveryPageFitsAndTogetherTheyAreTheWhole) {
  Random random(kSeed);
  for (const std::size_t segments : {0U, 1U, 100U, 125U, 126U, 1000U, 5000U}) {
    SCOPED_TRACE(segments);
    const plan_response_t whole = to_wire(sample_result(segments, random), kHeader);
    std::vector<Bytes> pages = wire::encode_pages(whole);
    ASSERT_EQ(wire::count_pages(whole), pages.size());
    for (const Bytes& page : pages) ASSERT_LE(page.size(), wire::kMaxMessageBytes);
    // Elements have 336 bytes: a page except the last wastes less than one of them.
    for (std::size_t i = 0; i + 1 < pages.size(); ++i) {
      EXPECT_GT(pages[i].size() + 336, wire::kMaxMessageBytes);
    }
    std::shuffle(pages.begin(), pages.end(), random);
    const std::optional<plan_response_t> back = joined<plan_response_t>(pages);
    ASSERT_TRUE(back);
    EXPECT_EQ(wire::encode(*back), wire::encode(whole));
  }
}

TEST(WirePages, AProofOfManyTrianglesComesInPages) {
  planning::PlanResult result;
  result.status = planning::Status::kInfeasible;
  planning::Infeasibility& proof = result.infeasibility.emplace();
  for (std::uint32_t i = 0; i < 100'000; ++i) proof.triangles.push_back(3 * i);
  const plan_response_t whole = to_wire(result, kHeader);
  const std::vector<Bytes> pages = wire::encode_pages(whole);
  EXPECT_EQ(pages.size(), 7U);
  EXPECT_EQ(wire::count_pages(whole), pages.size());
  for (const Bytes& page : pages) ASSERT_LE(page.size(), wire::kMaxMessageBytes);
  const std::optional<plan_response_t> back = joined<plan_response_t>(pages);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->proof_triangles, whole.proof_triangles);
}

TEST(WirePages, RequestsComeInPagesToo) {
  Random random(kSeed);
  for (const std::size_t keyframes : {0U, 900U, 1000U, 20'000U}) {
    SCOPED_TRACE(keyframes);
    const plan_request_t whole = request_of(keyframes, 5, random);
    std::vector<Bytes> pages = wire::encode_pages(whole);
    for (const Bytes& page : pages) ASSERT_LE(page.size(), wire::kMaxMessageBytes);
    std::shuffle(pages.begin(), pages.end(), random);
    const std::optional<plan_request_t> back = joined<plan_request_t>(pages);
    ASSERT_TRUE(back);
    EXPECT_EQ(wire::encode(*back), wire::encode(whole));
  }
}

TEST(WirePages, TheListsOfABodyGoOnOverPagesAndItsNumbersStandOnPageZero) {
  Random random(kSeed);
  planning::PlanRequest request = sample_request(5000, random);
  request.body = testing::largest_body(random);
  const plan_request_t whole = to_wire(request, {"tester", 5, 0});
  std::vector<Bytes> pages = wire::encode_pages(whole);
  ASSERT_GT(pages.size(), 5U);
  std::size_t points = 0;
  for (std::size_t i = 0; i < pages.size(); ++i) {
    ASSERT_LE(pages[i].size(), wire::kMaxMessageBytes);
    const auto page = decoded<plan_request_t>(pages[i]);
    EXPECT_EQ(page.body.type, i == 0 ? body_t::MESH : body_t::CAMERA);
    points += page.body.points_m.size();
    if (!page.keyframes.empty()) {
      EXPECT_EQ(points, motion::kMaxBodyVertices) << "come first";
    }
  }
  EXPECT_EQ(points, motion::kMaxBodyVertices);
  std::shuffle(pages.begin(), pages.end(), random);
  const std::optional<plan_request_t> back = joined<plan_request_t>(pages);
  ASSERT_TRUE(back);
  EXPECT_EQ(wire::encode(*back), wire::encode(whole));
}

TEST(WirePages, NumbersOfABodyOnALaterPageDoNotCount) {
  Random random(kSeed);
  planning::PlanRequest request = sample_request(1100, random);
  request.body = motion::SphereShape{{1, 2, 3}, 0.5};
  const plan_request_t whole = to_wire(request, {"tester", 5, 0});
  std::vector<Bytes> pages = wire::encode_pages(whole);
  ASSERT_EQ(pages.size(), 2U);
  auto later = decoded<plan_request_t>(pages[1]);
  later.body = whole.body;
  later.body.radius_m = 7.0;
  pages[1] = wire::encode(later);
  std::swap(pages[0], pages[1]);
  const std::optional<plan_request_t> back = joined<plan_request_t>(pages);
  ASSERT_TRUE(back);
  EXPECT_EQ(wire::encode(*back), wire::encode(whole));
}

TEST(WirePages, TheLargestRequestFitsThePagesAllowed) {
  plan_request_t whole{};
  whole.client_id = std::string(32, 'c');
  whole.scene = std::string(wire::kMaxSceneNameBytes, 's');
  whole.method = std::string(wire::kMaxMethodBytes, 'm');
  Random random(kSeed);
  planning::PlanRequest request;
  request.body = testing::largest_body(random);
  whole.body = to_wire(request, {}).body;
  whole.keyframes.resize(planning::kMaxKeyframes);
  whole.num_keyframes = static_cast<std::int32_t>(whole.keyframes.size());
  EXPECT_LE(wire::encode_pages(whole).size(), static_cast<std::size_t>(wire::kMaxRequestPages));
}

TEST(WirePages, SameMessageSameBytes) {
  Random random(kSeed);
  const plan_response_t whole = to_wire(sample_result(700, random), kHeader);
  EXPECT_EQ(wire::encode_pages(whole), wire::encode_pages(plan_response_t(whole)));
  plan_response_t page_of_another = whole;
  page_of_another.page = 3;
  page_of_another.num_pages = 9;
  EXPECT_EQ(wire::encode_pages(page_of_another), wire::encode_pages(whole));
}

TEST(PageAssembly, PagesMayComeTwice) {
  Random random(kSeed);
  const plan_request_t whole = request_of(2200, 5, random);
  const std::vector<Bytes> pages = wire::encode_pages(whole);
  ASSERT_EQ(pages.size(), 4U);
  PageAssembly<plan_request_t> assembly;
  for (const std::size_t page : {0U, 0U, 2U, 1U, 2U}) {
    EXPECT_FALSE(assembly.add(decoded<plan_request_t>(pages[page])).whole);
  }
  const auto outcome = assembly.add(decoded<plan_request_t>(pages[3]));
  ASSERT_TRUE(outcome.whole);
  EXPECT_EQ(wire::encode(*outcome.whole), wire::encode(whole));
}

TEST(PageAssembly, ALaterTimeOfSendingIsStillTheSameMessage) {
  Random random(kSeed);
  const std::vector<Bytes> pages = wire::encode_pages(request_of(1100, 5, random));
  ASSERT_EQ(pages.size(), 2U);
  PageAssembly<plan_request_t> assembly;
  EXPECT_FALSE(assembly.add(decoded<plan_request_t>(pages[0])).whole);
  plan_request_t second = decoded<plan_request_t>(pages[1]);
  second.utime = 12345;
  EXPECT_TRUE(assembly.add(std::move(second)).whole);
}

TEST(PageAssembly, AnotherMessageUnderTheSameIdsBeginsAnew) {
  Random random(kSeed);
  const std::vector<Bytes> old_pages = wire::encode_pages(request_of(1100, 5, random));
  plan_request_t other = request_of(1100, 5, random);
  other.scene = "elsewhere";
  const std::vector<Bytes> new_pages = wire::encode_pages(other);
  PageAssembly<plan_request_t> assembly;
  EXPECT_FALSE(assembly.add(decoded<plan_request_t>(old_pages[0])).whole);
  EXPECT_FALSE(assembly.add(decoded<plan_request_t>(new_pages[1])).whole);
  EXPECT_EQ(assembly.half_received(), 1U);
  const auto outcome = assembly.add(decoded<plan_request_t>(new_pages[0]));
  ASSERT_TRUE(outcome.whole);
  EXPECT_EQ(wire::encode(*outcome.whole), wire::encode(other));
}

TEST(PageAssembly, GivesUpTheOneThatWaitedLongest) {
  Random random(kSeed);
  PageAssembly<plan_request_t> assembly({.max_messages = 3, .max_bytes = std::size_t{1} << 30});
  std::vector<std::vector<Bytes>> messages;
  for (std::int64_t id = 0; id < 4; ++id) {
    messages.push_back(wire::encode_pages(request_of(1700, id, random)));
    ASSERT_EQ(messages.back().size(), 3U);
    // A second page for message 0 makes message 1 the one that has waited longest.
    if (id == 3) {
      EXPECT_FALSE(assembly.add(decoded<plan_request_t>(messages[0][1])).whole);
    }
    const auto outcome = assembly.add(decoded<plan_request_t>(messages.back()[0]));
    EXPECT_FALSE(outcome.whole);
    EXPECT_EQ(outcome.given_up, id == 3 ? 1U : 0U);
  }
  EXPECT_EQ(assembly.half_received(), 3U);
  EXPECT_TRUE(assembly.add(decoded<plan_request_t>(messages[0][2])).whole);
  EXPECT_FALSE(assembly.add(decoded<plan_request_t>(messages[1][1])).whole);
  EXPECT_FALSE(assembly.add(decoded<plan_request_t>(messages[1][2])).whole) << "page 0 is gone";
}

TEST(PageAssembly, HoldsABoundedNumberOfBytes) {
  Random random(kSeed);
  constexpr std::size_t kMaxBytes = 200'000;
  PageAssembly<plan_request_t> assembly({.max_messages = 1000, .max_bytes = kMaxBytes});
  for (std::int64_t id = 0; id < 50; ++id) {
    const std::vector<Bytes> pages = wire::encode_pages(request_of(1100, id, random));
    EXPECT_FALSE(assembly.add(decoded<plan_request_t>(pages[0])).whole);
    EXPECT_LE(assembly.half_received() * (wire::kMaxMessageBytes - 500), kMaxBytes);
  }
}

TEST(PageAssembly, RefusesPageNumbersThatCannotBe) {
  PageAssembly<plan_request_t> assembly;
  const auto error_of = [&](std::int32_t page, std::int32_t num_pages) {
    plan_request_t message{};
    message.page = page;
    message.num_pages = num_pages;
    return assembly.add(std::move(message)).error;
  };
  EXPECT_EQ(error_of(0, 0), "num_pages: 0 is not within 1 to 256");
  EXPECT_EQ(error_of(0, -4), "num_pages: -4 is not within 1 to 256");
  EXPECT_EQ(error_of(0, 2'000'000'000), "num_pages: 2000000000 is not within 1 to 256");
  EXPECT_EQ(error_of(2, 2), "page: 2 is not within 0 to 1");
  EXPECT_EQ(error_of(-1, 2), "page: -1 is not within 0 to 1");
  EXPECT_EQ(error_of(1, 1), "page: 1 is not within 0 to 0");
  EXPECT_EQ(assembly.half_received(), 0U);
}

TEST(PageAssembly, AsksAFewTimesForPagesThatDoNotCome) {
  using Assembly = PageAssembly<plan_request_t>;
  Random random(kSeed);
  const plan_request_t whole = to_wire(sample_request(3000, random), {"asker", 5, 0});
  std::vector<plan_request_t> pages;
  for (const Bytes& bytes : wire::encode_pages(whole)) {
    pages.push_back(*wire::decode<plan_request_t>(bytes).message);
  }
  ASSERT_GT(pages.size(), 3U);
  Assembly assembly;
  EXPECT_EQ(assembly.next_missing(), Assembly::Clock::time_point::max());
  Assembly::Clock::time_point now = Assembly::Clock::now();
  ASSERT_FALSE(assembly.add(pages[1], now).whole);
  EXPECT_TRUE(assembly.take_missing(now).empty()) << "more may be on their way";
  int asked = 0;
  while (assembly.next_missing() != Assembly::Clock::time_point::max()) {
    now = assembly.next_missing();
    const std::vector<missing_pages_t> gaps = assembly.take_missing(now);
    ASSERT_EQ(gaps.size(), 1U);
    EXPECT_EQ(gaps[0].client_id, "asker");
    EXPECT_EQ(gaps[0].request_id, 5);
    EXPECT_EQ(gaps[0].missing.size(), pages.size() - 1);
    EXPECT_EQ(gaps[0].missing[0], 0);
    EXPECT_EQ(gaps[0].missing[1], 2);
    ++asked;
  }
  EXPECT_EQ(asked, Assembly::kMostAsked);
  ASSERT_FALSE(assembly.add(pages[0], now).whole);
  EXPECT_EQ(assembly.next_missing(), now + Assembly::kPageWait) << "a page came, so it asks anew";
}

}  // namespace
}  // namespace camway::wire
