// SPDX-License-Identifier: MIT
#include "tools/view/door.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <string>
#include <vector>

#include "tests/tools/view/door_client.h"
#include "tests/tools/view/fake_backend.h"
#include "tools/view/routes.h"

namespace camway::view {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

TEST(ViewRoutes, LeadToPlacesByMethodAndPath) {
  struct RouteCase {
    const char* method;
    const char* target;
    int code;
  };
  for (const RouteCase& each : std::vector<RouteCase>{
           {"GET", "/", 200},
           {"HEAD", "/", 200},
           {"POST", "/", 405},
           {"GET", "/page.js", 200},
           {"GET", "/page.css", 200},
           {"GET", "/page.ts", 404},
           {"GET", "/?token=x", 200},
           {"GET", "//", 404},
           {"GET", "", 404},
           {"GET", "/v1", 404},
           {"GET", "/v1/", 404},
           {"POST", "/v1/plan", 200},
           {"GET", "/v1/plan", 405},
           {"PLAN", "/v1/plan", 405},
           {"", "/v1/plan", 405},
           {"GET", "/v1/scenes", 200},
           {"GET", "/v1/scenes/", 404},
           {"GET", "/v1/scenes/a", 200},
           {"DELETE", "/v1/scenes/a", 405},
           {"POST", "/v1/scenes/a/objects", 200},
           {"GET", "/v1/scenes/a/objects", 405},
           {"GET", "/v1/scenes/a/things", 404},
           {"POST", "/v1/scenes//objects", 404},
           {"PATCH", "/v1/scenes/a/objects/b", 200},
           {"DELETE", "/v1/scenes/a/objects/b", 200},
           {"GET", "/v1/scenes/a/objects/b", 405},
           {"DELETE", "/v1/scenes/a/objects/", 404},
           {"DELETE", "/v1/scenes/a/objects/b/c", 404},
           {"GET", "/v1/scenes/a/meshes/b", 200},
           {"HEAD", "/v1/scenes/a/meshes/b", 200},
           {"GET", "/v1/scenes/a/meshes", 404},
           {"POST", "/v1/scenes/a/triangles", 200},
           {"GET", "/v1/scenes/a/triangles", 405},
           {"POST", "/v1/scenes/a/triangles/1", 404},
           {"POST", "/v1/interpolate", 200},
           {"GET", "/v1/fields", 200},
           {"GET", "/v1/last", 200},
           {"POST", "/v1/last", 405},
           {"POST", "/v1/review", 200},
           {"GET", "/v1/review", 405},
           {"POST", "/v1/export?format=csv", 200},
           {"GET", "/v1/export", 405},
           {"GET", "/v2/plan", 404},
       }) {
    EXPECT_EQ(route_of(each.method, each.target).code, each.code)
        << each.method << " " << each.target;
  }
  const Route route = route_of("DELETE", "/v1/scenes/hall/objects/crate?x=y");
  EXPECT_EQ(route.scene, "hall");
  EXPECT_EQ(route.object, "crate");
}

class ViewDoor : public ::testing::Test {
 protected:
  void open(const DoorLimits& limits = {}, bool is_read_only = false) {
    auto opened =
        Door::open({.token = kSecret, .is_read_only = is_read_only, .limits = limits}, backend_);
    if (!opened) throw std::runtime_error(opened.error);
    door_ = *std::move(opened);
    client_ = std::make_unique<HttpClient>(door_->port(), kSecret);
  }
  std::string error_of(const Reached& answer) { return answer.json().at("error"); }

