// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <memory>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/integration/fixture.h"
#include "tests/tools/view/door_client.h"
#include "tools/view/daemon/planner_daemon.h"
#include "tools/view/door.h"
#include "tools/view/here/planner_here.h"

namespace camway::integration {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using view::HttpClient;
using view::kSecret;
using view::Reached;
using view::SocketClient;

/// The lines of a picture, in any order. Their names count what was drawn before, and do not
/// matter.
std::multiset<std::string> strokes_of(const std::string& svg) {
  constexpr std::string_view kBegin = " d=\"";
  std::multiset<std::string> lines;
  for (std::size_t at = svg.find(kBegin); at != std::string::npos; at = svg.find(kBegin, at)) {
    at += kBegin.size();
    lines.insert(svg.substr(at, svg.find('"', at) - at));
  }
  return lines;
}

/// A door whose backend is a real daemon.
class ViewDaemonTest : public IntegrationTest {
 protected:
  void open_door() {
    auto backend = view::plan_by_daemon("office", {});
    ASSERT_TRUE(backend) << backend.error;
    backend_ = *std::move(backend);
    auto door = view::Door::open({.token = kSecret}, *backend_);
    ASSERT_TRUE(door) << door.error;
    door_ = *std::move(door);
  }
  void TearDown() override {
    door_.reset();
    backend_.reset();
    IntegrationTest::TearDown();
  }
  HttpClient http() { return {door_->port(), kSecret}; }
  void expect_no_waiting(const std::string& digest);
  static std::string request_text(const std::string& name) { return read_file(request_file(name)); }

  std::unique_ptr<view::Backend> backend_;
  std::unique_ptr<view::Door> door_;
};

TEST_F(ViewDaemonTest, EveryPlaceIsAnsweredByTheDaemon) {
  start_daemon();
  open_door();
  HttpClient client = http();
  const Reached status = client.get("/v1/status");
  EXPECT_EQ(status.code, 200) << status.body;
  EXPECT_EQ(status.json().at("backend").at("planner"), "daemon");
  const Reached scenes = client.get("/v1/scenes");
  EXPECT_GE(scenes.json().at("scenes").size(), 1U) << scenes.body;
  const Reached office = client.get("/v1/scenes/office");
  EXPECT_EQ(office.json().at("objects").size(), 1U) << office.body;
  EXPECT_EQ(client.get("/v1/scenes/nowhere").code, 404);
  const std::string objects = "/v1/scenes/office/objects";
  const Reached added = client.post(
      objects,
      R"({"name": "crate", "position": [5, 6, 7], "form": {"type": "box", "size": [1, 1, 1]}})");
  EXPECT_EQ(added.code, 200) << added.body;
  const Reached moved =
      client.send("PATCH", objects + "/crate", R"({"orientation": [0, 0, 0, 1]})");
  EXPECT_EQ(moved.json().at("objects").at(0).at("position"), json({5.0, 6.0, 7.0})) << moved.body;
  EXPECT_EQ(client.send("DELETE", objects + "/crate").code, 200);
  const Reached missing = client.send("DELETE", objects + "/crate");
  EXPECT_EQ(missing.code, 404);
  EXPECT_THAT(missing.json().at("error").get<std::string>(), StartsWith("object: "));
  const Reached refused = client.post(
      objects, R"({"name": "crate", "form": {"type": "mesh", "file": "/nowhere/crate.obj"}})");
  EXPECT_EQ(refused.code, 400) << refused.body;
  EXPECT_NE(refused.json().value("field", "invalid"), "invalid") << refused.body;
  const std::string plan = client.post("/v1/plan", request_text("office-graze-door")).body;
  EXPECT_EQ(json::parse(plan).at("status"), "ok") << plan;
  EXPECT_THAT(client.get("/plan.svg").body, HasSubstr("<svg"));
  const Reached checked =
      client.post("/v1/check", "{\"request\": " + request_text("office-graze-door") +
                                   ", \"path\": " + plan + "}");
  EXPECT_EQ(checked.code, 200) << checked.body;
  EXPECT_EQ(checked.json().at("certified"), true) << checked.body;
}

/// A door that plans here, for comparison.
class DoorHere {
 public:
  explicit DoorHere(const std::string& scene) {
    const scene::SnapshotResult loaded = scene::load_snapshot(scene, scene_file(scene));
    if (!loaded.snapshot) throw std::runtime_error(loaded.error);
    backend_ = view::plan_here(loaded.snapshot, {.scene_reading = scene::ImportOptions{}});
    auto door = view::Door::open({.token = kSecret}, *backend_);
    if (!door) throw std::runtime_error(door.error);
    door_ = *std::move(door);
  }
  HttpClient http() { return {door_->port(), kSecret}; }

