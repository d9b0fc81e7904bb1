// SPDX-License-Identifier: MIT
#include <fstream>
#include <sstream>

#include "daemon/planning/plan.h"
#include "daemon/planning/request/validate.h"
#include "daemon/process/settings/config_file.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "lcmtypes/wire/pages.h"
#include "tests/fuzz/targets.h"
#include "tests/messages/plan_samples.h"
#include "tests/messages/request_on_wire.h"
#include "tools/camway/replay/session.h"
#include "tools/json/json_request.h"
#include "tools/json/json_response.h"

namespace camway::testing {
namespace {

template <class Value>
bool is_value_or_reason(const base::Result<Value>& parsed) {
  promise(parsed.value.has_value() == parsed.error.empty(), "a value or a reason");
  promise(parsed || parsed.error.starts_with("fuzzed"), "the reason names the file");
  return parsed.value.has_value();
}

bool exercise_request_json(std::span<const std::uint8_t> bytes) {
  const auto parsed = tools::parse_as<tools::RequestFile>(as_text(bytes), "fuzzed");
  if (parsed) static_cast<void>(planning::validate(*parsed));
  return is_value_or_reason(parsed);
}

bool exercise_response_json(std::span<const std::uint8_t> bytes) {
  const auto parsed = tools::parse_as<planning::PlanResult>(as_text(bytes), "fuzzed");
  if (parsed) static_cast<void>(tools::write_plan_response(*parsed));
  return is_value_or_reason(parsed);
}

bool exercise_path_json(std::span<const std::uint8_t> bytes) {
  return is_value_or_reason(tools::parse_as<tools::PathFile>(as_text(bytes), "fuzzed"));
}

constexpr char kRequest[] = R"({"scene": "a.obj", "comment": [1, {"x": null}],
  "camera": {"fov_x_deg": 80, "fov_y_deg": 60, "near": 0.15},
  "keyframes": [{"time": 0, "position": [0, 1.6, 6.1], "orientation": [1, 0, 0, 0]},
                {"time": 2.5, "position": [1e1, -0.5, 6.1], "orientation": [0.5, 0.5, -0.5, 0.5]}],
  "options": {"objective": "smoothest", "clearance_m": 0.1, "max_shrink": 0.5, "seed": 3,
    "orientation": {"policy": "target", "target": [1, 2, 3], "cone_deg": 20, "max_turn_deg": 9},
    "limits": {"speed_m_per_s": 1, "acceleration_m_per_s2": 2, "turn_rate_deg_per_s": 90,
      "retime": true}}})";
/// Old names, and an option by both of its names.
constexpr char kOldNames[] = R"({"body": {"type": "sphere", "radius": 0.5},
  "keyframes": [{"position": [0, 0, 0], "orientation": [1, 0, 0, 0]},
                {"position": [1, 0, 0], "orientation": [1, 0, 0, 0]}],
  "options": {"clearance": 0.1, "limits": {"speed": 1, "speed_m_per_s": 1, "acceleration": 2,
    "turn_rate_deg": 90}}})";
constexpr char kBodies[] = R"({"body": {"type": "convex", "pieces": [[[0, 0, 0], [1, 0, 0],
  [0, 1, 0], [0, 0, 1]], [[1, 1, 1]]]}, "keyframes": [{"position": [0, 0, 0],
  "orientation": [1, 0, 0, 0]}, {"position": [1, 0, 0], "orientation": [1, 0, 0, 0]}]})";

std::vector<FuzzBytes> request_json_seeds() {
  return {fuzz_bytes(kRequest),
          fuzz_bytes(kBodies),
          fuzz_bytes(kOldNames),
          fuzz_bytes("{}"),
          fuzz_bytes("[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[["),
          fuzz_bytes("{\"a\": 1e999, \"a\": 1}")};
}

/// Returns the plan of a request with a straight path in an empty scene.
planning::PlanResult planned(const planning::PlanRequest& request) {
  static const auto empty = scene::assemble("room", 1, {}, {});
  return planning::plan(*empty, request);
}

