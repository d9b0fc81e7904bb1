// SPDX-License-Identifier: MIT
#include <camway/authentication.h>
#include <camway/camway.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "client/c/sized.h"
#include "tests/client/c/c_client.h"
#include "tests/client/client_fixture.h"

namespace camway {
namespace {

using ::testing::HasSubstr;
using testing_support::CClient;
using testing_support::CRequest;

using CMisuseTest = testing_support::ClientTest;

void ignore_event(void*, const camway_watch_event*) {}

/// A queue that lives as long as the process.
camway_event_queue* queue_of_events() {
  static camway_event_queue* const queue = [] {
    camway_event_queue* made = nullptr;
    EXPECT_EQ(camway_event_queue_create(&made), CAMWAY_OK);
    return made;
  }();
  return queue;
}

/// Calls of every function that takes a handle of a client, which is not live.
std::vector<std::pair<std::string, std::function<camway_status(camway_client*)>>> client_calls() {
  static const double xyz[3] = {1, 1, 1};
  static const double one[1] = {1};
  static double distance[1];
  static std::uint8_t occupied[1];
  static camway_answer* answer;
  static camway_pending* pending;
  static std::int64_t watch;
  static camway_daemon_status status;
  static const CRequest request;
  static camway_scan_map map;
  camway_scan_map_init(&map, sizeof map);
  static camway_mesh_file mesh;
  camway_mesh_file_init(&mesh, sizeof mesh);
  mesh.file = "a.obj";
  using C = camway_client*;
  return {
      {"plan", [](C c) { return camway_plan(c, &request, 1.0, &answer); }},
      {"start", [](C c) { return camway_plan_start(c, &request, nullptr, &pending); }},
      {"watch", [](C c) { return camway_watch_start(c, &request, ignore_event, nullptr, &watch); }},
      {"poll",
       [](C c) { return camway_watch_start_polled(c, &request, queue_of_events(), &watch); }},
      {"unwatch", [](C c) { return camway_watch_end(c, 1, 0.1); }},
      {"take", [](C c) { return camway_watch_take_better(c, 1); }},
      {"status", [](C c) { return camway_daemon_status_get(c, 0.1, &status, sizeof status); }},
      {"list", [](C c) { return camway_scene_list(c, nullptr); }},
      {"describe", [](C c) { return camway_scene_describe(c, "s", nullptr); }},
      {"load", [](C c) { return camway_scene_load(c, "s", nullptr, 0.0, nullptr); }},
      {"unload", [](C c) { return camway_scene_unload(c, "s", nullptr); }},
      {"box", [](C c) { return camway_scene_put_box(c, "s", "o", xyz, nullptr, nullptr); }},
      {"sphere", [](C c) { return camway_scene_put_sphere(c, "s", "o", 1, nullptr, nullptr); }},
      {"cylinder",
       [](C c) { return camway_scene_put_cylinder(c, "s", "o", 1, 1, nullptr, nullptr); }},
      {"file", [](C c) { return camway_scene_put_file(c, "s", "o", &mesh, nullptr, nullptr); }},
      {"triangles",
       [](C c) {
         return camway_scene_put_triangles(c, "s", "o", xyz, 1, nullptr, 0, nullptr, nullptr);
       }},
      {"move", [](C c) { return camway_scene_move(c, "s", "o", nullptr, nullptr); }},
      {"remove", [](C c) { return camway_scene_remove(c, "s", "o", nullptr); }},
      {"history", [](C c) { return camway_scene_history(c, "s", nullptr); }},
      {"restore", [](C c) { return camway_scene_restore(c, "s", 1, nullptr, nullptr); }},
      {"put map",
       [](C c) { return camway_scene_put_scan_map(c, "s", "o", &map, nullptr, nullptr); }},
      {"scan", [](C c) { return camway_scene_insert_scan(c, "s", "o", xyz, 1, xyz, nullptr); }},
      {"put points",
       [](C c) { return camway_scene_put_points(c, "s", "o", xyz, 1, 0.1, nullptr, nullptr); }},
      {"export", [](C c) { return camway_scene_export_map(c, "s", "f.bt", nullptr); }},
      {"cancel", [](C c) { return camway_scene_cancel_calls(c); }},
      {"points", [](C c) { return camway_occupancy_points(c, "s", xyz, 1, occupied); }},
      {"spheres", [](C c) { return camway_occupancy_spheres(c, "s", xyz, one, 1, occupied); }},
      {"boxes", [](C c) { return camway_occupancy_boxes(c, "s", xyz, xyz, 1, occupied); }},
      {"rays", [](C c) { return camway_occupancy_rays(c, "s", xyz, xyz, one, 1, distance); }},
      {"distances", [](C c) { return camway_occupancy_distances(c, "s", xyz, one, 1, distance); }},
      {"moves", [](C c) { return camway_occupancy_moves(c, "s", xyz, xyz, one, 1, distance); }},
  };
}

TEST_F(CMisuseTest, AClientThatIsNoneIsRefusedByEveryFunction) {
  CClient live;
  camway_client* const freed = live.get();
  EXPECT_EQ(camway_client_free(freed), CAMWAY_OK);
  for (camway_client* const none : {static_cast<camway_client*>(nullptr), freed}) {
    for (const auto& [name, call] : client_calls()) {
      EXPECT_EQ(call(none), CAMWAY_BAD_ARGUMENT) << name;
      EXPECT_THAT(camway_last_error(), HasSubstr(none == nullptr ? "NULL" : "freed")) << name;
    }
    EXPECT_EQ(camway_client_id(none), nullptr);
  }
  EXPECT_EQ(camway_client_free(freed), CAMWAY_BAD_ARGUMENT);
}

/// Calls of every function that takes a handle of an answer.
template <class Check>
void for_each_answer_call(const camway_answer* answer, const Check& check) {
  const double times_s[1] = {0.0};
  double positions_m[3];
  std::size_t count = 0;
  camway_answer* copy = nullptr;
  camway_answer_summary summary;
  check(camway_answer_copy(answer, &copy));
  check(camway_answer_summarize(answer, &summary, sizeof summary));
  check(camway_answer_poses(answer, times_s, 1, positions_m, nullptr));
  check(camway_answer_segments(answer, nullptr, 0, &count));
  check(camway_answer_keyframes(answer, nullptr, 0, &count));
  check(camway_answer_collisions(answer, nullptr, 0, &count));
  check(camway_answer_remaining(answer, nullptr, 0, &count));
  check(camway_answer_keyframe_faults(answer, nullptr, 0, &count));
  check(camway_answer_corrections(answer, nullptr, 0, &count));
  camway_path_measures measures;
  check(camway_answer_measures(answer, &measures, sizeof measures));
  check(camway_answer_measures_before(answer, &measures, sizeof measures));
  camway_plan_timing timing;
  check(camway_answer_timing(answer, &timing, sizeof timing));
  check(camway_answer_slowed(answer, nullptr, 0, &count));
  check(camway_answer_bounds(answer, positions_m, positions_m));
  camway_path_frame frame;
  check(camway_answer_frame(answer, &frame));
  check(camway_answer_images(answer, nullptr, 0, &count));
  camway_infeasibility infeasibility;
  check(camway_answer_infeasibility(answer, &infeasibility, sizeof infeasibility));
  check(camway_answer_proof_triangles(answer, nullptr, 0, &count));
  check(camway_answer_error(answer) == nullptr ? CAMWAY_BAD_ARGUMENT : CAMWAY_OK);
  check(camway_answer_message(answer) == nullptr ? CAMWAY_BAD_ARGUMENT : CAMWAY_OK);
}

TEST_F(CMisuseTest, HandlesOfAnotherKindAreRefused) {
  CClient client;
  void* const other = client.get();
  for (void* const none : {static_cast<void*>(nullptr), other}) {
    for_each_answer_call(static_cast<camway_answer*>(none),
                         [](camway_status status) { EXPECT_EQ(status, CAMWAY_BAD_ARGUMENT); });
    auto* const pending = static_cast<camway_pending*>(none);
    camway_progress progress;
    EXPECT_EQ(camway_pending_wait(pending, 0.0, nullptr), CAMWAY_BAD_ARGUMENT);
    EXPECT_EQ(camway_pending_cancel(pending), CAMWAY_BAD_ARGUMENT);
    EXPECT_EQ(camway_pending_progress(pending, &progress, sizeof progress), CAMWAY_BAD_ARGUMENT);
    auto* const scene = static_cast<camway_scene_answer*>(none);
    std::size_t count = 0;
    camway_scene_info info;
    camway_object_info object;
    EXPECT_EQ(camway_scene_answer_scene(scene, &info, sizeof info), CAMWAY_BAD_ARGUMENT);
    EXPECT_EQ(camway_scene_answer_scene_at(scene, 0, &info, sizeof info), CAMWAY_BAD_ARGUMENT);
    EXPECT_EQ(camway_scene_answer_object_at(scene, 0, &object, sizeof object), CAMWAY_BAD_ARGUMENT);
    EXPECT_EQ(camway_scene_answer_num_scenes(scene, &count), CAMWAY_BAD_ARGUMENT);
    EXPECT_EQ(camway_scene_answer_num_objects(scene, &count), CAMWAY_BAD_ARGUMENT);
    EXPECT_EQ(camway_scene_answer_message(scene), nullptr);
    camway_scene_revision revision;
    EXPECT_EQ(camway_scene_answer_num_revisions(scene, &count), CAMWAY_BAD_ARGUMENT);
    EXPECT_EQ(camway_scene_answer_revision_at(scene, 0, &revision, sizeof revision),
              CAMWAY_BAD_ARGUMENT);
    auto* const queue = static_cast<camway_event_queue*>(none);
    camway_watch_event event;
    EXPECT_EQ(camway_event_queue_next(queue, 0.0, &event, sizeof event), CAMWAY_BAD_ARGUMENT);
    const camway_status freed = none == nullptr ? CAMWAY_OK : CAMWAY_BAD_ARGUMENT;
    EXPECT_EQ(camway_answer_free(static_cast<camway_answer*>(none)), freed);
    EXPECT_EQ(camway_pending_free(pending), freed);
    EXPECT_EQ(camway_scene_answer_free(scene), freed);
    EXPECT_EQ(camway_event_queue_free(queue), freed);
  }
  EXPECT_EQ(camway_client_free(nullptr), CAMWAY_OK);
}

TEST_F(CMisuseTest, NothingIsWrittenThroughNull) {
  CClient client;
  camway_client* const c = client.get();
  const CRequest request;
  const double xyz[3] = {1, 1, 1};
  std::int64_t watch = 0;
  const std::uint32_t corners[3] = {0, 0, 1};
  EXPECT_EQ(camway_client_create(nullptr, nullptr), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_plan(c, &request, 1.0, nullptr), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_plan_start(c, &request, nullptr, nullptr), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_watch_start(c, &request, ignore_event, nullptr, nullptr), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_watch_start(c, &request, nullptr, nullptr, &watch), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_watch_start_polled(c, &request, nullptr, &watch), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_watch_start_polled(c, &request, queue_of_events(), nullptr),
            CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_event_queue_create(nullptr), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_scene_put_scan_map(c, "s", "o", nullptr, nullptr, nullptr), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_scene_insert_scan(c, "s", "o", nullptr, 1, xyz, nullptr), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_scene_insert_scan(c, "s", "o", xyz, 1, nullptr, nullptr), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_scene_put_points(c, "s", "o", nullptr, 1, 0.1, nullptr, nullptr),
            CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_scene_history(c, nullptr, nullptr), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_scene_restore(c, nullptr, 1, nullptr, nullptr), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_scene_export_map(c, "s", nullptr, nullptr), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_daemon_status_get(c, 0.0, nullptr, sizeof(camway_daemon_status)),
            CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_scene_describe(c, nullptr, nullptr), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_scene_load(c, nullptr, nullptr, 0.0, nullptr), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_scene_unload(c, nullptr, nullptr), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_scene_put_box(c, "s", "o", nullptr, nullptr, nullptr), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_scene_put_box(c, "s", nullptr, xyz, nullptr, nullptr), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_scene_put_file(c, "s", "o", nullptr, nullptr, nullptr), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_scene_put_triangles(c, "s", "o", nullptr, 1, nullptr, 0, nullptr, nullptr),
            CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_scene_put_triangles(c, "s", "o", xyz, 1, corners, 1, nullptr, nullptr),
            CAMWAY_INVALID);
  EXPECT_THAT(camway_last_error(), HasSubstr("triangles[0]: 1 is no index of 1 vertices"));
  EXPECT_EQ(camway_scene_move(c, "s", nullptr, nullptr, nullptr), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_scene_remove(c, nullptr, "o", nullptr), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_occupancy_points(c, "s", nullptr, 1, nullptr), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_occupancy_points(c, "s", xyz, 1, nullptr), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_occupancy_rays(c, "s", xyz, xyz, nullptr, 1, nullptr), CAMWAY_BAD_ARGUMENT);
}

TEST_F(CMisuseTest, ARequestThatIsWrongInFormIsNotSent) {
  CClient client;
  camway_answer* answer = nullptr;
  const auto plan = [&](const camway_plan_request& request) {
    return camway_plan(client.get(), &request, 1.0, &answer);
  };
  EXPECT_EQ(camway_plan(client.get(), nullptr, 1.0, &answer), CAMWAY_BAD_ARGUMENT);
  CRequest request;
  request.scene = nullptr;
  EXPECT_EQ(plan(request), CAMWAY_BAD_ARGUMENT);
  EXPECT_THAT(camway_last_error(), HasSubstr("scene: is NULL"));
  request.scene = "office";
  request.keyframes = nullptr;
  EXPECT_EQ(plan(request), CAMWAY_BAD_ARGUMENT);
  request.keyframes = request.given;
  for (std::int32_t* const choice : {&request.objective, &request.orientation, &request.priority}) {
    for (const int wrong : {-2, 4, 1000}) {
      *choice = wrong;
      EXPECT_EQ(plan(request), CAMWAY_INVALID) << wrong;
    }
    *choice = 0;
  }
  camway_body body;
  camway_body_init(&body, sizeof body);
  request.body = &body;
  for (const int shape : {-1, 6}) {
    body.shape = shape;
    EXPECT_EQ(plan(request), CAMWAY_INVALID);
  }
  const std::uint32_t sizes[2] = {1, 4'000'000'000u};
  const double points[6] = {};
  body.shape = CAMWAY_BODY_CONVEX;
  body.piece_sizes = sizes;
  body.vertices_m = points;
  body.num_vertices = 2;
  for (const std::size_t pieces : {std::size_t{0}, std::size_t{1}, std::size_t{2}}) {
    body.num_pieces = pieces;
    EXPECT_EQ(plan(request), CAMWAY_INVALID) << pieces;
  }
  body.shape = CAMWAY_BODY_MESH;
  body.num_triangles = 1;
  EXPECT_EQ(plan(request), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(answer, nullptr);
}

/// A struct of a program whose headers are newer than the library.
template <class Struct>
struct Longer {
  Struct known;
  unsigned char more[16];
};

template <class Struct, class Init>
void expect_checks_size(const Init& init) {
  Longer<Struct> longer;
  std::memset(&longer, 0xff, sizeof longer);
  for (const std::size_t wrong : {std::size_t{0}, std::size_t{4}, c::kFirstSize<Struct> - 1}) {
    EXPECT_EQ(init(&longer.known, wrong), CAMWAY_BAD_ARGUMENT) << wrong;
    EXPECT_THAT(camway_last_error(), HasSubstr("struct_size"));
  }
  EXPECT_EQ(init(nullptr, sizeof(Struct)), CAMWAY_BAD_ARGUMENT);
  // The struct of an older program.
  EXPECT_EQ(init(&longer.known, c::kFirstSize<Struct>), CAMWAY_OK);
  EXPECT_EQ(longer.known.struct_size, c::kFirstSize<Struct>);
  EXPECT_EQ(reinterpret_cast<const unsigned char*>(&longer)[c::kFirstSize<Struct>], 0xff)
      << "it wrote behind the struct";
  EXPECT_EQ(init(&longer.known, sizeof(Struct)), CAMWAY_OK);
  EXPECT_EQ(longer.known.struct_size, sizeof(Struct));
  EXPECT_EQ(longer.more[0], 0xff) << "it wrote behind the struct";
  EXPECT_EQ(init(&longer.known, sizeof longer), CAMWAY_OK);
  EXPECT_EQ(longer.known.struct_size, sizeof longer);
  for (const unsigned char byte : longer.more) EXPECT_EQ(byte, 0);
}

TEST(CSizes, StructsOfOtherSizesAreInitialisedAsFarAsTheyAreKnown) {
  expect_checks_size<camway_client_options>(camway_client_options_init);
  expect_checks_size<camway_plan_request>(camway_plan_request_init);
  expect_checks_size<camway_body>(camway_body_init);
  expect_checks_size<camway_plan_handlers>(camway_plan_handlers_init);
  expect_checks_size<camway_mesh_file>(camway_mesh_file_init);
  expect_checks_size<camway_scan_map>(camway_scan_map_init);
}

TEST_F(CMisuseTest, AMemberThatTheLibraryDoesNotKnowIsRefusedOnlyIfItIsSet) {
  Longer<camway_client_options> options;
  ASSERT_EQ(camway_client_options_init(&options.known, sizeof options), CAMWAY_OK);
  camway_client* client = nullptr;
  options.more[5] = 1;
  EXPECT_EQ(camway_client_create(&options.known, &client), CAMWAY_BAD_ARGUMENT);
  EXPECT_THAT(camway_last_error(), HasSubstr("older than the headers"));
  options.more[5] = 0;
  EXPECT_EQ(camway_client_create(&options.known, &client), CAMWAY_OK);
  EXPECT_EQ(camway_client_free(client), CAMWAY_OK);
  options.known.struct_size = 0;
  EXPECT_EQ(camway_client_create(&options.known, &client), CAMWAY_BAD_ARGUMENT);
  EXPECT_THAT(camway_last_error(), HasSubstr("_init"));
}

TEST_F(CMisuseTest, BadOptionsAndNetworksAreTold) {
  camway_client_options options;
  camway_client_options_init(&options, sizeof options);
  camway_client* client = nullptr;
  options.prefix = "not a prefix";
  EXPECT_EQ(camway_client_create(&options, &client), CAMWAY_INVALID);
  EXPECT_THAT(camway_last_error(), HasSubstr("prefix"));
  options.prefix = nullptr;
  options.key_file = "/nowhere/keys";
  EXPECT_EQ(camway_client_create(&options, &client), CAMWAY_INVALID);
  EXPECT_EQ(camway_last_error(), authentication_from("/nowhere/keys").error);
  options.key_file = nullptr;
  options.url = "nonsense://";
  EXPECT_EQ(camway_client_create(&options, &client), CAMWAY_NETWORK_UNUSABLE);
  EXPECT_EQ(client, nullptr);
}

TEST(CVersion, IsThatOfTheHeaders) {
  EXPECT_EQ(camway_abi_version(), CAMWAY_ABI_VERSION);
  EXPECT_THAT(camway_version(), ::testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
}

TEST(CVersion, StatusesHaveNamesThatStay) {
  const char* const first = camway_status_name(CAMWAY_OK);
  EXPECT_STREQ(camway_status_name(CAMWAY_NO_DAEMON), "no_daemon");
  EXPECT_STREQ(first, "ok");
  EXPECT_STREQ(camway_status_name(CAMWAY_NOT_READY), "not_ready");
  for (const int none : {-1, 50, 199, 203, 1 << 30})
    EXPECT_STREQ(camway_status_name(none), "unknown");
}

}  // namespace
}  // namespace camway