 private:
  std::unique_ptr<view::Backend> backend_;
  std::unique_ptr<view::Door> door_;
};

constexpr char kTurnedBall[] =
    R"({"name": "ball", "position": [5, 6, 7], "orientation": [0.8, 0, 0, 0.6],
        "form": {"type": "sphere", "radius_m": 0.4}})";

TEST_F(ViewDaemonTest, MovedObjectsHaveTheMeshThatTheyHad) {
  start_daemon();
  open_door();
  HttpClient client = http();
  const std::string objects = "/v1/scenes/office/objects";
  ASSERT_EQ(client.post(objects, kTurnedBall).code, 200);
  const auto ball = [&client] {
    const json office = client.get("/v1/scenes/office").json();
    for (const json& object : office.at("objects")) {
      if (object.at("name") == "ball") return object;
    }
    return json();
  };
  const auto mesh = [&client](const json& object) {
    return client.get("/v1/scenes/office/meshes/" + object.at("digest").get<std::string>()).body;
  };
  const json added = ball();
  EXPECT_EQ(ball().at("mesh_digest"), added.at("mesh_digest"));
  const std::string file = mesh(added);
  json before = added;
  for (const std::string pose : {R"({"position": [1, 2, 3]})", R"({"orientation": [0, 0, 1, 0]})",
                                 R"({"position": [5, 6, 7], "orientation": [0.8, 0, 0, 0.6]})"}) {
    ASSERT_EQ(client.send("PATCH", objects + "/ball", pose).code, 200);
    const json moved = ball();
    EXPECT_NE(moved.at("digest"), before.at("digest"));
    EXPECT_EQ(moved.at("mesh_digest"), added.at("mesh_digest"));
    EXPECT_TRUE(mesh(moved) == file);
    EXPECT_TRUE(mesh(before) == file) << "who has an older list may still ask";
    before = moved;
  }
  std::string twin = kTurnedBall;
  twin.replace(twin.find("ball"), 4, "twin");
  ASSERT_EQ(client.post(objects, twin).code, 200);
  const json office = client.get("/v1/scenes/office").json();
  for (const json& object : office.at("objects")) EXPECT_TRUE(object.contains("mesh_digest"));
  std::string other = kTurnedBall;
  other.replace(other.find("0.4"), 3, "0.3");
  ASSERT_EQ(client.post(objects, other).code, 200);
  EXPECT_NE(ball().at("mesh_digest"), added.at("mesh_digest"));
  EXPECT_FALSE(mesh(ball()) == file);
}

constexpr char kTurnedCrate[] =
    R"({"name": "crate", "position": [5, 6, 7], "orientation": [0.8, 0, 0, 0.6],
        "form": {"type": "sphere", "radius_m": 0.5}})";

TEST_F(ViewDaemonTest, TrianglesAreThoseOfTheSceneHere) {
  start_daemon();
  open_door();
  DoorHere here("office");
  HttpClient daemon_door = http();
  HttpClient door_here = here.http();
  for (HttpClient* client : {&daemon_door, &door_here})
    ASSERT_EQ(client->post("/v1/scenes/office/objects", kTurnedCrate).code, 200);
  const json office = daemon_door.get("/v1/scenes/office").json();
  ASSERT_EQ(office.at("objects").size(), 2U);
  for (const json& object : office.at("objects")) {
    const std::string place = "/v1/scenes/office/meshes/" + object.at("digest").get<std::string>();
    const Reached sent = daemon_door.get(place);
    const Reached known = door_here.get(place);
    ASSERT_EQ(sent.code, 200) << sent.body;
    ASSERT_EQ(known.code, 200) << known.body;
    EXPECT_TRUE(sent.body == known.body) << object.dump();
  }
  EXPECT_EQ(daemon_door.get("/v1/scenes/office/meshes/" + std::string(32, '0')).code, 404);
  const std::string indices = R"({"indices": [0, 1, 17, 1000, 123456789]})";
  const std::string triangles = "/v1/scenes/office/triangles";
  EXPECT_EQ(daemon_door.post(triangles, indices).json().at("triangles"),
            door_here.post(triangles, indices).json().at("triangles"));
}

