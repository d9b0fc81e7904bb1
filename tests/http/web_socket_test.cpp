// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

#include "daemon/http/server.h"
#include "tests/support/http_get.h"
#include "tests/support/random.h"

namespace camway::http {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;
using testing::LocalConnection;
using ::testing::StartsWith;
using tcp = boost::asio::ip::tcp;

/// A client that waits for everything.
class Client {
 public:
  explicit Client(int port) : stream_(context_) {
    // A ping that is sent and answered is seen here; the stream answers it by itself.
    stream_.control_callback([this](websocket::frame_type type, beast::string_view) {
      if (type == websocket::frame_type::ping) ++pings_;
    });
    stream_.next_layer().connect(
        {boost::asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(port)});
    stream_.handshake("127.0.0.1", "/socket");
  }
  void send(const std::string& text, bool is_text = true) {
    stream_.text(is_text);
    stream_.write(boost::asio::buffer(text));
  }
  void send_raw(const std::string& bytes) {
    beast::error_code ignored;
    boost::asio::write(stream_.next_layer(), boost::asio::buffer(bytes), ignored);
  }
  /// Returns how many pings came so far.
  [[nodiscard]] int pings() const { return pings_; }
  /// Returns the next message; what ended the connection if there is none.
  std::string receive() {
    beast::flat_buffer buffer;
    beast::error_code error;
    stream_.read(buffer, error);
    if (error == websocket::error::closed) {
      return "closed " + std::to_string(stream_.reason().code);
    }
    return error ? "ended" : beast::buffers_to_string(buffer.data());
  }

 private:
  boost::asio::io_context context_;
  websocket::stream<tcp::socket> stream_;
  int pings_ = 0;
};

/// Sends back what it receives, and keeps the sockets.
class Echo {
 public:
  Handlers handlers() {
    Handlers handlers;
    handlers.on_request = [](const Request&, const Reply& reply) {
      reply({403, "text/plain", "no socket\n"});
    };
    handlers.on_socket = [this](const Request& request,
                                std::shared_ptr<Socket> socket) -> std::unique_ptr<SocketEvents> {
      if (request.target != "/socket") return nullptr;
      const std::lock_guard lock(mutex_);
      ++open_;
      last_ = socket;
      return std::make_unique<Events>(*this, std::move(socket));
    };
    return handlers;
  }
  std::shared_ptr<Socket> last() {
    const std::lock_guard lock(mutex_);
    return last_;
  }
  void wait_until_closed() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return open_ == 0; });
  }
  int open() {
    const std::lock_guard lock(mutex_);
    return open_;
  }

 private:
  struct Events final : SocketEvents {
    Events(Echo& given_echo, std::shared_ptr<Socket> given_socket)
        : echo(given_echo), socket(std::move(given_socket)) {}
    ~Events() override {
      const std::lock_guard lock(echo.mutex_);
      --echo.open_;
      echo.changed_.notify_all();
    }
    Events(const Events&) = delete;
    Events& operator=(const Events&) = delete;
    void received(std::string text) override { socket->send("echo " + text); }

    Echo& echo;
    std::shared_ptr<Socket> socket;
  };

  std::mutex mutex_;
  std::condition_variable changed_;
  int open_ = 0;
  std::shared_ptr<Socket> last_;
};

