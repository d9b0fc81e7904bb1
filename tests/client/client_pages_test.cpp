// SPDX-License-Identifier: MIT
#include <camway/client.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <vector>

#include "lcmtypes/wire/layout.h"
#include "tests/client/client_fixture.h"
#include "tests/client/fake_daemon.h"
#include "tests/support/random.h"

namespace camway {
namespace {

using ::testing::HasSubstr;
using testing_support::answer_pages;
using testing_support::Bytes;
using testing_support::ClientTest;
using testing_support::encode_all;
using testing_support::FakeDaemon;
using testing_support::quick;
using testing_support::small_request;

constexpr std::uint32_t kPagesSeed = 2006;

TEST_F(ClientTest, AsksAgainForLostPagesAndKeepsThoseThatCame) {
  int calls = 0;
  FakeDaemon daemon;
  daemon.on_plan = [&](const plan_request_t& request) {
    std::vector<Bytes> pages = encode_all(answer_pages(request, 40, 10));
    // The even pages come first, then the odd ones: only a client that keeps pages gets them all.
    ++calls;
    return calls == 1 ? std::vector<Bytes>{pages[0], pages[2]}
                      : std::vector<Bytes>{pages[3], pages[1]};
  };
  daemon.start();
  Client client(quick());
  const PlanResponse response = client.plan(small_request());
  ASSERT_TRUE(response.ok()) << response.error;
  EXPECT_EQ(response.path.segments().size(), 40u);
  EXPECT_EQ(response.tries, 2);
}

TEST_F(ClientTest, SaysWhichPagesAreMissing) {
  FakeDaemon daemon;
  daemon.on_plan = [](const plan_request_t& request) {
    return std::vector<Bytes>{encode_all(answer_pages(request, 40, 10))[1]};
  };
  daemon.start();
  ClientOptions options = quick();
  options.deadline_s = 1.0;
  Client client(options);
  const PlanResponse response = client.plan(small_request());
  EXPECT_EQ(response.status, Status::kNoAnswer);
  EXPECT_THAT(response.error, HasSubstr("only 1 of 4 pages came"));
}

TEST_F(ClientTest, PagesALargeRequest) {
  constexpr std::size_t kKeyframes = 20'000;
  std::set<int> pages;
  FakeDaemon daemon;
  daemon.on_plan = [&](const plan_request_t& page) {
    pages.insert(page.page);
    const bool all = static_cast<int>(pages.size()) == page.num_pages;
    return all ? encode_all(answer_pages(page, 1, 1)) : std::vector<Bytes>{};
  };
  daemon.start();
  ClientOptions options = quick();
  // On a busy machine this many pages take some time.
  options.try_timeout_s = 2.0;
  options.max_try_timeout_s = 4.0;
  Client client(options);
  PlanRequest request = small_request();
  request.keyframes.resize(kKeyframes);
  const PlanResponse response = client.plan(request);
  ASSERT_TRUE(response.ok()) << response.error;
  EXPECT_GT(pages.size(), 20u);
}

TEST_F(ClientTest, ReceivesALargeAnswerThroughLosses) {
  // 188 pages; a different tenth of them is lost each time.
  testing::Random random(kPagesSeed);
  FakeDaemon daemon;
  daemon.on_plan = [&](const plan_request_t& request) {
    std::vector<Bytes> pages = encode_all(answer_pages(request, 30'000, 160));
    pages.erase(
        std::remove_if(pages.begin(), pages.end(), [&](auto&) { return random() % 10 == 0; }),
        pages.end());
    return pages;
  };
  daemon.start();
  Client client(quick());
  const PlanResponse response = client.plan(small_request());
  ASSERT_TRUE(response.ok()) << response.error;
  EXPECT_EQ(response.path.segments().size(), 30'000u);
}

TEST_F(ClientTest, AsksForJustThePagesThatWereLost) {
  std::vector<Bytes> pages;
  std::vector<std::int32_t> asked;
  FakeDaemon daemon;
  daemon.on_plan = [&](const plan_request_t& request) {
    pages = encode_all(answer_pages(request, 60, 10));
    return std::vector<Bytes>{pages[0], pages[2], pages[5]};
  };
  daemon.on_missing = [&](const missing_pages_t& question) {
    std::vector<Bytes> some;
    for (const std::int32_t page : question.missing) {
      asked.push_back(page);
      some.push_back(pages[std::size_t(page)]);
    }
    return some;
  };
  daemon.start();
  Client client(quick());
  const PlanResponse response = client.plan(small_request());
  ASSERT_TRUE(response.ok()) << response.error;
  EXPECT_EQ(response.path.segments().size(), 60u);
  EXPECT_EQ(response.tries, 1);
  EXPECT_EQ(asked, (std::vector<std::int32_t>{1, 3, 4}));
}

TEST_F(ClientTest, SendsThePagesThatTheDaemonLacks) {
  std::set<std::int32_t> seen;
  int dropped = 0;
  FakeDaemon daemon;
  daemon.on_plan = [&](const plan_request_t& page) {
    if (page.page == 1 && dropped < 1) {
      ++dropped;
      return std::vector<Bytes>{};
    }
    seen.insert(page.page);
    if (static_cast<int>(seen.size()) == page.num_pages) {
      return encode_all(answer_pages(page, 1, 1));
    }
    if (page.page + 1 == page.num_pages) {
      missing_pages_t question{};
      question.client_id = page.client_id;
      question.request_id = page.request_id;
      for (std::int32_t i = 0; i < page.num_pages; ++i) {
        if (seen.count(i) == 0) question.missing.push_back(i);
      }
      question.missing.push_back(-1);
      question.missing.push_back(page.num_pages);
      question.num_missing = static_cast<std::int32_t>(question.missing.size());
      daemon.publish("CAMWAY_MISSING_PAGES_" + page.client_id, wire::encode(question));
    }
    return std::vector<Bytes>{};
  };
  daemon.start();
  ClientOptions options = quick();
  options.try_timeout_s = options.max_try_timeout_s = 10.0;
  Client client(options);
  PlanRequest request = small_request();
  request.keyframes.resize(2500);
  const PlanResponse response = client.plan(request);
  ASSERT_TRUE(response.ok()) << response.error;
  EXPECT_EQ(response.tries, 1);
  daemon.stop();
  EXPECT_EQ(dropped, 1);
}

}  // namespace
}  // namespace camway
