// SPDX-License-Identifier: MIT
#include "daemon/service/http_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <list>
#include <thread>
#include <vector>

#include "tests/support/http_get.h"

namespace camway::service {
namespace {

using testing::body_of;
using ::testing::HasSubstr;
using testing::http_request;
using testing::LocalConnection;
using ::testing::StartsWith;

OpenedHttpPage open_page(const HttpAddress& address = {}) {
  return open_http_page(address, "/page", "text/plain; charset=x", [] { return "hello\n"; });
}

TEST(HttpPage, AnswersItsPathAndNothingElse) {
  const OpenedHttpPage opened = open_page();
  ASSERT_TRUE(opened.page) << opened.error;
  const int port = opened.page->port();
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
  const OpenedHttpPage first = open_page();
  ASSERT_TRUE(first.page) << first.error;
  const int port = first.page->port();
  const OpenedHttpPage second = open_page({"127.0.0.1", port});
  EXPECT_FALSE(second.page);
  EXPECT_EQ(second.error,
            "cannot listen on 127.0.0.1 port " + std::to_string(port) + ": Address already in use");
}

TEST(HttpPage, AnAddressThatIsNoneOrNotOurs) {
  EXPECT_EQ(open_page({"localhost", 0}).error, "'localhost' is no IPv4 or IPv6 address");
  EXPECT_THAT(open_page({"192.0.2.1", 0}).error, HasSubstr("cannot listen on 192.0.2.1"));
}

TEST(HttpPage, SlowOnesAndManyHoldUpNobody) {
  const OpenedHttpPage opened = open_page();
  ASSERT_TRUE(opened.page) << opened.error;
  const int port = opened.page->port();
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

TEST(HttpPage, IdleConnectionsAreFewAndNotKeptForLong) {
  const OpenedHttpPage opened = open_page();
  ASSERT_TRUE(opened.page) << opened.error;
  const int port = opened.page->port();
  const auto begin = std::chrono::steady_clock::now();
  std::list<LocalConnection> idle;
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(idle.emplace_back(port).good());
  EXPECT_EQ(body_of(http_request(port, "GET", "/page")), "hello\n");
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::seconds(4))
      << "it had to wait until one of the 16 was closed";
}

TEST(HttpPage, RubbishDoesNotEndIt) {
  const OpenedHttpPage opened = open_page();
  ASSERT_TRUE(opened.page) << opened.error;
  const int port = opened.page->port();
  for (const std::string& rubbish :
       {std::string("\0\1\2\r\n\r\n", 7), std::string(100'000, 'A'),
        "GET " + std::string(40'000, 'x'),
        std::string("GET /page HTTP/1.1\r\nContent-Length: -1\r\n\r\n")}) {
    const LocalConnection connection(port);
    connection.send(rubbish);
  }
  EXPECT_EQ(body_of(http_request(port, "GET", "/page")), "hello\n");
}

}  // namespace
}  // namespace camway::service
