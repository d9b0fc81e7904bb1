// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "daemon/scene/snapshot/snapshot.h"
#include "tests/support/http_get.h"
#include "tests/support/random.h"
#include "tests/tools/view/door_client.h"
#include "tests/tools/view/fake_backend.h"
#include "tools/view/door.h"
#include "tools/view/here/planner_here.h"

namespace camway::view {
namespace {

using testing::LocalConnection;
using testing::Random;

constexpr int kMutants = 10'000;

/// CAMWAY_MUTANTS asks for another number of them.
int mutants() {
  const char* const asked = std::getenv("CAMWAY_MUTANTS");
  return asked == nullptr ? kMutants : std::atoi(asked);
}

/// A room with a box, in which plans take no time.
std::unique_ptr<Backend> small_backend() {
  scene::Mesh mesh;
  mesh.vertices = {{0, 0, 5}, {1, 0, 5}, {0, 1, 5}};
  mesh.triangles = {{0, 1, 2}};
  return plan_here(scene::make_snapshot("office", mesh).snapshot);
}

std::string mutant(std::string text, Random& random) {
  for (int k = random.integer(1, 6); k > 0 && !text.empty(); --k) {
    const auto at = static_cast<std::size_t>(random.integer(0, static_cast<int>(text.size()) - 1));
    switch (random.integer(0, 3)) {
      case 0:
        text[at] = static_cast<char>(random.integer(0, 127));
        break;
      case 1:
        text.erase(at, static_cast<std::size_t>(random.integer(1, 20)));
        break;
      case 2:
        text.insert(at, text.substr(text.size() - std::min<std::size_t>(text.size(), 12)));
        break;
      default:
        text.insert(at, 1, "{}[]\",:0-9e"[random.integer(0, 10)]);
    }
  }
  return text;
}

std::vector<std::string> messages() {
  const std::string request = kSmallRequest;
  return {
      plan_message(1, R"(, "progress": true)"),
      plan_message(2, R"(, "drag": "a")"),
      plan_message(3, R"(, "drag": "a")"),
      R"({"id": 4, "do": "check", "path": {"segments": []}, "request": )" + request + "}",
      R"({"id": 2, "do": "cancel"})",
      R"({"id": 5, "do": "watch"})",
      R"({"id": 5, "do": "unwatch"})",
      R"({"id": 6, "do": "scene.add", "object": "x", "form": {"type": "box", "size": [1, 1, 1]}, "position": [9, 9, 9]})",
      R"({"id": 7, "do": "scene.move", "object": "x", "position": [9, 9, 8]})",
      R"({"id": 8, "do": "scene.remove", "object": "x"})",
      R"({"id": 9, "do": "scene.describe", "scene": "office"})",
      R"({"id": 10, "do": "status"})",
      R"({"id": 11, "do": "interpolate", "request": )" + request + "}",
      R"({"id": 12, "do": "triangles", "scene": "office", "indices": [0, 1, -3]})",
      R"({"id": 13, "do": "fields"})",
      R"({"id": 14, "do": "last"})"};
}

class ViewHostile : public ::testing::Test {
 protected:
  void SetUp() override {
    backend_ = small_backend();
    auto opened = Door::open(
        {.token = kSecret, .limits = {.changes_per_s = 1e6, .change_burst = 1e6}}, *backend_);
    ASSERT_TRUE(opened) << opened.error;
    door_ = *std::move(opened);
  }
  /// Returns whether the door still answers.
  bool answers() {
    HttpClient client(door_->port(), kSecret);
    return client.get("/v1/version").code == 200 &&
           client.post("/v1/plan", kSmallRequest).code == 200;
  }

  std::unique_ptr<Backend> backend_;
  std::unique_ptr<Door> door_;
};

TEST_F(ViewHostile, MessagesNeitherEndNorStallIt) {
  Random random(11);
  const std::vector<std::string> all = messages();
  auto socket = std::make_unique<SocketClient>(door_->port(), kSecret);
  constexpr int kBatch = 50;
  for (int i = 0; i < mutants(); ++i) {
    const std::string& message =
        all[static_cast<std::size_t>(random.integer(0, static_cast<int>(all.size()) - 1))];
    socket->send(random.integer(0, 9) == 0 ? message : mutant(message, random));
    if (i % kBatch != kBatch - 1) continue;
    // Its answer shows that all before were read; what is under way ends with the socket.
    socket->send(R"({"id": 99, "do": "version"})");
    ASSERT_EQ(socket->next([](const auto& m) { return m.value("id", nlohmann::json()) == 99; })
                  .count("answer"),
              1U)
        << i;
    socket = std::make_unique<SocketClient>(door_->port(), kSecret);
  }
  EXPECT_TRUE(answers());
}

TEST_F(ViewHostile, FramesNeitherEndNorStallIt) {
  Random random(12);
  for (int i = 0; i < mutants() / 10; ++i) {
    SocketClient socket(door_->port(), kSecret);
    std::string bytes;
    for (int k = random.integer(1, 60); k > 0; --k) {
      bytes.push_back(static_cast<char>(random.integer(0, 255)));
    }
    if (random.integer(0, 1) == 0) bytes[0] = '\x81';
    beast::error_code ignored;
    boost::asio::write(socket.lowest(), boost::asio::buffer(bytes), ignored);
  }
  EXPECT_TRUE(answers());
}

TEST_F(ViewHostile, RequestsNeitherEndNorStallIt) {
  Random random(13);
  const std::string head = " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(door_->port()) +
                           "\r\nAuthorization: Bearer secret\r\nConnection: close\r\n";
  const std::string body = kSmallRequest;
  const std::vector<std::string> all{
      "GET /v1/scenes" + head + "\r\n", "GET /?token=secret" + head + "\r\n",
      "POST /v1/plan" + head + "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body,
      "DELETE /v1/scenes/office/objects/crate" + head + "\r\n",
      "GET /v1/socket?token=secret" + head +
          "Upgrade: websocket\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
          "Sec-WebSocket-Version: 13\r\n\r\n"};
  for (int i = 0; i < mutants() / 5; ++i) {
    const LocalConnection connection(door_->port());
    connection.send(
        mutant(all[static_cast<std::size_t>(random.integer(0, static_cast<int>(all.size()) - 1))],
               random));
    connection.end_sending();
    ASSERT_TRUE(connection.ends()) << i;
  }
  EXPECT_TRUE(answers());
}

}  // namespace
}  // namespace camway::view
