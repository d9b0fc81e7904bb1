// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <future>
#include <memory>
#include <mutex>
#include <regex>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.h"
#include "tests/tools/view/door_client.h"
#include "tools/json/json_document.h"
#include "tools/view/door.h"
#include "tools/view/here/planner_here.h"

namespace camway::view {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

const fs::path kScenes = CAMWAY_SCENES_FOLDER;

std::string request_text(const std::string& name) {
  return *tools::read_text((kScenes / "requests" / (name + ".json")).string());
}

/// A door that plans here, in the office or another scene.
class ViewHere : public ::testing::Test {
 protected:
  void open(const std::string& scene = "office", const DoorLimits& limits = {}) {
    const scene::SnapshotResult loaded = scene::load_snapshot(scene, kScenes / (scene + ".obj"));
    if (!loaded.snapshot) throw std::runtime_error(loaded.error);
    backend_ = plan_here(loaded.snapshot, {.scene_reading = scene::ImportOptions{}});
    auto opened = Door::open({.token = kSecret, .limits = limits}, *backend_);
    if (!opened) throw std::runtime_error(opened.error);
    door_ = *std::move(opened);
  }
  HttpClient http() { return {door_->port(), kSecret}; }

  std::unique_ptr<Backend> backend_;
  std::unique_ptr<Door> door_;
};

/// Returns an answer without the lines of its timing and of its scene's name.
std::string bytes_that_count(const std::string& answer) {
  const std::string without_scene =
      std::regex_replace(answer, std::regex("\n  \"scene\": [^\n]*"), "");
  return std::regex_replace(without_scene, std::regex(",\n  \"timing_ms\": [^\n]*"), "");
}

/// Runs `camway plan` as a user does.
std::string answer_of_camway_plan(const std::string& name) {
  const testing::TemporaryFolder folder;
  const std::string response = (folder.path() / "response.json").string();
  const std::string command = std::string("'") + CAMWAY_BINARY + "' plan --scene '" +
                              (kScenes / "office.obj").string() + "' --request '" +
                              (kScenes / "requests" / (name + ".json")).string() +
                              "' --response '" + response + "' 2>/dev/null";
  // Its exit code tells of the answer, which is compared anyway.
  static_cast<void>(std::system(command.c_str()));
  return *tools::read_text(response);
}

TEST_F(ViewHere, AnswersAreThoseOfCamwayPlanByteForByte) {
  const std::vector<std::string> names{"office-graze-door",  "office-graze-slalom",
                                       "office-wall-rooms",  "office-impossible-safe",
                                       "office-free-stairs", "office-wall-floor"};
  open();
  SocketClient socket(door_->port(), kSecret);
  for (const std::string& name : names) {
    const std::string written = answer_of_camway_plan(name);
    const Reached got = http().post("/v1/plan", request_text(name));
    ASSERT_EQ(got.code, 200) << got.body;
    EXPECT_THAT(written, HasSubstr("\"segments\""));
    EXPECT_EQ(bytes_that_count(got.body), bytes_that_count(written)) << name;
    socket.send(R"({"id": 1, "do": "plan", "request": )" + request_text(name) + "}");
    json answer = socket.next().at("answer");
    json same = json::parse(got.body);
    answer.erase("timing_ms");
    same.erase("timing_ms");
    EXPECT_EQ(answer, same) << name;
  }
}

TEST_F(ViewHere, AnswersThatAreNoPathAreAnswers) {
  open();
  const Reached got = http().post("/v1/plan", request_text("office-impossible-safe"));
  EXPECT_EQ(got.code, 200);
  EXPECT_EQ(got.json().at("status"), "infeasible");
  const Reached unknown = http().post("/v1/plan", request_text("maze-free-cells"));
  EXPECT_EQ(unknown.code, 404);
  EXPECT_EQ(unknown.json().at("error"), "unknown scene 'maze'; there are: 'office'");
}

TEST_F(ViewHere, ChecksPathsAsCamwayCheckDoes) {
  open();
  const std::string request = request_text("office-graze-door");
  const std::string path = http().post("/v1/plan", request).body;
  const Reached checked =
      http().post("/v1/check", "{\"request\": " + request + ", \"path\": " + path + "}");
  ASSERT_EQ(checked.code, 200) << checked.body;
  EXPECT_EQ(checked.json().at("verdict"), "free");
  EXPECT_EQ(checked.json().at("same_scene"), true);
  json broken = json::parse(path);
  broken["segments"][0]["t1"] = 1e6;
  const Reached refused =
      http().post("/v1/check", "{\"request\": " + request + ", \"path\": " + broken.dump() + "}");
  EXPECT_EQ(refused.code, 400);
  EXPECT_THAT(refused.json().at("error"), HasSubstr("path: segments"));
}

TEST_F(ViewHere, ObjectsComeMoveAndGo) {
  open();
  HttpClient client = http();
  const std::string objects = "/v1/scenes/office/objects";
  const json before = client.get("/v1/scenes").json().at("scenes").at(0);
  for (
      const char* const form :
      {R"({"type": "box", "size": [1, 2, 3]})", R"({"type": "sphere", "radius_m": 0.5})",
       R"({"type": "cylinder", "radius_m": 0.5, "height_m": 2})",
       R"({"type": "mesh", "format": "obj", "text": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"})",
       R"({"type": "mesh", "format": "obj", "base64": "diAwIDAgMAp2IDEgMCAwCnYgMCAxIDAKZiAxIDIgMwo="})"}) {
    const Reached added = client.post(
        objects, std::string(R"({"name": "crate", "position": [5, 6, 7], "form": )") + form + "}");
    ASSERT_EQ(added.code, 200) << added.body;
    EXPECT_EQ(added.json().at("objects").at(0).at("position"), json({5.0, 6.0, 7.0}));
  }
  const Reached moved =
      client.send("PATCH", objects + "/crate", R"({"orientation": [0, 0, 0, 2]})");
  EXPECT_EQ(moved.json().at("objects").at(0).at("position"), json({5.0, 6.0, 7.0}));
  EXPECT_EQ(moved.json().at("objects").at(0).at("orientation"), json({0.0, 0.0, 0.0, 1.0}));
  EXPECT_EQ(client.get("/v1/scenes/office").json().at("objects").size(), 2U);
  EXPECT_EQ(client.send("DELETE", objects + "/crate").code, 200);
  EXPECT_EQ(client.send("DELETE", objects + "/crate").code, 404);
  EXPECT_EQ(client.send("PATCH", objects + "/crate", R"({"position": [1, 2, 3]})").code, 404);
  EXPECT_EQ(client.get("/v1/scenes/hall").code, 404);
  const json after = client.get("/v1/scenes").json().at("scenes").at(0);
  EXPECT_EQ(after.at("digest"), before.at("digest"));
  EXPECT_EQ(after.at("revision"), 8);
  EXPECT_EQ(client.get("/v1/status").json().at("backend").at("planner"), "here");
}