  FakeBackend backend_;
  std::unique_ptr<Door> door_;
  std::unique_ptr<HttpClient> client_;
};

TEST_F(ViewDoor, PlansAndAnswersWithWhatTheBackendSays) {
  open();
  auto answer =
      std::async(std::launch::async, [&] { return client_->post("/v1/plan", kSmallRequest); });
  FakeBackend::Asked asked = backend_.take();
  EXPECT_EQ(asked.order.scene, "office");
  asked.done({code::kOk, "{\n  \"status\": \"infeasible\"\n}\n", {}});
  const Reached got = answer.get();
  EXPECT_EQ(got.code, 200);
  EXPECT_EQ(got.type, "application/json");
  EXPECT_EQ(got.body, "{\n  \"status\": \"infeasible\"\n}\n");
}

TEST_F(ViewDoor, TakesTheSceneThatARequestFileNames) {
  open();
  std::string request = kSmallRequest;
  request.insert(1, R"("scene": "../maze.obj", )");
  auto answer = std::async(std::launch::async, [&] { return client_->post("/v1/plan", request); });
  FakeBackend::Asked asked = backend_.take();
  EXPECT_EQ(asked.order.scene, "maze");
  asked.done(failure(code::kNotFound, "no maze"));
  const Reached got = answer.get();
  EXPECT_EQ(got.code, 404);
  EXPECT_EQ(error_of(got), "no maze");
}

TEST_F(ViewDoor, NamesTheMemberThatIsWrong) {
  open();
  const auto error = [&](const std::string& target, const std::string& body) {
    const Reached got = client_->post(target, body);
    EXPECT_EQ(got.code, 400) << body;
    return error_of(got);
  };
  EXPECT_THAT(error("/v1/plan", ""), HasSubstr("request: is empty"));
  EXPECT_THAT(error("/v1/plan", "{\"a\": 1, \"a\": 2}"), HasSubstr("stands twice"));
  EXPECT_THAT(error("/v1/plan", R"({"keyframes": []})"), HasSubstr("request: camera: is missing"));
  std::string one = kSmallRequest;
  one.replace(one.find("\"near\": 0.1"), 11, "\"near\": -1");
  EXPECT_THAT(error("/v1/plan", one), HasSubstr("request: camera.near"));
  std::string file = kSmallRequest;
  file.insert(1, R"("body": {"type": "mesh", "file": "/etc/passwd"}, )");
  EXPECT_THAT(error("/v1/plan", file), HasSubstr("body.file: is a file"));
  EXPECT_THAT(error("/v1/interpolate", one), HasSubstr("request: camera.near"));
  const std::string triangles = "/v1/scenes/office/triangles";
  EXPECT_EQ(error(triangles, "{}"), "indices: is missing");
  EXPECT_THAT(error(triangles, R"({"indices": 7})"), HasSubstr("indices: must be an array"));
  EXPECT_THAT(error(triangles, R"({"indices": [1.5]})"), HasSubstr("indices[0]: is 1.5; it must"));
  EXPECT_THAT(error(triangles, R"({"indices": [0, 1e300]})"), HasSubstr("indices[1]: "));
  EXPECT_THAT(error(triangles, R"({"indices": [], "scene": "x"})"), HasSubstr("scene: "));
  json many = {{"indices", std::vector<int>(kMostIndices + 1)}};
  EXPECT_THAT(error(triangles, many.dump()), HasSubstr("has 100001 numbers, and may have 100000"));
  EXPECT_EQ(error("/v1/check", "{}"), "request: is missing");
  EXPECT_THAT(error("/v1/check", std::string(R"({"path": {}, "request": )") + kSmallRequest + "}"),
              HasSubstr("path: segments: is missing"));
  const std::string objects = "/v1/scenes/office/objects";
  EXPECT_EQ(error(objects, "{}"), "name: is missing");
  EXPECT_THAT(error(objects, R"({"name": "../x"})"), HasSubstr("name: must be of"));
  EXPECT_EQ(error(objects, R"({"name": "x"})"), "form: is missing");
  const auto form_error = [&](const std::string& form) {
    return error(objects, R"({"name": "x", "form": )" + form + "}");
  };
  EXPECT_THAT(form_error(R"({"type": "cone"})"), HasSubstr("form.type: "));
  EXPECT_THAT(form_error(R"({"type": "box", "size": [1, 0, 1]})"), HasSubstr("form.size: "));
  EXPECT_THAT(form_error(R"({"type": "box", "size": [1, 1]})"), HasSubstr("form.size: "));
  EXPECT_THAT(form_error(R"({"type": "sphere", "radius_m": -1})"), HasSubstr("form.radius_m: "));
  EXPECT_THAT(form_error(R"({"type": "sphere", "radius_m": 1, "height_m": 1})"),
              HasSubstr("form.height_m: "));
  EXPECT_THAT(form_error(R"({"type": "mesh"})"), HasSubstr("none of file, text and base64"));
  EXPECT_THAT(form_error(R"({"type": "mesh", "text": "v", "format": "../x"})"),
              HasSubstr("form.format: "));
  EXPECT_THAT(form_error(R"({"type": "mesh", "base64": "!!!!", "format": "stl"})"),
              HasSubstr("form.base64: is no base64"));
  EXPECT_EQ(backend_.plans(), 0);
  EXPECT_TRUE(backend_.orders().empty());
}

TEST_F(ViewDoor, TellsProgramsTheMemberThatIsWrong) {
  open();
  const auto told = [&](const std::string& target, const std::string& body) {
    return client_->post(target, body).json();
  };
  std::string one = kSmallRequest;
  one.replace(one.find("\"near\": 0.1"), 11, "\"near\": -1");
  EXPECT_EQ(told("/v1/plan", one).at("field"), "camera.near");
  EXPECT_EQ(told("/v1/plan", "").at("field"), "request") << "all of it";
  EXPECT_EQ(told("/v1/scenes/office/objects",
                 R"({"name": "x", "form": {"type": "box", "size": [1, 0, 1]}})")
                .at("field"),
            "form.size");
  EXPECT_EQ(told("/v1/nowhere", "").count("field"), 0U) << "of what is no wrong request";
  SocketClient socket(door_->port(), kSecret);
  socket.send(R"({"id": 1, "do": "plan", "request": )" + one + "}");
  const json refused = socket.next();
  EXPECT_EQ(refused.at("field"), "camera.near") << refused;
  EXPECT_EQ(field_of("request: keyframes[2].position[0]: is 1e999; it must be finite"),
            "keyframes[2].position[0]");
  EXPECT_EQ(field_of("too many at a time: at most 8 plans"), "");
  EXPECT_EQ(field_of("x"), "");
  EXPECT_EQ(field_of(": a"), "");
}

TEST_F(ViewDoor, AnswersEveryPlace) {
  open();
  EXPECT_EQ(client_->get("/v1/version").json().at("door"), 1);
  EXPECT_EQ(client_->get("/v1/status").json(),
            json::parse(R"({"read_only": false, "backend": {"planner": "fake"}})"));
  EXPECT_EQ(client_->get("/v1/scenes").code, 200);
  EXPECT_EQ(client_->get("/v1/scenes/hall").json().at("scene"), "hall");
  const std::string box = R"({"name": "crate", "form": {"type": "box", "size": [1, 2, 3]}})";
  EXPECT_EQ(client_->post("/v1/scenes/hall/objects", box).code, 200);
  EXPECT_EQ(
      client_->send("PATCH", "/v1/scenes/hall/objects/crate", R"({"position": [1, 2, 3]})").code,
      200);
  EXPECT_EQ(client_->send("PATCH", "/v1/scenes/hall/objects/crate", "{}").code, 400);
  EXPECT_EQ(client_->send("DELETE", "/v1/scenes/hall/objects/crate").code, 200);
  const std::string check =
      std::string(R"({"path": {"segments": []}, "request": )") + kSmallRequest + "}";
  EXPECT_EQ(client_->post("/v1/check", check).json().at("verdict"), "free");
  EXPECT_EQ(client_->get("/v1/socket").code, 400);
  EXPECT_EQ(client_->post("/v1/scenes/hall/triangles", R"({"indices": [7, 5]})").json(),
            json::parse(R"({"revision": 1, "triangles": {"5": [[0, 0, 0], [0, 0, 0], [0, 0, 0]],
                                                         "7": [[0, 0, 0], [0, 0, 0], [0, 0, 0]]}})"));
  EXPECT_EQ(client_->post("/v1/interpolate", kSmallRequest).json().at("segments").size(), 1U);
  EXPECT_GT(client_->get("/v1/fields").json().at("fields").size(), 10U);
  const auto orders = backend_.orders();
  ASSERT_EQ(orders.size(), 5U);
  for (std::size_t i = 2; i < orders.size(); ++i) {
    EXPECT_EQ(orders[i].scene, "hall");
    EXPECT_EQ(orders[i].object, "crate");
    EXPECT_TRUE(orders[i].is_change());
  }
}