std::vector<FuzzBytes> response_json_seeds() {
  const auto request = tools::parse_as<tools::RequestFile>(kRequest, "seed");
  return {fuzz_bytes(*tools::write_plan_response(planned(*request))),
          fuzz_bytes(R"({"status": "invalid", "message": "scene: is missing"})")};
}

bool exercise_session(std::span<const std::uint8_t> bytes) {
  const MemoryFile file(bytes);
  const tools::Session session = tools::read_session(file.path(), "CAMWAY");
  promise(session.log.bytes == bytes.size() && session.log.bytes_used <= bytes.size(),
          "it read no more than there is");
  promise(session.log.damage.empty() == (session.log.bytes_used == bytes.size()),
          "a log is good to its end, or it is said where it is not");
  return session.log.damage.empty();
}

void append_big_endian(std::uint64_t value, int count, FuzzBytes& bytes) {
  for (int shift = 8 * (count - 1); shift >= 0; shift -= 8) {
    bytes.push_back(static_cast<std::uint8_t>(value >> shift));
  }
}

void append_event(std::string_view channel, const FuzzBytes& message, FuzzBytes& log) {
  append_big_endian(0xEDA1DA01, 4, log);
  append_big_endian(0, 8, log);
  append_big_endian(1'700'000'000'000'000, 8, log);
  append_big_endian(channel.size(), 4, log);
  append_big_endian(message.size(), 4, log);
  log.insert(log.end(), channel.begin(), channel.end());
  log.insert(log.end(), message.begin(), message.end());
}

std::vector<FuzzBytes> session_seeds() {
  Random random(kSeed);
  FuzzBytes log;
  for (std::int64_t id = 1; id <= 3; ++id) {
    const planning::PlanRequest request = *tools::parse_as<tools::RequestFile>(kRequest, "seed");
    const messages::AnswerHeader header{{"tester", id, 0}, request.scene, 1, ""};
    for (const FuzzBytes& page : wire::encode_pages(messages::to_wire(request, header.ids))) {
      append_event("CAMWAY_PLAN_REQUEST", page, log);
    }
    for (const FuzzBytes& page : wire::encode_pages(messages::to_wire(planned(request), header))) {
      append_event("CAMWAY_PLAN_RESPONSE_tester", page, log);
    }
    append_event("OTHER", {1, 2, 3}, log);
  }
  return {log, {}};
}

bool exercise_config(std::span<const std::uint8_t> bytes) {
  const MemoryFile file(bytes);
  process::DaemonOptions options = process::default_options();
  const std::vector<std::string> faults = process::read_config_file(file.path(), options);
  for (const std::string& fault : faults) {
    promise(fault.starts_with(file.path()), "a fault names the file");
  }
  return faults.empty();
}

std::vector<FuzzBytes> config_seeds() {
  std::ostringstream sample;
  sample << std::ifstream(CAMWAYD_SAMPLE_CONFIG).rdbuf();
  return {fuzz_bytes(sample.str()),
          fuzz_bytes("[queue]\nrequests = 7\n[log]\nlevel = \"warn\"\n[[scene]]\nname = \"a\"\n"
                     "file = \"a.obj\"\nscale = 0.0254\nup = \"z-to-y\"\nwatch = true\n"),
          fuzz_bytes("a = [[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[["),
          fuzz_bytes("[a]\n[a]\n= 1979-05-27")};
}

}  // namespace

constinit const FuzzTarget kRequestJsonTarget{"request_json", exercise_request_json,
                                              request_json_seeds, 20'000};
constinit const FuzzTarget kResponseJsonTarget{"response_json", exercise_response_json,
                                               response_json_seeds, 5'000};
constinit const FuzzTarget kPathJsonTarget{"path_json", exercise_path_json, response_json_seeds,
                                           5'000};
constinit const FuzzTarget kSessionTarget{"session", exercise_session, session_seeds, 3'000};
constinit const FuzzTarget kConfigTarget{"config", exercise_config, config_seeds, 2'000};

}  // namespace camway::testing