TEST_F(ViewDaemonTest, PathsAreProvedAsHere) {
  start_daemon();
  open_door();
  DoorHere here("office");
  HttpClient daemon_door = http();
  HttpClient door_here = here.http();
  const std::string request = request_text("office-graze-door");
  const std::string plan = daemon_door.post("/v1/plan", request).body;
  const std::string check = "{\"request\": " + request + ", \"path\": " + plan + "}";
  const auto proof = [&](HttpClient& client) {
    json proof = client.post("/v1/check", check).json();
    proof.erase("scene");
    proof.erase("timing_ms");
    return proof;
  };
  json there = proof(daemon_door);
  json at_home = proof(door_here);
  // Bounds are as sharp as the distances that each of them has at hand.
  for (json* one : {&there, &at_home}) {
    EXPECT_EQ(one->at("certified"), true) << *one;
    EXPECT_GT(one->at("clearance_lower_bound"), 0.003);
    one->erase("clearance_lower_bound");
  }
  EXPECT_EQ(there, at_home);
  ASSERT_EQ(door_here.post("/v1/plan", request).code, 200);
  const auto drawn = strokes_of(daemon_door.get("/plan.svg").body);
  EXPECT_GT(drawn.size(), 100U) << "the walls of the office";
  EXPECT_EQ(drawn, strokes_of(door_here.get("/plan.svg").body));
  // The next proof sees a ball in the way.
  const json begin = json::parse(request).at("keyframes").at(0).at("position");
  const Reached added = daemon_door.post(
      "/v1/scenes/office/objects", R"({"name": "crate", "form": {"type": "sphere", "radius_m": 0.3},
                                       "position": )" +
                                       begin.dump() + "}");
  ASSERT_EQ(added.code, 200) << added.body;
  const json blocked = proof(daemon_door);
  EXPECT_EQ(blocked.at("certified"), false) << blocked;
  EXPECT_GE(blocked.at("collisions").size(), 1U) << blocked;
}

TEST_F(ViewDaemonTest, PathsInAnOccupancyMapAreNotProvedAgainstItsFacesAlone) {
  start_daemon();
  open_door();
  Client client(patient());
  SceneVoxels map;
  map.resolution_m = 0.5;
  ASSERT_TRUE(client.put_object("office", "map", map).ok());
  const std::string request = request_text("office-graze-door");
  const std::string plan = http().post("/v1/plan", request).body;
  const Reached checked =
      http().post("/v1/check", "{\"request\": " + request + ", \"path\": " + plan + "}");
  EXPECT_EQ(checked.code, 501) << checked.body;
  EXPECT_THAT(checked.json().at("error").get<std::string>(), HasSubstr("occupancy map"));
}

TEST_F(ViewDaemonTest, AnswersAreThoseOfCamwayPlanByTheDaemon) {
  start_daemon();
  open_door();
  const auto without_times = [](const std::string& answer) {
    return std::regex_replace(answer, std::regex(",\n  \"timing_ms\": [^\n]*"), "");
  };
  for (const std::string name : {"office-graze-slalom", "office-impossible-safe"}) {
    const std::string written = file(name + ".json");
    Process process({CAMWAY_BINARY, "plan", "--daemon", "office", "--request", request_file(name),
                     "--response", written},
                    file("plan.log"));
    ASSERT_TRUE(process.wait());
    const Reached got = http().post("/v1/plan", request_text(name));
    EXPECT_EQ(got.code, 200);
    EXPECT_EQ(without_times(got.body), without_times(read_file(written))) << name;
  }
}

TEST_F(ViewDaemonTest, TellsWhatOtherProcessesChange) {
  start_daemon();
  open_door();
  SocketClient one(door_->port(), kSecret);
  SocketClient other(door_->port(), kSecret);
  one.send(R"({"id": 1, "do": "watch"})");
  const auto scenes_of = [](const json& message, std::int64_t revision) {
    if (!message.contains("event") || message["event"]["kind"] != "scenes") return false;
    for (const json& scene : message["event"]["state"]["scenes"]) {
      if (scene["name"] == "office" && scene["revision"] == revision) return true;
    }
    return false;
  };
  const auto next_revision = [&](std::int64_t revision) {
    return one.next([&](const json& message) { return scenes_of(message, revision); });
  };
  EXPECT_FALSE(next_revision(1).contains("closed"));
  other.send(R"({"id": 1, "do": "scene.add", "object": "crate", "position": [5, 6, 7],
                 "form": {"type": "box", "size": [1, 1, 1]}})");
  EXPECT_EQ(other.next(1).count("answer"), 1U);
  EXPECT_FALSE(next_revision(2).contains("closed"));
  Process moving({CAMWAY_BINARY, "scene", "move", "office", "crate", "--position", "5,6,8"},
                 file("move.log"));
  EXPECT_EQ(moving.wait(), 0) << moving.output();
  EXPECT_FALSE(next_revision(3).contains("closed"));
}