TEST_F(ViewDoor, TellsOfTheLastPlan) {
  DoorOptions options{.token = kSecret};
  const auto last = [&] {
    const auto door = Door::open(options, backend_);
    return HttpClient((*door)->port(), kSecret).get("/v1/last").json();
  };
  EXPECT_EQ(last(), json::object());
  options.first_request = R"({"a": 1})";
  EXPECT_EQ(last(), json::parse(R"({"request": {"a": 1}})"));
  LastPlan plan;
  plan.request_text = std::make_shared<const std::string>(R"({"b": 2})");
  plan.answer_text = std::make_shared<const std::string>("{\"status\": \"ok\"}\n");
  backend_.last_plan = std::make_shared<const LastPlan>(plan);
  EXPECT_EQ(last(), json::parse(R"({"request": {"b": 2}, "answer": {"status": "ok"}})"));
}

TEST_F(ViewDoor, SendsMeshesForPages) {
  scene::Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  backend_.display_mesh = std::make_shared<const scene::Mesh>(mesh);
  open();
  for (int time = 0; time < 2; ++time) {
    const Reached got = client_->get("/v1/scenes/hall/meshes/0123abc");
    EXPECT_EQ(got.code, 200);
    EXPECT_EQ(got.type, "model/gltf-binary");
    EXPECT_EQ(got.body.substr(0, 4), "glTF");
  }
  EXPECT_EQ(client_->send("HEAD", "/v1/scenes/hall/meshes/0123abc").code, 200);
  EXPECT_EQ(client_->post("/v1/scenes/hall/meshes/0123abc", "{}").code, 405);
}