TEST_F(ViewHere, AMoveKeepsTheDigestOfTheMeshInItsOwnFrame) {
  open();
  HttpClient client = http();
  const std::string objects = "/v1/scenes/office/objects";
  const auto added = [&](const std::string& name, const std::string& size) {
    const std::string form = R"({"type": "box", "size": )" + size + "}";
    const Reached got =
        client.post(objects, R"({"name": ")" + name + R"(", "form": )" + form + "}");
    return got.json().at("objects").at(0);
  };
  const json crate = added("crate", "[1, 2, 3]");
  const json moved =
      client.send("PATCH", objects + "/crate", R"({"position": [6, 6, 7]})").json()["objects"][0];
  EXPECT_NE(moved.at("digest"), crate.at("digest"));
  EXPECT_EQ(moved.at("mesh_digest"), crate.at("mesh_digest"));
  EXPECT_EQ(added("twin", "[1, 2, 3]").at("mesh_digest"), crate.at("mesh_digest"));
  // An object that takes its place has another mesh, even at the same address.
  for (const char* const size : {"[1, 2, 4]", "[2, 2, 3]"}) {
    EXPECT_NE(added("crate", size).at("mesh_digest"), crate.at("mesh_digest"));
  }
}

// The voxels of a cloud are numbered from an origin near it.
TEST_F(ViewHere, ACloudOfPointsIsWhereItsPointsAre) {
  open();
  HttpClient client = http();
  const Reached added =
      client.post("/v1/scenes/office/objects",
                  R"({"name": "cloud", "form": {"type": "mesh", "format": "xyz", "voxel_m": 0.5,
          "text": "400000.1 5 6\n400003.1 5 6\n400003.1 7 6\n"}})");
  ASSERT_EQ(added.code, 200) << added.body;
  const json scene = added.json().at("scene");
  EXPECT_NEAR(scene.at("bounds_max_m").at(0), 400003.1, 0.5) << added.body;
}