TEST_F(ViewDaemonTest, AWatchedPathBreaksAndHeals) {
  start_daemon();
  open_door();
  const std::string request = request_text("office-free-straight");
  const json keyframes = json::parse(request).at("keyframes");
  json middle = json::array();
  for (std::size_t i = 0; i < 3; ++i) {
    middle.push_back(0.5 * (keyframes.at(0).at("position").at(i).get<double>() +
                            keyframes.at(1).at("position").at(i).get<double>()));
  }
  SocketClient socket(door_->port(), kSecret);
  socket.send(R"({"id": 1, "do": "watch", "request": )" + request + "}");
  const auto next_kind = [&](const std::string& kind) {
    return socket.next([&](const json& message) {
      return message.value("id", -1) == 1 && message.contains("event") &&
             message["event"]["kind"] == kind;
    });
  };
  EXPECT_EQ(next_kind("answer").at("event").at("answer").at("status"), "ok");
  socket.send(R"({"id": 2, "do": "scene.add", "object": "crate", "form": {"type": "box",
                  "size": [0.3, 0.3, 0.3]}, "position": )" +
              middle.dump() + "}");
  EXPECT_GE(next_kind("broken").at("event").at("broken").size(), 1U);
  EXPECT_EQ(next_kind("answer").at("event").at("scene_revision"), 2);
  socket.send(R"({"id": 1, "do": "unwatch"})");
  const json ended = socket.next([](const json& message) { return message.contains("ended"); });
  EXPECT_EQ(ended.at("id"), 1);
}

TEST_F(ViewDaemonTest, PlansAreCancelledAtTheDaemon) {
  start_daemon();
  open_door();
  json request = json::parse(request_text("office-wall-tour"));
  const json keyframes = request.at("keyframes");
  json many = json::array();
  for (int round = 0; round < 200; ++round) {
    for (const json& keyframe : keyframes) {
      many.push_back(
          {{"position", keyframe.at("position")}, {"orientation", keyframe.at("orientation")}});
    }
  }
  request["keyframes"] = many;
  request["options"]["deadline_s"] = 60;
  SocketClient socket(door_->port(), kSecret);
  socket.send(R"({"id": 1, "do": "plan", "progress": true, "request": )" + request.dump() + "}");
  EXPECT_EQ(socket.next().count("progress"), 1U);
  socket.send(R"({"id": 1, "do": "cancel"})");
  const json end = socket.next([](const json& message) { return !message.contains("progress"); });
  EXPECT_EQ(end, json({{"id", 1}, {"cancelled", true}}));
}