TEST_F(ViewDoor, SaysWhyThereIsNoMesh) {
  open();
  const Reached got = client_->get("/v1/scenes/hall/meshes/%00..%2f");
  EXPECT_EQ(got.code, 404);
  EXPECT_EQ(error_of(got), "no object %00..%2f");
  for (const char* const nowhere :
       {"/v1/scenes/hall/meshes", "/v1/scenes/hall/meshes/", "/v1/scenes/hall/meshes/a/b",
        "/v1/scenes//meshes/a", "/v1/scenes/hall/mesh/a"}) {
    EXPECT_EQ(client_->get(nowhere).code, 404) << nowhere;
  }
}

TEST_F(ViewDoor, SaysWhichMethodAPlaceTakes) {
  open();
  const Reached got = client_->get("/v1/scenes/hall/objects/crate");
  EXPECT_EQ(got.code, 405);
  EXPECT_EQ(got.header("Allow"), "PATCH, DELETE");
}

TEST_F(ViewDoor, AReadOnlyDoorRefusesChanges) {
  open({}, /*is_read_only=*/true);
  const Reached got = client_->send("DELETE", "/v1/scenes/hall/objects/crate");
  EXPECT_EQ(got.code, 403);
  EXPECT_THAT(error_of(got), HasSubstr("--read-only"));
  // The rule comes first: whether the change could be read does not count.
  for (const char* const body :
       {"{", "[]", R"({"form": {"type": "cone"}})", R"({"position": 1})"}) {
    EXPECT_EQ(client_->post("/v1/scenes/hall/objects", body).code, 403) << body;
    EXPECT_EQ(client_->send("PATCH", "/v1/scenes/hall/objects/crate", body).code, 403) << body;
  }
  EXPECT_TRUE(backend_.orders().empty());
  EXPECT_EQ(client_->get("/v1/status").json().at("read_only"), true);
}

TEST_F(ViewDoor, RefusesRequestsBeyondItsLimits) {
  open({.body_bytes = 1000, .requests = 1});
  EXPECT_EQ(client_->post("/v1/plan", std::string(1001, ' ')).code, 413);
  auto first =
      std::async(std::launch::async, [&] { return client_->post("/v1/plan", kSmallRequest); });
  FakeBackend::Asked asked = backend_.take();
  const Reached second = client_->post("/v1/plan", kSmallRequest);
  EXPECT_EQ(second.code, 429);
  EXPECT_THAT(error_of(second), HasSubstr("at most 1 requests"));
  asked.done({code::kOk, "{}", {}});
  EXPECT_EQ(first.get().code, 200);
  EXPECT_EQ(client_->get("/v1/status").code, 200) << "the place is free again";
}