TEST_F(ViewHere, RefusesObjectsThatCannotBeMade) {
  open();
  const auto refusal = [&](const std::string& form) {
    const Reached got =
        http().post("/v1/scenes/office/objects", R"({"name": "x", "form": )" + form + "}");
    EXPECT_EQ(got.code, 400) << form;
    return got.json().at("error").get<std::string>();
  };
  EXPECT_THAT(refusal(R"({"type": "mesh", "file": "/etc/passwd"})"),
              HasSubstr("no files are read"));
  EXPECT_THAT(refusal(R"({"type": "sphere", "radius_m": 1e10})"), HasSubstr("form: "));
  const std::string broken = refusal(R"({"type": "mesh", "format": "obj", "text": "nonsense"})");
  EXPECT_THAT(broken, HasSubstr("form"));
  EXPECT_THAT(broken, ::testing::Not(HasSubstr("/tmp"))) << "clients know nothing of the file";
}

TEST_F(ViewHere, TwoClientsSeeEachOthersChanges) {
  open();
  SocketClient one(door_->port(), kSecret);
  SocketClient other(door_->port(), kSecret);
  one.send(R"({"id": 1, "do": "watch"})");
  const auto revision = [](const json& message) {
    return message.at("event").at("state").at("scenes").at(0).at("revision").get<int>();
  };
  EXPECT_EQ(revision(one.next(1)), 1);
  const std::string request = request_text("office-free-straight");
  const std::string plan = R"(, "do": "plan", "request": )" + request + "}";
  one.send(R"({"id": 2)" + plan);
  const json before = one.next(2).at("answer");
  EXPECT_EQ(before.at("collisions").size(), 0U);
  const json keyframes = json::parse(request).at("keyframes");
  json at = json::array();
  for (std::size_t i = 0; i < 3; ++i) {
    at.push_back(0.5 * (keyframes.at(0).at("position").at(i).get<double>() +
                        keyframes.at(1).at("position").at(i).get<double>()));
  }
  other.send(R"({"id": 1, "do": "scene.add", "object": "crate", "form": {"type": "box",
                 "size": [0.5, 0.5, 0.5]}, "position": )" +
             at.dump() + "}");
  EXPECT_EQ(other.next(1).count("answer"), 1U);
  EXPECT_EQ(revision(one.next(1)), 2);
  one.send(R"({"id": 3)" + plan);
  EXPECT_EQ(one.next(3).at("answer").at("collisions").size(), 1U) << "the crate is on the way";
}

/// A request that takes many seconds: from room to room through the walls, many times.
std::string long_request() {
  json request = json::parse(request_text("office-wall-tour"));
  const json keyframes = request.at("keyframes");
  constexpr int kRounds = 200;
  json many = json::array();
  for (int round = 0; round < kRounds; ++round) {
    for (const json& keyframe : keyframes) {
      many.push_back(
          {{"position", keyframe.at("position")}, {"orientation", keyframe.at("orientation")}});
    }
  }
  request["keyframes"] = many;
  request["options"]["deadline_s"] = 600;
  return request.dump();
}

