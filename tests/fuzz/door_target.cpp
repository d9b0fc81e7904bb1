// SPDX-License-Identifier: MIT
#include <string>
#include <variant>

#include "tests/fuzz/targets.h"
#include "tools/view/orders.h"
#include "tools/view/review/review.h"

namespace camway::testing {
namespace {

bool exercise_door_message(std::span<const std::uint8_t> bytes) {
  const std::string_view text = as_text(bytes);
  const auto read = view::read_message(text);
  const auto* const bad = std::get_if<view::BadMessage>(&read);
  promise(bad == nullptr || !bad->error.empty(), "what cannot be read has a reason");
  if (const auto* const message = std::get_if<view::Message>(&read)) {
    promise(message->id >= 0, "ids are not negative");
  }
  // Bodies of HTTP have readers of their own for the same objects.
  const auto document = tools::parse_document(text, "fuzzed");
  if (document) {
    promise(
        view::read_plan(*document).value.has_value() || !view::read_plan(*document).error.empty(),
        "a plan or a reason");
    static_cast<void>(view::read_check_document(*document));
    static_cast<void>(view::read_added(*document));
    static_cast<void>(view::read_moved(*document));
    static_cast<void>(view::read_review(*document));
    const auto triangles = view::read_triangles(*document);
    promise(!triangles || triangles->indices.size() <= view::kMostIndices, "few triangles");
  }
  return bad == nullptr;
}

std::vector<FuzzBytes> door_message_seeds() {
  const std::string request =
      R"({"scene": "../a.obj", "camera": {"fov_x_deg": 70, "fov_y_deg": 50, "near": 0.1},
          "keyframes": [{"position": [0, 0, 0], "orientation": [1, 0, 0, 0]},
                        {"position": [1, 0, 0], "orientation_xyzw": [0, 0, 0, 1]}],
          "options": {"clearance_m": 0.1}})";
  const std::string pose = R"("position": [1, 2, 3], "orientation": [1, 0, 0, 0])";
  std::vector<FuzzBytes> seeds;
  for (
      const std::string& seed : {
          R"({"id": 1, "do": "plan", "progress": true, "drag": "a", "request": )" + request + "}",
          R"({"id": 1, "do": "check", "path": {"segments": []}, "request": )" + request + "}",
          std::string(R"({"id": 1, "do": "cancel"})"),
          R"({"id": 1, "do": "watch", "request": )" + request + "}",
          R"({"id": 1, "do": "scene.add", "scene": "a", "object": "b", "form":
               {"type": "mesh", "base64": "dgo=", "format": "obj", "scale": 2, "up": "z-to-y"}, )" +
              pose + "}",
          R"({"id": 1, "do": "scene.move", "object": "b", )" + pose + "}",
          R"({"name": "b", "form": {"type": "cylinder", "radius_m": 1, "height_m": 2,
               "chord_error_m": 0.1}, )" +
              pose + "}",
          R"({"id": 1, "do": "interpolate", "request": )" + request + "}",
          std::string(R"({"id": 1, "do": "triangles", "scene": "a", "indices": [0, -1, 70000]})"),
          std::string(R"({"indices": [1, 2, 9007199254740992]})"),
          R"({"answer": {"status": "ok", "message": "", "segments": [], "keyframes": []}, "request": )" +
              request + "}",
          std::string(R"({"id": 1, "do": "fields"})"),
          std::string(R"({"id": 1, "do": "last"})"),
          request,
      }) {
    seeds.push_back(fuzz_bytes(seed));
  }
  return seeds;
}

}  // namespace

constinit const FuzzTarget kDoorMessageTarget{"door_message", exercise_door_message,
                                              door_message_seeds, 10'000};

}  // namespace camway::testing
