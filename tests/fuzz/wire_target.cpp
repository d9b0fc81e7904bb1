// SPDX-License-Identifier: MIT
#include <algorithm>
#include <optional>

#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/object_mesh.h"
#include "tests/fuzz/exercise_message.h"
#include "tests/fuzz/targets.h"
#include "tests/messages/random_messages.h"

namespace camway::testing {
namespace {

template <class... Messages>
std::vector<FuzzBytes> messages_of(int of_each) {
  Random random(kSeed);
  std::vector<FuzzBytes> all;
  for (int i = 0; i < of_each; ++i) {
    (all.push_back(wire::encode(random_message<Messages>(random))), ...);
  }
  return all;
}

std::vector<FuzzBytes> wire_seeds() {
  return messages_of<plan_request_t, plan_response_t, plan_progress_t, cancel_t, missing_pages_t,
                     map_page_t, occupancy_request_t, occupancy_response_t, scene_request_t,
                     scene_response_t, upload_page_t, upload_status_t, watch_t, watch_report_t,
                     claim_t, status_t, error_t, envelope_t, fleet_job_t, fleet_answer_t,
                     planner_status_t>(30);
}

bool exercise_sent_mesh(std::span<const std::uint8_t> bytes) {
  const std::optional<wire::ObjectMesh> mesh = wire::decode_mesh(bytes);
  if (!mesh) return false;
  for (const auto& triangle : mesh->triangles) {
    for (const std::uint32_t corner : triangle)
      promise(corner < mesh->vertices_m.size(), "corners are vertices");
  }
  promise(std::ranges::equal(wire::encode_mesh(*mesh), bytes), "a mesh has one encoding");
  return true;
}

std::vector<FuzzBytes> sent_mesh_seeds() {
  wire::ObjectMesh mesh;
  mesh.surface_error_m = 0.001;
  mesh.vertices_m = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}};
  mesh.parts = {{"desk", 2}, {"", 0}, {"lamp", 1}};
  wire::ObjectMesh none;
  none.has_inside = true;
  return {wire::encode_mesh(mesh), wire::encode_mesh(none), {}};
}

}  // namespace

constinit const FuzzTarget kWireTarget{
    "wire", [](std::span<const std::uint8_t> bytes) { return exercise_message(bytes) > 0; },
    wire_seeds, 2'000};
constinit const FuzzTarget kSentMeshTarget{"sent_mesh", exercise_sent_mesh, sent_mesh_seeds,
                                           20'000};

}  // namespace camway::testing