TEST_F(ViewHere, TellsOfProgressAndEndsCancelledPlans) {
  open();
  SocketClient socket(door_->port(), kSecret);
  socket.send(R"({"id": 1, "do": "plan", "progress": true, "request": )" + long_request() + "}");
  const json progress = socket.next();
  ASSERT_EQ(progress.count("progress"), 1U) << progress;
  EXPECT_EQ(progress.at("progress").at("deadline_s"), 600);
  socket.send(R"({"id": 1, "do": "cancel"})");
  const json end = socket.next([](const json& message) { return !message.contains("progress"); });
  EXPECT_EQ(end, json({{"id", 1}, {"cancelled", true}}));
}

TEST_F(ViewHere, EndsWhilePlansRun) {
  open();
  SocketClient socket(door_->port(), kSecret);
  for (int id = 1; id <= 5; ++id) {
    socket.send(R"({"id": )" + std::to_string(id) +
                R"(, "do": "plan", "progress": true, "request": )" + long_request() + "}");
  }
  EXPECT_EQ(socket.next().count("progress"), 1U);
  door_.reset();
  backend_.reset();
  const json end = socket.next([](const json& message) { return message.contains("closed"); });
  EXPECT_EQ(end.count("closed"), 1U);
}

TEST_F(ViewHere, TheBackendEndsBeforeItsPlansAndSaysSo) {
  open();
  std::mutex mutex;
  std::vector<int> codes;
  constexpr int kPlans = 6;
  for (int i = 0; i < kPlans; ++i) {
    auto order = read_plan(json::parse(long_request()));
    ASSERT_TRUE(order);
    backend_->plan(*std::move(order), nullptr, [&](const Answer& answer) {
      const std::lock_guard lock(mutex);
      codes.push_back(answer.code);
    });
  }
  door_.reset();
  backend_.reset();
  ASSERT_EQ(codes.size(), std::size_t{kPlans});
  for (const int code : codes) {
    EXPECT_TRUE(code == code::kCancelled || code == code::kNoDaemon) << code;
  }
}

TEST_F(ViewHere, DrawsTheLastPlan) {
  open();
  EXPECT_EQ(http().get("/plan.svg").code, 404);
  http().post("/v1/plan", request_text("office-graze-door"));
  const Reached picture = http().get("/plan.svg");
  EXPECT_EQ(picture.code, 200);
  EXPECT_EQ(picture.type, "image/svg+xml");
  EXPECT_THAT(picture.body, HasSubstr("<svg"));
}

TEST_F(ViewHere, APathWithoutACollisionIsAsInterpolated) {
  open();
  SocketClient socket(door_->port(), kSecret);
  for (const std::string name : {"office-free-straight", "office-free-timed", "office-free-stairs",
                                 "office-free-atrium", "office-free-turn"}) {
    const std::string request = request_text(name);
    const json answer = http().post("/v1/plan", request).json();
    ASSERT_TRUE(answer.at("collisions").empty()) << name;
    const Reached before = http().post("/v1/interpolate", request);
    ASSERT_EQ(before.code, 200) << before.body;
    EXPECT_EQ(before.json().size(), 1U);
    // Bit for bit: both are the shortest decimals of their doubles.
    EXPECT_EQ(before.json().at("segments"), answer.at("segments")) << name;
    socket.send(R"({"id": 1, "do": "interpolate", "request": )" + request + "}");
    EXPECT_EQ(socket.next().at("answer"), before.json());
    // An answer with a frame is interpolated to the same path.
    json again = json::parse(request);
    again["keyframes"] = answer.at("keyframes");
    if (!answer.contains("frame")) continue;
    again["frame"] = answer.at("frame");
    const json edited = http().post("/v1/interpolate", again.dump()).json();
    EXPECT_EQ(edited.at("segments").size(), answer.at("segments").size()) << name;
  }
}