constexpr Limits kLimits{.connections = 64, .message_bytes = 1000, .queued_bytes = 100'000};

std::unique_ptr<Server> serve(Echo& echo, const Limits& limits = kLimits) {
  auto opened = Server::open({}, echo.handlers(), limits);
  if (!opened) throw std::runtime_error(opened.error);
  return std::move(*opened);
}

TEST(HttpWebSocket, CarriesMessagesBothWays) {
  Echo echo;
  const auto server = serve(echo);
  Client client(server->port());
  for (const std::string text : {"one", "", "three"}) {
    client.send(text);
    EXPECT_EQ(client.receive(), "echo " + text);
  }
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(echo.last()->send(std::to_string(i)));
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(client.receive(), std::to_string(i));
}

TEST(HttpWebSocket, OnlyWhomTheHandlerTakesIsConnected) {
  Echo echo;
  const auto server = serve(echo);
  const LocalConnection connection(server->port());
  ASSERT_TRUE(connection.send(
      "GET /other HTTP/1.1\r\nHost: x\r\nUpgrade: websocket\r\nConnection: upgrade\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n"));
  EXPECT_THAT(connection.receive(), StartsWith("HTTP/1.1 403 "));
  EXPECT_EQ(echo.open(), 0);
}

TEST(HttpWebSocket, EndsForMessagesThatAreTooLongOrBinary) {
  Echo echo;
  const auto server = serve(echo);
  Client too_long(server->port());
  too_long.send(std::string(1001, 'x'));
  EXPECT_EQ(too_long.receive(), "closed 1009");
  Client binary(server->port());
  binary.send("x", /*is_text=*/false);
  EXPECT_EQ(binary.receive(), "closed 1003");
  echo.wait_until_closed();
  EXPECT_FALSE(echo.last()->send("text"));
}

TEST(HttpWebSocket, ASlowReceiverIsNotWaitedForWithoutLimit) {
  Echo echo;
  const auto server = serve(echo);
  Client client(server->port());
  const std::string text(10'000, 'x');
  // The kernel takes some megabytes.
  int sent = 0;
  while (sent < 10'000 && echo.last()->send(text)) ++sent;
  EXPECT_LT(sent, 10'000);
  for (int i = 0; i < sent; ++i) ASSERT_EQ(client.receive(), text);
  EXPECT_TRUE(echo.last()->send("more"));
  EXPECT_EQ(client.receive(), "more");
}

TEST(HttpWebSocket, ClosesOnceEverythingIsSent) {
  Echo echo;
  const auto server = serve(echo);
  Client client(server->port());
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(echo.last()->send(std::to_string(i)));
  echo.last()->close();
  for (int i = 0; i < 5; ++i) EXPECT_EQ(client.receive(), std::to_string(i));
  EXPECT_EQ(client.receive(), "closed 1000");
}

TEST(HttpWebSocket, EndsWithTheServer) {
  Echo echo;
  auto server = serve(echo);
  Client client(server->port());
  client.send("a");
  EXPECT_EQ(client.receive(), "echo a");
  server.reset();
  EXPECT_EQ(echo.open(), 0);
  EXPECT_FALSE(echo.last()->send("text"));
  echo.last()->close();
  EXPECT_EQ(client.receive(), "ended");
}

TEST(HttpWebSocket, IsClosedOnceThoughTwoAskForIt) {
  Echo echo;
  const auto server = serve(echo);
  Client client(server->port());
  client.send("a");
  EXPECT_EQ(client.receive(), "echo a");
  // The server closes because of this, and waits for the client's own close meanwhile.
  client.send("x", /*is_text=*/false);
  while (echo.last()->send("more")) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  echo.last()->close();
  echo.last()->close();
  Client other(server->port());
  other.send("b");
  EXPECT_EQ(other.receive(), "echo b") << "the server has run what was asked of the first";
  std::string end = client.receive();
  while (end == "more") end = client.receive();
  EXPECT_EQ(end, "closed 1003");
}

TEST(HttpWebSocket, IsKeptWhileTheOtherSideAnswersPings) {
  constexpr std::chrono::milliseconds kSilence{1500};
  Limits limits = kLimits;
  limits.silence = kSilence;
  Echo echo;
  const auto server = serve(echo, limits);
  Client dead(server->port());
  const std::shared_ptr<Socket> dead_socket = echo.last();
  Client alive(server->port());
  const std::shared_ptr<Socket> alive_socket = echo.last();
  // It says nothing itself, and waits longer than the silence that is borne.
  std::thread waits([&] { EXPECT_EQ(alive.receive(), "late"); });
  while (dead_socket->send("")) std::this_thread::sleep_for(kSilence / 20);
  std::this_thread::sleep_for(kSilence);
  EXPECT_TRUE(alive_socket->send("late"));
  waits.join();
  EXPECT_GE(alive.pings(), 2);
  alive.send("a");
  EXPECT_EQ(alive.receive(), "echo a");
}

TEST(HttpWebSocket, RandomFramesNeitherEndNorStallIt) {
  Echo echo;
  const auto server = serve(echo);
  testing::Random random(6);
  for (int i = 0; i < 300; ++i) {
    Client hostile(server->port());
    std::string bytes;
    for (int k = random.integer(1, 60); k > 0; --k) {
      bytes.push_back(static_cast<char>(random.integer(0, 255)));
    }
    if (random.integer(0, 1) == 0) bytes[0] = '\x81';
    hostile.send_raw(bytes);
  }
  Client good(server->port());
  good.send("text");
  EXPECT_EQ(good.receive(), "echo text");
}

}  // namespace
}  // namespace camway::http
