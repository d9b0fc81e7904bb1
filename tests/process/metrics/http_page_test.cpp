// SPDX-License-Identifier: MIT
#include "daemon/process/metrics/http_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <ctime>
#include <list>
#include <thread>
#include <vector>

#include "tests/support/http_get.h"

namespace camway::process {
namespace {

using testing::body_of;
using ::testing::HasSubstr;
using testing::http_request;
using testing::LocalConnection;
using ::testing::StartsWith;

HttpContent hello() {
  return {"/page", "text/plain; charset=x", [] { return "hello\n"; }};
}

base::Result<std::unique_ptr<http::Server>> open_page(const http::Address& address = {},
                                                      const HttpLimits& limits = {}) {
  return open_http_page(address, hello(), limits);
}

TEST(HttpPage, AnswersItsPathAndNothingElse) {
  const auto opened = open_page();
  ASSERT_TRUE(opened) << opened.error;
  const int port = (*opened)->port();
  const std::string answer = http_request(port, "GET", "/page");
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 200 "));
  EXPECT_THAT(answer, HasSubstr("Content-Type: text/plain; charset=x\r\n"));
  EXPECT_EQ(body_of(answer), "hello\n");
  EXPECT_EQ(body_of(http_request(port, "HEAD", "/page")), "");
  EXPECT_THAT(http_request(port, "GET", "/"), StartsWith("HTTP/1.1 404 "));
  EXPECT_THAT(http_request(port, "POST", "/page"), StartsWith("HTTP/1.1 405 "));
  EXPECT_THAT(http_request(port, "GET", "/../page"), StartsWith("HTTP/1.1 404 "));
}

TEST(HttpPage, ATakenPortIsAnErrorThatSaysSo) {
  const auto first = open_page();
  ASSERT_TRUE(first) << first.error;
  const int port = (*first)->port();
  const auto second = open_page({"127.0.0.1", port});
  EXPECT_FALSE(second);
  EXPECT_EQ(second.error,
            "cannot listen on 127.0.0.1 port " + std::to_string(port) + ": Address already in use");
}

TEST(HttpPage, AnAddressThatIsNoneOrNotOurs) {
  EXPECT_EQ(open_page({"localhost", 0}).error, "'localhost' is no IPv4 or IPv6 address");
  EXPECT_THAT(open_page({"192.0.2.1", 0}).error, HasSubstr("cannot listen on 192.0.2.1"));
}

TEST(HttpPage, SlowOnesAndManyHoldUpNobody) {
  const auto opened = open_page();
  ASSERT_TRUE(opened) << opened.error;
  const int port = (*opened)->port();
  std::list<LocalConnection> slow;
  for (int i = 0; i < 8; ++i) {
    slow.emplace_back(port);
    ASSERT_TRUE(slow.back().send("GET /page HT"));
  }
  std::atomic<int> good = 0;
  {
    std::vector<std::jthread> threads;
    for (int thread = 0; thread < 4; ++thread) {
      threads.emplace_back([&] {
        for (int i = 0; i < 50; ++i) {
          if (body_of(http_request(port, "GET", "/page")) == "hello\n") ++good;
        }
      });
    }
  }
  EXPECT_EQ(good, 200);
}

TEST(HttpPage, ASilentConnectionIsClosed) {
  const auto opened = open_page({}, {.idle_s = 1});
  ASSERT_TRUE(opened) << opened.error;
  const LocalConnection silent((*opened)->port());
  ASSERT_TRUE(silent.good());
  const LocalConnection slow((*opened)->port());
  ASSERT_TRUE(slow.send("GET /page HT"));
  EXPECT_TRUE(silent.ends()) << "and this test did not give up first";
  EXPECT_TRUE(slow.ends());
}

/// Connections beyond the limit wait until others end.
TEST(HttpPage, NoMoreThanSoManyAreServedAtATime) {
  std::atomic<int> full = 0;
  HttpContent content = hello();
  content.on_full = [&full] { ++full; };
  const auto opened = open_http_page({}, content, {.connections = 3, .idle_s = 600});
  ASSERT_TRUE(opened) << opened.error;
  const int port = (*opened)->port();
  std::list<LocalConnection> silent;
  for (int i = 0; i < 3; ++i) silent.emplace_back(port);
  std::list<LocalConnection> others;
  for (int i = 0; i < 5; ++i) {
    others.emplace_back(port);
    ASSERT_TRUE(others.back().send("GET /page HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n"));
  }
  EXPECT_FALSE(others.front().has_something(0.3)) << "there was no room yet";
  silent.clear();
  for (const LocalConnection& connection : others) {
    EXPECT_EQ(body_of(connection.receive()), "hello\n");
  }
  EXPECT_GE(full, 1) << "somebody is told";
}

/// The only event that can make it serve a waiting connection is the end of another.
TEST(HttpPage, TheOnlyPlaceIsGivenOn) {
  const auto opened = open_page({}, {.connections = 1, .idle_s = 600});
  ASSERT_TRUE(opened) << opened.error;
  std::list<LocalConnection> silent;
  silent.emplace_back((*opened)->port());
  const LocalConnection next((*opened)->port());
  ASSERT_TRUE(next.send("GET /page HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n"));
  EXPECT_FALSE(next.has_something(0.3));
  silent.clear();
  EXPECT_EQ(body_of(next.receive()), "hello\n");
}

/// Returns invalid requests, each wrong at another place.
std::vector<std::string> rubbish() {
  return {std::string("\0\1\2\r\n\r\n", 7), std::string(100'000, 'A'),
          "GET " + std::string(40'000, 'x'),
          std::string("GET /page HTTP/1.1\r\nContent-Length: -1\r\n\r\n")};
}

TEST(HttpPage, RubbishDoesNotEndIt) {
  const auto opened = open_page();
  ASSERT_TRUE(opened) << opened.error;
  const int port = (*opened)->port();
  for (const std::string& sent : rubbish()) LocalConnection(port).send(sent);
  EXPECT_EQ(body_of(http_request(port, "GET", "/page")), "hello\n");
}

TEST(HttpPage, RubbishWhileItStopsDoesNoHarm) {
  for (int i = 0; i < 300; ++i) {
    auto opened = open_page();
    ASSERT_TRUE(opened) << opened.error;
    std::list<LocalConnection> connections;
    for (int k = 0; k < 12; ++k) connections.emplace_back((*opened)->port());
    std::atomic<int> sent = 0;
    const std::jthread sender([&] {
      for (const LocalConnection& connection : connections) {
        connection.send("GET /page HTTP/1.1\r\nContent-Length: -1\r\n\r\n");
        ++sent;
      }
    });
    while (sent < 1 + i % 12) std::this_thread::yield();
    opened->reset();
  }
}

/// Without connections the page waits and does not poll.
TEST(HttpPage, CostsNothingWhenNobodyAsks) {
  const auto opened = open_page({}, {.idle_s = 600});
  ASSERT_TRUE(opened) << opened.error;
  const LocalConnection silent((*opened)->port());
  EXPECT_EQ(body_of(http_request((*opened)->port(), "GET", "/page")), "hello\n");
  const std::clock_t before = std::clock();
  EXPECT_FALSE(silent.has_something(0.5));
  EXPECT_LT(std::clock() - before, CLOCKS_PER_SEC / 4) << "of the processor in half a second";
}

}  // namespace
}  // namespace camway::process