TEST_F(ViewHere, APathIsInterpolatedAtTheTimesOfItsRequest) {
  open();
  json request = json::parse(request_text("office-free-timed"));
  constexpr double kSince1970_s = 1.76e9;
  for (json& keyframe : request.at("keyframes")) {
    keyframe["time"] = keyframe.at("time").get<double>() + kSince1970_s;
  }
  const json answer = http().post("/v1/plan", request.dump()).json();
  const json before = http().post("/v1/interpolate", request.dump()).json();
  EXPECT_GE(before.at("segments").front().at("t0"), kSince1970_s);
  EXPECT_EQ(before.at("segments"), answer.at("segments"));
}

TEST_F(ViewHere, APathIsInterpolatedThroughWhatIsInTheWay) {
  open();
  const std::string request = request_text("office-graze-column");
  const json answer = http().post("/v1/plan", request).json();
  ASSERT_FALSE(answer.at("collisions").empty());
  const json before = http().post("/v1/interpolate", request).json();
  EXPECT_NE(before.at("segments"), answer.at("segments"));
  EXPECT_EQ(before.at("segments").front().at("t0"), answer.at("segments").front().at("t0"));
  EXPECT_EQ(before.at("segments").back().at("t1"), answer.at("segments").back().at("t1"));
}

TEST_F(ViewHere, RemembersTheLastPlan) {
  open();
  EXPECT_EQ(http().get("/v1/last").json(), json::object());
  const std::string request = request_text("office-graze-door");
  const json answer = http().post("/v1/plan", request).json();
  const json last = http().get("/v1/last").json();
  EXPECT_EQ(last.at("request"), json::parse(request));
  EXPECT_EQ(last.at("answer"), answer);
  SocketClient socket(door_->port(), kSecret);
  socket.send(R"({"id": 3, "do": "last"})");
  EXPECT_EQ(socket.next().at("answer"), last);
  socket.send(R"({"id": 4, "do": "fields"})");
  EXPECT_EQ(socket.next().at("answer"), http().get("/v1/fields").json());
  socket.send(R"({"id": 5, "do": "triangles", "indices": [3]})");
  EXPECT_EQ(socket.next().at("answer"),
            http().post("/v1/scenes/office/triangles", R"({"indices": [3]})").json());
}

TEST_F(ViewHere, ExportsWhatCamwayExportWrites) {
  open();
  const testing::TemporaryFolder folder;
  const std::string request = request_text("office-graze-column");
  const std::string answer = http().post("/v1/plan", request).body;
  const std::string response = (folder.path() / "response.json").string();
  std::ofstream(response) << answer;
  const std::string document = "{\"request\": " + request + ", \"answer\": " + answer + "}";
  const json formats = http().get("/v1/fields").json().at("exports");
  EXPECT_GT(formats.size(), 5U);
  for (const json& format : formats) {
    const auto name = format.at("name").get<std::string>();
    const Reached got = http().post("/v1/export?format=" + name, document);
    ASSERT_EQ(got.code, 200) << name << got.body;
    EXPECT_THAT(got.header("Content-Disposition"),
                HasSubstr("camera" + format.at("extension").get<std::string>()));
    const std::string file =
        (folder.path() / ("out" + format.at("extension").get<std::string>())).string();
    const std::string command =
        std::string("'") + CAMWAY_BINARY + "' export '" + response + "' --request '" +
        (kScenes / "requests" / "office-graze-column.json").string() + "' --no-proof --format " +
        name + " --out '" + file + "' 2>/dev/null";
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
    EXPECT_TRUE(*tools::read_text(file) == got.body) << name;
  }
}

