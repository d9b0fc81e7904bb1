// SPDX-License-Identifier: MIT
#include "daemon/nats/connection.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "tests/integration/process.h"
#include "tests/support/nats_server.h"

namespace camway::nats {
namespace {

using integration::eventually;
using testing::NatsServer;
using testing::TestCertificates;
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr const char* kPlain = "";  // without JetStream

ConnectOptions options_for(const std::vector<std::string>& servers) {
  ConnectOptions options;
  options.servers = servers;
  options.name = "test";
  options.patience = milliseconds(3000);
  return options;
}

std::unique_ptr<Connection> connected(const ConnectOptions& options) {
  auto opened = Connection::open(options);
  EXPECT_TRUE(opened) << opened.error;
  return opened ? *std::move(opened) : nullptr;
}

std::string why_not(ConnectOptions options) {
  options.patience = milliseconds(300);
  const auto opened = Connection::open(options);
  EXPECT_FALSE(opened);
  return opened.error;
}

std::span<const std::uint8_t> payload_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// The messages of a subscription, as texts.
class Inbox {
 public:
  Bus::Handler handler() {
    return [this](const std::string& subject, std::span<const std::uint8_t> payload) {
      const std::lock_guard lock(mutex_);
      texts_.push_back(subject + " " + std::string(payload.begin(), payload.end()));
    };
  }
  std::vector<std::string> texts() {
    const std::lock_guard lock(mutex_);
    return texts_;
  }
  bool has(const std::string& text) {
    const std::vector<std::string> all = texts();
    return std::find(all.begin(), all.end(), text) != all.end();
  }

