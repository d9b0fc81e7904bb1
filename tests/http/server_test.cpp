// SPDX-License-Identifier: MIT
#include "daemon/http/server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "tests/support/http_get.h"
#include "tests/support/random.h"

namespace camway::http {
namespace {

using testing::body_of;
using ::testing::HasSubstr;
using testing::http_request;
using testing::LocalConnection;
using ::testing::StartsWith;

std::unique_ptr<Server> serve(Handlers handlers, const Limits& limits = {}) {
  auto opened = Server::open({}, std::move(handlers), limits);
  if (!opened) throw std::runtime_error(opened.error);
  return std::move(*opened);
}

/// Answers with method, target and body of the request.
Handlers echo() {
  Handlers handlers;
  handlers.on_request = [](const Request& request, const Reply& reply) {
    reply({200,
           "text/x",
           request.method + " " + request.target + " " + request.body,
           {{"X-Host", std::string(request.header("host"))}}});
  };
  return handlers;
}

/// Keeps replies until a test gives them.
class Later {
 public:
  Handlers handlers() {
    Handlers handlers;
    handlers.on_request = [this](const Request&, Reply reply) {
      const std::lock_guard lock(mutex_);
      reply_ = std::move(reply);
      changed_.notify_all();
    };
    return handlers;
  }
  /// Returns the reply to the next request.
  Reply take() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return reply_ != nullptr; });
    return std::exchange(reply_, nullptr);
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  Reply reply_;
};

std::string post(const std::string& body, const std::string& connection = "close") {
  return "POST /a?b=c HTTP/1.1\r\nHost: here\r\nConnection: " + connection +
         "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
}

TEST(HttpServer, TellsTheHandlerAllOfARequest) {
  const auto server = serve(echo(), {.body_bytes = 100});
  const LocalConnection connection(server->port());
  ASSERT_TRUE(connection.send(post("text")));
  const std::string answer = connection.receive();
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 200 OK\r\n"));
  EXPECT_THAT(answer, HasSubstr("Content-Type: text/x\r\n"));
  EXPECT_THAT(answer, HasSubstr("X-Host: here\r\n"));
  EXPECT_EQ(body_of(answer), "POST /a?b=c text");
}

TEST(HttpServer, AConnectionMayAskAgain) {
  const auto server = serve(echo(), {.body_bytes = 100});
  const LocalConnection connection(server->port());
  ASSERT_TRUE(connection.send(post("first", "keep-alive") + post("second")));
  const std::string answers = connection.receive();
  EXPECT_THAT(answers, HasSubstr("POST /a?b=c first"));
  EXPECT_THAT(answers, HasSubstr("POST /a?b=c second"));
}

TEST(HttpServer, RefusesWhatIsTooLarge) {
  const auto server = serve(echo(), {.header_bytes = 1000, .body_bytes = 10});
  for (const auto& [sent, status] :
       {std::pair{post("01234567890"), "413"},
        {"GET /" + std::string(2000, 'x') + " HTTP/1.1\r\n\r\n", "431"},
        {std::string("GET /\x01 HTTP/1.1\r\n\r\n"), "400"}}) {
    const LocalConnection connection(server->port());
    ASSERT_TRUE(connection.send(sent));
    EXPECT_THAT(connection.receive(), StartsWith(std::string("HTTP/1.1 ") + status + " "));
  }
  EXPECT_EQ(body_of(http_request(server->port(), "GET", "/")), "GET / ");
}

TEST(HttpServer, AReplyMayComeLaterFromAnotherThread) {
  Later later;
  const auto server = serve(later.handlers(), {.connections = 1});
  const LocalConnection connection(server->port());
  ASSERT_TRUE(connection.send("GET / HTTP/1.1\r\nConnection: close\r\n\r\n"));
  const Reply reply = later.take();
  EXPECT_FALSE(connection.has_something(0.05));
  std::jthread([&] { reply({200, "text/x", "done"}); }).join();
  reply({200, "text/x", "again"});
  EXPECT_EQ(body_of(connection.receive()), "done");
}

TEST(HttpServer, ARequestThatNobodyAnswersEndsItsConnection) {
  Later later;
  const auto server = serve(later.handlers());
  const LocalConnection connection(server->port());
  ASSERT_TRUE(connection.send("GET / HTTP/1.1\r\n\r\n"));
  later.take();
  EXPECT_EQ(connection.receive(), "");
}

TEST(HttpServer, StopsWhileAReplyIsAwaited) {
  Later later;
  auto server = serve(later.handlers());
  const LocalConnection connection(server->port());
  ASSERT_TRUE(connection.send("GET / HTTP/1.1\r\n\r\n"));
  Reply reply = later.take();
  server.reset();
  EXPECT_EQ(connection.receive(), "");
  reply({200, "text/x", "too late"});
  reply = nullptr;
}

TEST(HttpServer, RandomBytesNeitherEndNorStallIt) {
  const auto server = serve(echo(), {.connections = 64, .body_bytes = 1000});
  testing::Random random(5);
  const std::string good = post("some text", "keep-alive");
  for (int i = 0; i < 1000; ++i) {
    std::string bytes = good + good;
    for (int k = random.integer(1, 8); k > 0; --k) {
      bytes[static_cast<std::size_t>(random.integer(0, static_cast<int>(bytes.size()) - 1))] =
          static_cast<char>(random.integer(0, 255));
    }
    bytes.resize(static_cast<std::size_t>(random.integer(1, static_cast<int>(bytes.size()))));
    const LocalConnection connection(server->port());
    connection.send(bytes);
    connection.end_sending();
    ASSERT_TRUE(connection.ends()) << i;
  }
  EXPECT_EQ(body_of(http_request(server->port(), "GET", "/")), "GET / ");
}

}  // namespace
}  // namespace camway::http