TEST_F(ViewHere, SaysWhyNothingIsExported) {
  open();
  const std::string request = request_text("office-graze-door");
  const json answer = http().post("/v1/plan", request).json();
  json document{{"request", json::parse(request)}, {"answer", answer}};
  const auto error = [&](const std::string& query) {
    const Reached got = http().post("/v1/export" + query, document.dump());
    EXPECT_EQ(got.code, 400) << query;
    return got.json().at("error").get<std::string>();
  };
  EXPECT_THAT(error(""), HasSubstr("format: is none of: gltf"));
  for (const char* const query : {"?format=", "?format=fbx", "?format=../csv", "?fromat=csv"}) {
    EXPECT_THAT(error(query), HasSubstr("format: is none of: gltf"));
  }
  document["answer"]["segments"] = json::array();
  EXPECT_THAT(error("?format=csv"), HasSubstr("answer"));
  document.erase("answer");
  EXPECT_EQ(error("?format=csv"), "answer: is missing");
}

/// Asks a backend for a mesh and waits for it.
MeshAnswer mesh_of(Backend& backend, const std::string& scene, const std::string& digest) {
  auto promise = std::make_shared<std::promise<MeshAnswer>>();
  backend.mesh(scene, digest, [promise](MeshAnswer mesh) { promise->set_value(std::move(mesh)); });
  return promise->get_future().get();
}

Answer triangles_of(Backend& backend, const std::vector<std::int64_t>& indices) {
  auto promise = std::make_shared<std::promise<Answer>>();
  backend.triangles(backend.scene(), indices,
                    [promise](Answer answer) { promise->set_value(std::move(answer)); });
  return promise->get_future().get();
}

TEST_F(ViewHere, MeshesAreThoseOfObjectsInTheirOwnFrames) {
  open();
  const std::string crate =
      R"({"name": "crate", "form": {"type": "box", "size": [0.5, 0.6, 0.7]},
          "position": [9, 1.5, 9], "orientation": [0.5, 0.5, 0.5, 0.5]})";
  const json added = json::parse(http().post("/v1/scenes/office/objects", crate).body);
  const auto digest = added["objects"][0]["digest"].get<std::string>();
  const MeshAnswer box = mesh_of(*backend_, "office", digest);
  ASSERT_TRUE(box.mesh) << box.error;
  EXPECT_EQ(box.code, 200);
  EXPECT_EQ(box.mesh->bounds().min(), geometry::Vec3(-0.25, -0.3, -0.35));
  EXPECT_EQ(box.mesh->bounds().max(), geometry::Vec3(0.25, 0.3, 0.35));
  EXPECT_EQ(box.scene_triangles, added["scene"]["triangles"]);
  const MeshAnswer none = mesh_of(*backend_, "office", std::string(32, '0'));
  EXPECT_FALSE(none.mesh);
  EXPECT_EQ(none.code, 404);
  EXPECT_THAT(none.error, HasSubstr("no object of this digest"));
  EXPECT_EQ(mesh_of(*backend_, "mars", digest).code, 404);
}

TEST_F(ViewHere, TrianglesAreThoseOfTheSceneByNumber) {
  open();
  const auto scene = scene::load_snapshot("office", kScenes / "office.obj").snapshot;
  const auto last = static_cast<std::int64_t>(scene->index.size()) - 1;
  const Answer answer = triangles_of(*backend_, {0, last, last + 1, -1, 0, INT64_MAX, INT64_MIN});
  const json got = json::parse(answer.json);
  EXPECT_EQ(got["revision"], 1);
  ASSERT_EQ(got["triangles"].size(), 2) << answer.json;
  for (const std::int64_t index : {std::int64_t{0}, last}) {
    const geometry::Triangle expected = scene->index.triangle(static_cast<std::size_t>(index));
    for (std::size_t corner = 0; corner < 3; ++corner) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(got["triangles"][std::to_string(index)][corner][axis],
                  expected.at(corner)[static_cast<Eigen::Index>(axis)]);
      }
    }
  }
}

}  // namespace
}  // namespace camway::view