 private:
  std::mutex mutex_;
  std::vector<std::string> texts_;
};

TEST(NatsConnection, CarriesMessagesInOrder) {
  const NatsServer server(kPlain);
  const auto sender = connected(options_for({server.url()}));
  const auto receiver = connected(options_for({server.url()}));
  Inbox inbox;
  const auto subscription = receiver->subscribe("fleet.>", inbox.handler());
  ASSERT_NE(subscription, nullptr);
  // The sender's first message may pass the receiver's subscription on its way to the server.
  ASSERT_TRUE(eventually([&] {
    sender->publish("fleet.hello", {});
    return inbox.has("fleet.hello ");
  }));
  std::vector<std::string> expected;
  for (int i = 0; i < 500; ++i) {
    const std::string text = std::to_string(i) + std::string("\0\n", 2);
    EXPECT_TRUE(sender->publish("fleet.a.b", payload_of(text)));
    expected.push_back("fleet.a.b " + text);
  }
  ASSERT_TRUE(eventually([&] { return inbox.has(expected.back()); }));
  std::vector<std::string> got = inbox.texts();
  std::erase(got, "fleet.hello ");
  EXPECT_EQ(got, expected);
  EXPECT_EQ(sender->most_bytes(), 1024U * 1024U);
  EXPECT_EQ(sender->server(), server.url());
}

TEST(NatsConnection, NamesTheServerThatCannotBeReached) {
  const std::string port = std::to_string(testing::free_port());
  EXPECT_EQ(why_not(options_for({"nats://somebody:secret@127.0.0.1:" + port})),
            "nats://127.0.0.1:" + port + ": connection refused");
  const std::string other = std::to_string(testing::free_port());
  EXPECT_EQ(why_not(options_for({"nats://127.0.0.1:" + port, "nats://localhost:" + other})),
            "nats://127.0.0.1:" + port + ": connection refused; nats://localhost:" + other +
                ": connection refused");
}

TEST(NatsConnection, WaitsForAServerThatStarts) {
  NatsServer server(kPlain);
  server.kill();
  std::unique_ptr<Connection> connection;
  std::thread client([&] { connection = connected(options_for({server.url()})); });
  std::this_thread::sleep_for(milliseconds(400));
  server.start();
  client.join();
  EXPECT_NE(connection, nullptr);
}

TEST(NatsConnection, UsesTheServerThatIsThere) {
  const NatsServer server(kPlain);
  const auto connection = connected(
      options_for({"nats://127.0.0.1:" + std::to_string(testing::free_port()), server.url()}));
  ASSERT_NE(connection, nullptr);
  EXPECT_EQ(connection->server(), server.url());
}

TEST(NatsConnection, SaysThatItWasRefused) {
  const NatsServer server("authorization { user: camway, password: right }\n");
  const std::string port = std::to_string(server.port());
  const auto begin = Clock::now();
  ConnectOptions wrong = options_for({"nats://camway:wrong@127.0.0.1:" + port});
  wrong.patience = milliseconds(20'000);
  const auto refused = Connection::open(wrong);
  EXPECT_EQ(refused.error, "nats://127.0.0.1:" + port + ": authorization violation");
  EXPECT_LT(Clock::now() - begin, milliseconds(10'000)) << "it should not try again";
  const auto right = connected(options_for({"nats://camway:right@127.0.0.1:" + port}));
  ASSERT_NE(right, nullptr);
  EXPECT_EQ(right->server(), server.url());
}

TEST(NatsConnection, NamesAFileThatIsMissing) {
  const NatsServer server(kPlain);
  ConnectOptions options = options_for({server.url()});
  options.credentials_file = "/nowhere/camway.creds";
  EXPECT_EQ(why_not(options), "/nowhere/camway.creds cannot be read: No such file or directory");
}

std::string tls_configuration(const std::string& certificate, const std::string& key,
                              const std::string& more = "") {
  return "tls { cert_file: \"" + certificate + "\", key_file: \"" + key + "\"\n" + more + " }\n";
}

TEST(NatsConnection, VerifiesTheServerByTls) {
  const TestCertificates certificates;
  const NatsServer server(tls_configuration(certificates.server(), certificates.server_key()));
  ConnectOptions options = options_for({"tls://localhost:" + std::to_string(server.port())});
  options.ca_file = certificates.ca();
  const auto connection = connected(options);
  ASSERT_NE(connection, nullptr);
  EXPECT_TRUE(connection->publish("a", payload_of("text")));
  options.ca_file.clear();
  EXPECT_NE(why_not(options).find("certificate"), std::string::npos) << why_not(options);
}

TEST(NatsConnection, RefusesACertificateOfAnotherHost) {
  const TestCertificates certificates;
  const NatsServer server(tls_configuration(certificates.stranger(), certificates.stranger_key()));
  ConnectOptions options = options_for({"tls://localhost:" + std::to_string(server.port())});
  options.ca_file = certificates.ca();
  EXPECT_NE(why_not(options).find("hostname mismatch"), std::string::npos) << why_not(options);
}

TEST(NatsConnection, HasACertificateOfItsOwn) {
  const TestCertificates certificates;
  const NatsServer server(
      tls_configuration(certificates.server(), certificates.server_key(),
                        "ca_file: \"" + certificates.ca() + "\"\nverify: true"));
  ConnectOptions options = options_for({"tls://localhost:" + std::to_string(server.port())});
  options.ca_file = certificates.ca();
  EXPECT_NE(why_not(options), "");
  EXPECT_NE(why_not(options).find("it may demand a client certificate (fleet.certificate_file)"),
            std::string::npos)
      << why_not(options);
  options.certificate_file = certificates.client();
  options.key_file = certificates.client_key();
  EXPECT_NE(connected(options), nullptr);
}

/// What a connection tells of itself.
class Changes {
 public:
  explicit Changes(Connection& connection) : connection_(connection) {
    connection.on_change([this](bool is_connected) {
      const std::lock_guard lock(mutex_);
      text_ += is_connected ? '+' : '-';
    });
  }
  ~Changes() { connection_.on_change({}); }
  std::string text() {
    const std::lock_guard lock(mutex_);
    return text_;
  }

 private:
  Connection& connection_;
  std::mutex mutex_;
  std::string text_;
};

TEST(NatsConnection, IsMadeAgainAndStaysSubscribed) {
  NatsServer server(kPlain);
  const auto connection = connected(options_for({server.url()}));
  Changes changes(*connection);
  Inbox inbox;
  const auto subscription = connection->subscribe("a.>", inbox.handler());
  const std::uint64_t generation = connection->generation();
  server.kill();
  ASSERT_TRUE(eventually([&] { return changes.text() == "-"; }));
  EXPECT_FALSE(connection->is_connected());
  EXPECT_EQ(connection->server(), "");
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(connection->publish("a.lost", payload_of("text")));
  server.start();
  ASSERT_TRUE(eventually([&] { return changes.text() == "-+"; }));
  EXPECT_NE(connection->generation(), generation);
  ASSERT_TRUE(eventually([&] {
    connection->publish("a.found", payload_of("text"));
    return inbox.has("a.found text");
  }));
  EXPECT_FALSE(inbox.has("a.lost text")) << "a message that was said to be lost was sent";
}

TEST(NatsConnection, NoticesAServerThatHangs) {
  const NatsServer server(kPlain);
  const auto connection = connected(options_for({server.url()}));
  Changes changes(*connection);
  server.pause();
  const auto begin = Clock::now();
  Clock::duration longest{};
  while (connection->is_connected() && Clock::now() - begin < milliseconds(20'000)) {
    const auto before = Clock::now();
    connection->publish("a", payload_of("text"));
    longest = std::max(longest, Clock::now() - before);
    std::this_thread::sleep_for(milliseconds(5));
  }
  EXPECT_LT(Clock::now() - begin, milliseconds(5'000));
  // The library now tries to connect again, which takes seconds.
  for (int i = 0; i < 100; ++i) {
    const auto before = Clock::now();
    EXPECT_FALSE(connection->publish("a", payload_of("text")));
    longest = std::max(longest, Clock::now() - before);
    std::this_thread::sleep_for(milliseconds(5));
  }
  EXPECT_LT(longest, milliseconds(500));
  server.resume();
  EXPECT_TRUE(eventually([&] { return connection->is_connected(); }));
}

TEST(NatsConnection, OutlivesARefusal) {
  NatsServer server(kPlain);
  const auto connection = connected(options_for({server.url()}));
  Inbox inbox;
  const auto subscription = connection->subscribe("a", inbox.handler());
  server.kill();
  server.configure("authorization { user: camway, password: secret }\n");
  server.start();
  // The library tries each server again once after a refusal, then it gives the connection up.
  std::this_thread::sleep_for(milliseconds(1000));
  EXPECT_FALSE(connection->is_connected());
  server.kill();
  server.configure(kPlain);
  server.start();
  ASSERT_TRUE(eventually([&] {
    connection->publish("a", payload_of("text"));
    return inbox.has("a text");
  }));
}

TEST(NatsConnection, ASubscriptionEndsAfterItsHandler) {
  const NatsServer server(kPlain);
  const auto connection = connected(options_for({server.url()}));
  std::atomic<bool> runs = false;
  std::atomic<bool> has_ended = false;
  auto subscription =
      connection->subscribe("a", [&](const std::string&, std::span<const std::uint8_t>) {
        runs = true;
        std::this_thread::sleep_for(milliseconds(200));
        has_ended = true;
      });
  connection->publish("a", {});
  ASSERT_TRUE(eventually([&] { return runs.load(); }));
  subscription.reset();
  EXPECT_TRUE(has_ended);
}

TEST(NatsConnection, AHandlerMayEndItsSubscription) {
  const NatsServer server(kPlain);
  const auto connection = connected(options_for({server.url()}));
  std::unique_ptr<Subscription> subscription;
  std::atomic<int> calls = 0;
  std::mutex mutex;
  {
    const std::lock_guard lock(mutex);
    subscription =
        connection->subscribe("a", [&](const std::string&, std::span<const std::uint8_t>) {
          const std::lock_guard inside(mutex);
          subscription.reset();
          ++calls;
        });
  }
  for (int i = 0; i < 10; ++i) connection->publish("a", {});
  ASSERT_TRUE(eventually([&] { return calls > 0; }));
  std::this_thread::sleep_for(milliseconds(50));
  EXPECT_EQ(calls, 1);
}

TEST(NatsConnection, SubscriptionsComeAndGoWhileMessagesCome) {
  const NatsServer server(kPlain);
  const auto connection = connected(options_for({server.url()}));
  std::atomic<bool> ends = false;
  std::thread sender([&] {
    while (!ends) connection->publish("a.b", payload_of("text"));
  });
  for (int i = 0; i < 100; ++i) {
    auto seen = std::make_unique<std::atomic<int>>(0);
    auto subscription = connection->subscribe(
        "a.*", [&](const std::string&, std::span<const std::uint8_t>) { ++*seen; });
    if (i % 2 == 0) {
      ASSERT_TRUE(eventually([&] { return *seen > 0; }));
    }
    subscription.reset();
    seen.reset();  // a handler that still ran would write into freed memory
  }
  ends = true;
  sender.join();
}

}  // namespace
}  // namespace camway::nats