/// Asks everything that needs a daemon, while none is heard. The client would wait for 10 s each
/// time, and all of them take less than one of these.
void ViewDaemonTest::expect_no_waiting(const std::string& digest) {
  const auto begin = std::chrono::steady_clock::now();
  const std::string request = request_text("office-graze-door");
  for (const Reached& reached :
       {http().get("/v1/scenes"), http().get("/v1/scenes/office"),
        http().get("/v1/scenes/office/meshes/" + std::string(32, '0')),
        http().post("/v1/scenes/office/triangles", R"({"indices": [0]})"),
        http().post("/v1/check", R"({"path": {"segments": []}, "request": )" + request + "}"),
        http().send("DELETE", "/v1/scenes/office/objects/crate")}) {
    EXPECT_EQ(reached.code, 503) << reached.body;
    EXPECT_THAT(reached.body, HasSubstr("no daemon is heard"));
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
  EXPECT_EQ(http().get("/v1/scenes/office/meshes/" + digest).code, 200) << "it is kept here";
}

TEST_F(ViewDaemonTest, SaysThatTheDaemonIsGoneAndBack) {
  start_daemon();
  open_door();
  SocketClient socket(door_->port(), kSecret);
  socket.send(R"({"id": 1, "do": "watch"})");
  const auto next_heard = [&](bool is_heard) {
    return socket.next([&](const json& message) {
      return message.contains("event") && message["event"]["kind"] == "daemon" &&
             message["event"]["heard"] == is_heard;
    });
  };
  EXPECT_FALSE(next_heard(true).contains("closed"));
  const std::string digest =
      http().get("/v1/scenes/office").json().at("objects").at(0).at("digest").get<std::string>();
  EXPECT_EQ(http().get("/v1/scenes/office/meshes/" + digest).code, 200);
  // It waits for the daemon when the silence is noticed.
  daemon().signal(SIGSTOP);
  EXPECT_EQ(http().get("/v1/scenes").code, 503);
  EXPECT_FALSE(next_heard(false).contains("closed"));
  daemon().signal(SIGCONT);
  EXPECT_FALSE(next_heard(true).contains("closed"));
  daemon().signal(SIGKILL);
  ASSERT_EQ(daemon().wait(), 128 + SIGKILL);
  const auto timed_plan_s = [&] {
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(http().post("/v1/plan", request_text("office-graze-door")).code, 503);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  // A silence of 3 s, looked for four times a second; the client itself would repeat for 10 s.
  EXPECT_LT(timed_plan_s(), 6.0);
  EXPECT_FALSE(next_heard(false).contains("closed"));
  EXPECT_LT(timed_plan_s(), 1.0);
  const Reached status = http().get("/v1/status");
  EXPECT_EQ(status.code, 503);
  EXPECT_THAT(status.json().at("error").get<std::string>(), HasSubstr("no daemon is heard"));
  const Reached plan = http().post("/v1/plan", request_text("office-graze-door"));
  EXPECT_EQ(plan.code, 503) << plan.body;
  expect_no_waiting(digest);
  start_daemon();
  EXPECT_FALSE(next_heard(true).contains("closed"));
  EXPECT_EQ(http().post("/v1/plan", request_text("office-graze-door")).code, 200);
}

/// `camway view` as a user runs it.
class ViewCommandTest : public ViewDaemonTest {
 protected:
  std::unique_ptr<Process> start_view(std::vector<std::string> flags) {
    flags.insert(flags.begin(), {CAMWAY_BINARY, "view"});
    auto process = std::make_unique<Process>(flags, file("view.log"));
    EXPECT_TRUE(eventually([&] {
      return process->output().find("token=") != std::string::npos || !process->running();
    }));
    return process;
  }
  /// Returns the port and the token that it printed.
  static std::pair<int, std::string> address_of(const std::string& output) {
    std::smatch found;
    const std::regex line("http://127\\.0\\.0\\.1:([0-9]+)/\\?token=([0-9a-f]{32})\n");
    if (!std::regex_search(output, found, line)) return {0, output};
    return {std::stoi(found[1]), found[2]};
  }
};

TEST_F(ViewCommandTest, PrintsItsAddressAndEndsBySignals) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const auto view = start_view({"--scene", scene_file("office"), "--request",
                                  request_file("office-graze-door"), "--read-only"});
    const auto [port, token] = address_of(view->output());
    ASSERT_GT(port, 0) << token;
    HttpClient client(port, token);
    EXPECT_EQ(client.get("/v1/status").json().at("read_only"), true);
    EXPECT_EQ(HttpClient(port, "x").get("/v1/status").code, 403);
    view->signal(signal);
    EXPECT_EQ(view->wait(), 0);
  }
}

TEST_F(ViewCommandTest, ServesADaemonThatIsNotThereYet) {
  const auto view = start_view({"office", "--timeout-s", "0.5"});
  const auto [port, token] = address_of(view->output());
  ASSERT_GT(port, 0) << token;
  HttpClient client(port, token);
  EXPECT_EQ(client.post("/v1/plan", request_text("office-graze-door")).code, 503);
  start_daemon();
  EXPECT_TRUE(eventually(
      [&] { return client.post("/v1/plan", request_text("office-graze-door")).code == 200; }));
  view->signal(SIGINT);
  EXPECT_EQ(view->wait(), 0);
}

TEST_F(ViewCommandTest, SaysWhyItCannotBegin) {
  const auto fault = [&](const std::vector<std::string>& flags) {
    const auto view = start_view(flags);
    EXPECT_EQ(view->wait(), 2);
    return view->output();
  };
  EXPECT_THAT(fault({}), HasSubstr("SCENE names a scene of a daemon"));
  EXPECT_THAT(fault({"--scene", file("no.obj")}), HasSubstr("no.obj"));
  EXPECT_THAT(fault({"office", "--scene", scene_file("office")}), HasSubstr("--scene"));
  EXPECT_THAT(fault({"--scene", scene_file("office"), "--port", "70000"}), HasSubstr("--port"));
  EXPECT_THAT(fault({"--scene", scene_file("office"), "--request", file("no.json")}),
              HasSubstr("no.json"));
}

}  // namespace
}  // namespace camway::integration