TEST_F(ViewDoor, ClosesWhilePlansAreUnderWay) {
  open();
  auto answer = std::async(std::launch::async, [&] {
    try {
      return client_->post("/v1/plan", kSmallRequest).code;
    } catch (const beast::system_error&) {
      return 0;
    }
  });
  FakeBackend::Asked asked = backend_.take();
  door_.reset();
  backend_.wait_until_cancelled(asked);
  EXPECT_EQ(answer.get(), 0);
  asked.done({code::kOk, "{}", {}});
}

TEST_F(ViewDoor, APortThatIsTakenIsSaid) {
  open();
  const auto second = Door::open({.port = door_->port(), .token = kSecret}, backend_);
  EXPECT_FALSE(second);
  EXPECT_THAT(second.error, HasSubstr("cannot listen on 127.0.0.1 port"));
}

/// A page of three files.
const PageFiles kPage{
    {"<html>", "zipped html"}, {"script", "zipped script"}, {"style", "zipped style"}, "policy"};

TEST_F(ViewDoor, ServesThePageCompressedToThoseWhoTakeIt) {
  const auto door = Door::open({.token = kSecret, .page = kPage}, backend_);
  HttpClient client((*door)->port(), kSecret);
  struct FileCase {
    const char* target;
    const char* type;
    PageFile file;
  };
  for (const FileCase& each : {FileCase{"/", "text/html; charset=utf-8", kPage.html},
                               FileCase{"/page.js", "text/javascript; charset=utf-8", kPage.script},
                               FileCase{"/page.css", "text/css; charset=utf-8", kPage.style}}) {
    const Reached plain = client.get(each.target);
    EXPECT_EQ(plain.code, 200);
    EXPECT_EQ(plain.type, each.type);
    EXPECT_EQ(plain.body, each.file.text);
    EXPECT_EQ(plain.header("Content-Encoding"), "");
    EXPECT_EQ(plain.header("Vary"), "Accept-Encoding");
    for (const char* const takes : {"gzip", "br, gzip;q=0.5", "gzip, deflate"}) {
      const Reached packed = client.send("GET", each.target, {}, {{"Accept-Encoding", takes}});
      EXPECT_EQ(packed.body, each.file.gzip) << takes;
      EXPECT_EQ(packed.header("Content-Encoding"), "gzip") << takes;
      EXPECT_EQ(packed.type, each.type);
    }
    for (const char* const takes : {"", "br", "gzip;q=0", "deflate, gzip;q=0.0, br"}) {
      const Reached got = client.send("GET", each.target, {}, {{"Accept-Encoding", takes}});
      EXPECT_EQ(got.body, each.file.text) << takes;
    }
    const Reached head = client.send("HEAD", each.target);
    EXPECT_EQ(head.code, 200);
    EXPECT_EQ(head.header("Content-Length"), std::to_string(each.file.text.size()));
    EXPECT_EQ(client.post(each.target, "{}").code, 405);
  }
}

TEST_F(ViewDoor, ThePageMayAskTheDoorAndNobodyElse) {
  const auto door = Door::open({.token = kSecret, .page = kPage}, backend_);
  const int port = (*door)->port();
  const std::string policy = HttpClient(port, kSecret).get("/").header("Content-Security-Policy");
  EXPECT_EQ(policy,
            "default-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'; "
            "object-src 'none'; script-src 'self' 'wasm-unsafe-eval'; img-src 'self' data: blob:; "
            "connect-src 'self' ws://127.0.0.1:" +
                std::to_string(port) + " ws://localhost:" + std::to_string(port));
}

TEST_F(ViewDoor, SaysThatThereIsNoPage) {
  open();
  for (const char* const target : {"/", "/page.js", "/page.css"}) {
    const Reached got = client_->get(target);
    EXPECT_EQ(got.code, 404);
    EXPECT_THAT(error_of(got), HasSubstr("built without its page"));
  }
  EXPECT_EQ(client_->get("/plan.svg").code, 404) << "there is no path to draw";
}

}  // namespace
}  // namespace camway::view
