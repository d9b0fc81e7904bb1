// SPDX-License-Identifier: MIT
#include "tests/messages/random_messages.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <string>
#include <vector>

#include "lcmtypes/wire/channels.h"
#include "lcmtypes/wire/layout.h"

namespace camway::testing {
namespace {

double number(Random& random) { return std::bit_cast<double>(random()); }

std::int64_t integer(Random& random) { return static_cast<std::int64_t>(random()); }

std::int32_t small(Random& random) { return static_cast<std::int32_t>(random()); }

std::string text(Random& random, std::size_t max_length) {
  std::string text(below(random, max_length + 1), ' ');
  for (char& c : text) c = static_cast<char>(1 + below(random, 255));
  return text;
}

std::string client_id(Random& random) {
  constexpr std::string_view kAlphabet =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  std::string id(1 + below(random, wire::kMaxClientIdLength), ' ');
  for (char& c : id) c = kAlphabet[below(random, kAlphabet.size())];
  return id;
}

/// Returns the length of a list, mostly a short one and sometimes a long one.
std::size_t length(Random& random, std::size_t longest) {
  const std::size_t most = below(random, 8) == 0 ? longest : std::min<std::size_t>(longest, 4);
  return below(random, most + 1);
}

template <std::size_t n>
void fill(double (&numbers)[n], Random& random) {
  for (double& value : numbers) value = number(random);
}

keyframe_t keyframe(Random& random) {
  keyframe_t keyframe{};
  keyframe.time_s = number(random);
  fill(keyframe.position_m, random);
  fill(keyframe.orientation_wxyz, random);
  keyframe.origin = static_cast<std::int8_t>(random());
  return keyframe;
}

segment_t segment(Random& random) {
  segment_t segment{};
  segment.t0_s = number(random);
  segment.t1_s = number(random);
  for (auto& point : segment.position_m) fill(point, random);
  for (auto& point : segment.orientation_wxyz) fill(point, random);
  return segment;
}

collision_interval_t interval(Random& random) {
  collision_interval_t interval{};
  interval.t_begin_s = number(random);
  interval.t_end_s = number(random);
  interval.has_witness = static_cast<std::int8_t>(random());
  interval.witness_time_s = number(random);
  interval.witness_object = text(random, wire::kMaxObjectNameBytes);
  interval.witness_triangle = small(random);
  interval.witness_feature = text(random, wire::kMaxFeatureBytes);
  interval.witness_depth_m = number(random);
  fill(interval.witness_point_m, random);
  return interval;
}

orientation_t orientation(Random& random) {
  orientation_t orientation{};
  orientation.policy = static_cast<std::int8_t>(below(random, 6));
  fill(orientation.up, random);
  fill(orientation.target_m, random);
  orientation.cone_rad = number(random);
  orientation.has_max_turn = static_cast<std::int8_t>(random());
  orientation.max_turn_rad = number(random);
  return orientation;
}

motion_limits_t limits(Random& random) {
  motion_limits_t limits{};
  limits.speed_m_per_s = number(random);
  limits.acceleration_m_per_s2 = number(random);
  limits.turn_rate_rad_per_s = number(random);
  limits.may_retime = static_cast<std::int8_t>(random());
  return limits;
}

bounds_t bounds(Random& random) {
  bounds_t bounds{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    bounds.has_min[axis] = static_cast<std::int8_t>(random());
    bounds.has_max[axis] = static_cast<std::int8_t>(random());
  }
  fill(bounds.min_m, random);
  fill(bounds.max_m, random);
  return bounds;
}

path_measures_t measures(Random& random) {
  path_measures_t measures{};
  for (double* value :
       {&measures.length_m, &measures.largest_deviation_m, &measures.bending_energy_m2_per_s3,
        &measures.largest_speed_m_per_s, &measures.largest_acceleration_m_per_s2,
        &measures.largest_turn_rate_rad_per_s, &measures.largest_turn_acceleration_rad_per_s2}) {
    *value = number(random);
  }
  return measures;
}

correction_t correction(Random& random) {
  correction_t correction{};
  correction.method = static_cast<std::int8_t>(below(random, 7));
  for (double* value : {&correction.t_begin_s, &correction.t_end_s, &correction.changed_t_begin_s,
                        &correction.changed_t_end_s, &correction.moved_m, &correction.turned_rad}) {
    *value = number(random);
  }
  return correction;
}

cage_t cage(Random& random) {
  cage_t cage{};
  fill(cage.orientation_wxyz, random);
  fill(cage.min_m, random);
  fill(cage.max_m, random);
  cage.widest_hole_m = number(random);
  cage.shortest_chord_m = number(random);
  return cage;
}

slowed_stretch_t slowed_stretch(Random& random) {
  slowed_stretch_t stretch{};
  for (double* value :
       {&stretch.t_begin_s, &stretch.t_end_s, &stretch.given_t_begin_s, &stretch.given_t_end_s}) {
    *value = number(random);
  }
  return stretch;
}

keyframe_fault_t keyframe_fault(Random& random) {
  keyframe_fault_t fault{};
  fault.keyframe = small(random);
  fault.depth_m = number(random);
  fault.has_free_pose = static_cast<std::int8_t>(random());
  fill(fault.free_position_m, random);
  fill(fault.free_orientation_wxyz, random);
  return fault;
}

template <class Element, class Make>
std::int32_t fill_list(std::vector<Element>& list, std::size_t count, const Make& make) {
  std::generate_n(std::back_inserter(list), count, make);
  return static_cast<std::int32_t>(count);
}

std::int32_t fill_rows(std::vector<std::vector<double>>& rows, std::size_t width, Random& random) {
  return fill_list(rows, length(random, 200), [&] {
    std::vector<double> row(width);
    std::generate(row.begin(), row.end(), [&] { return number(random); });
    return row;
  });
}

body_t body(Random& random) {
  body_t body{};
  body.type = static_cast<std::int8_t>(below(random, 7));
  fill(body.center_m, random);
  fill(body.size_m, random);
  body.radius_m = number(random);
  body.num_points = fill_rows(body.points_m, 3, random);
  // In half of them, the pieces have as many points as there are.
  const bool fits = below(random, 2) == 0;
  body.num_pieces = fill_list(body.piece_sizes, fits ? 1 : length(random, 20),
                              [&] { return fits ? body.num_points : small(random); });
  body.num_triangles = fill_list(body.triangles, length(random, 50), [&] {
    const auto index = [&] { return static_cast<std::int32_t>(below(random, 300)) - 1; };
    return std::vector<std::int32_t>{index(), index(), index()};
  });
  return body;
}

scene_info_t scene_info(Random& random) {
  scene_info_t info{};
  info.name = text(random, wire::kMaxSceneNameBytes);
  info.revision = integer(random);
  info.digest = text(random, wire::kMaxDigestBytes);
  info.num_triangles = integer(random);
  fill(info.bounds_min_m, random);
  fill(info.bounds_max_m, random);
  info.body_bounds = bounds(random);
  info.occupancy_resolution_m = number(random);
  return info;
}

scene_object_t scene_object(Random& random) {
  scene_object_t object{};
  object.name = text(random, wire::kMaxObjectNameBytes);
  object.kind = text(random, wire::kMaxKindBytes);
  object.digest = text(random, wire::kMaxDigestBytes);
  object.num_triangles = integer(random);
  fill(object.position_m, random);
  fill(object.orientation_wxyz, random);
  fill(object.bounds_min_m, random);
  fill(object.bounds_max_m, random);
  return object;
}

scene_change_t scene_change(Random& random) {
  scene_change_t change{};
  change.revision = integer(random);
  change.utime = integer(random);
  change.operation = text(random, wire::kMaxOperationBytes);
  change.object = text(random, wire::kMaxObjectNameBytes);
  change.client_id = client_id(random);
  change.restored_revision = integer(random);
  return change;
}

}  // namespace

std::size_t below(Random& random, std::size_t below) { return random() % below; }

template <>
plan_request_t random_message<plan_request_t>(Random& random) {
  plan_request_t message{};
  message.client_id = client_id(random);
  message.request_id = integer(random);
  message.utime = integer(random);
  message.page = small(random);
  message.num_pages = small(random);
  message.scene = text(random, wire::kMaxSceneNameBytes);
  message.camera.fov_x_rad = number(random);
  message.camera.fov_y_rad = number(random);
  message.camera.near_m = number(random);
  message.body = body(random);
  message.method = text(random, wire::kMaxMethodBytes);
  message.priority = static_cast<std::int8_t>(random());
  message.deadline_s = number(random);
  message.progress_period_s = number(random);
  message.watch_lease_s = number(random);
  message.chord_error_m = number(random);
  message.interval_tolerance_m = number(random);
  message.clearance_m = number(random);
  message.max_inserted_keyframes = small(random);
  message.correct_nothing = static_cast<std::int8_t>(random());
  message.objective = static_cast<std::int8_t>(below(random, 6));
  message.orientation = orientation(random);
  message.limits = limits(random);
  message.bounds = bounds(random);
  message.max_shrink = number(random);
  message.repair_keyframes = static_cast<std::int8_t>(random());
  message.seed = integer(random);
  message.has_times = static_cast<std::int8_t>(random());
  message.default_speed_m_per_s = number(random);
  message.num_keyframes =
      fill_list(message.keyframes, length(random, 700), [&] { return keyframe(random); });
  return message;
}

template <>
cancel_t random_message<cancel_t>(Random& random) {
  cancel_t message{};
  message.client_id = client_id(random);
  message.request_id = integer(random);
  message.utime = integer(random);
  return message;
}

template <>
plan_progress_t random_message<plan_progress_t>(Random& random) {
  plan_progress_t message{};
  message.client_id = client_id(random);
  message.request_id = integer(random);
  message.utime = integer(random);
  message.stage = static_cast<std::int8_t>(below(random, 6));
  message.requests_ahead = small(random);
  message.num_collisions = small(random);
  message.num_corrected = small(random);
  message.since_receipt_s = number(random);
  message.deadline_s = number(random);
  return message;
}

template <>
missing_pages_t random_message<missing_pages_t>(Random& random) {
  missing_pages_t message{};
  message.client_id = client_id(random);
  message.request_id = integer(random);
  message.utime = integer(random);
  message.num_pages = small(random);
  message.num_missing =
      fill_list(message.missing, length(random, 1024), [&] { return small(random); });
  return message;
}

template <>
map_page_t random_message<map_page_t>(Random& random) {
  map_page_t message{};
  message.client_id = client_id(random);
  message.request_id = integer(random);
  message.status = small(random);
  message.message = text(random, wire::kMaxTextBytes);
  message.page = small(random);
  message.num_pages = small(random);
  message.page_checksum = integer(random);
  message.num_bytes = fill_list(message.bytes, length(random, 40'000),
                                [&] { return static_cast<std::uint8_t>(random()); });
  return message;
}

template <>
plan_response_t random_message<plan_response_t>(Random& random) {
  plan_response_t message{};
  message.client_id = client_id(random);
  message.request_id = integer(random);
  message.utime = integer(random);
  message.page = small(random);
  message.num_pages = small(random);
  message.status = small(random);
  // Half of them pass the first check and reach the lists.
  if (below(random, 2) == 0) {
    message.page = 0;
    message.num_pages = 1;
    message.status = static_cast<std::int32_t>(below(random, 9));
  }
  message.message = text(random, wire::kMaxTextBytes);
  message.keyframe = small(random);
  message.scene = text(random, wire::kMaxSceneNameBytes);
  message.scene_revision = integer(random);
  message.scene_digest = text(random, wire::kMaxDigestBytes);
  message.certified = static_cast<std::int8_t>(random());
  for (double* value : {&message.clearance_lower_bound_m, &message.motion_ms, &message.detect_ms,
                        &message.correct_ms, &message.certify_ms, &message.total_ms}) {
    *value = number(random);
  }
  message.num_segments =
      fill_list(message.segments, length(random, 100), [&] { return segment(random); });
  message.num_keyframes =
      fill_list(message.keyframes, length(random, 100), [&] { return keyframe(random); });
  message.num_collisions =
      fill_list(message.collisions, length(random, 100), [&] { return interval(random); });
  message.num_remaining =
      fill_list(message.remaining, length(random, 100), [&] { return interval(random); });
  message.bounds = bounds(random);
  message.near_scale = number(random);
  message.time_scale = number(random);
  message.deadline_reached = static_cast<std::int8_t>(random());
  message.has_measures_before = static_cast<std::int8_t>(random());
  message.measures_before = measures(random);
  message.has_measures = static_cast<std::int8_t>(random());
  message.measures = measures(random);
  message.has_infeasibility = static_cast<std::int8_t>(random());
  message.keyframe_inside = small(random);
  message.keyframe_outside = small(random);
  message.has_cage = static_cast<std::int8_t>(random());
  message.proof_cage = cage(random);
  message.num_corrections =
      fill_list(message.corrections, length(random, 100), [&] { return correction(random); });
  message.num_slowed =
      fill_list(message.slowed, length(random, 100), [&] { return slowed_stretch(random); });
  message.num_keyframe_faults = fill_list(message.keyframe_faults, length(random, 100),
                                          [&] { return keyframe_fault(random); });
  message.num_proof_triangles =
      fill_list(message.proof_triangles, length(random, 1000), [&] { return small(random); });
  return message;
}

template <>
occupancy_request_t random_message<occupancy_request_t>(Random& random) {
  occupancy_request_t message{};
  message.client_id = client_id(random);
  message.request_id = integer(random);
  message.utime = integer(random);
  message.scene = text(random, wire::kMaxSceneNameBytes);
  message.deadline_s = number(random);
  message.num_points = fill_rows(message.points_m, 3, random);
  message.num_boxes = fill_rows(message.boxes_m, 6, random);
  message.num_spheres = fill_rows(message.spheres_m, 4, random);
  message.num_rays = fill_rows(message.rays_m, 7, random);
  message.num_distances = fill_rows(message.distances_m, 4, random);
  message.num_sphere_paths = fill_rows(message.sphere_paths_m, 7, random);
  return message;
}

template <>
occupancy_response_t random_message<occupancy_response_t>(Random& random) {
  occupancy_response_t message{};
  message.client_id = client_id(random);
  message.request_id = integer(random);
  message.utime = integer(random);
  message.status = small(random);
  message.message = text(random, wire::kMaxTextBytes);
  message.scene = text(random, wire::kMaxSceneNameBytes);
  message.scene_revision = integer(random);
  message.resolution_m = number(random);
  const auto flag = [&] { return static_cast<std::int8_t>(random()); };
  const auto distance = [&] { return number(random); };
  message.num_points = fill_list(message.points_occupied, length(random, 2000), flag);
  message.num_boxes = fill_list(message.boxes_occupied, length(random, 2000), flag);
  message.num_spheres = fill_list(message.spheres_occupied, length(random, 2000), flag);
  message.num_rays = fill_list(message.rays_hit_m, length(random, 2000), distance);
  message.num_distances = fill_list(message.distances_m, length(random, 1000), distance);
  message.num_sphere_paths = fill_list(message.sphere_paths_hit_m, length(random, 1000), distance);
  return message;
}

template <>
scene_request_t random_message<scene_request_t>(Random& random) {
  scene_request_t message{};
  message.client_id = client_id(random);
  message.request_id = integer(random);
  message.utime = integer(random);
  message.operation = static_cast<std::int8_t>(below(random, 13));
  message.scene = text(random, wire::kMaxSceneNameBytes);
  message.object = text(random, wire::kMaxObjectNameBytes);
  message.file = text(random, wire::kMaxFileNameBytes);
  message.upload_bytes = integer(random);
  message.upload_checksum = integer(random);
  message.upload_format = text(random, wire::kMaxFormatBytes);
  message.scale = number(random);
  message.up = static_cast<std::int8_t>(below(random, 4));
  message.unknown = static_cast<std::int8_t>(below(random, 3));
  message.body_bounds = bounds(random);
  message.occupancy_resolution_m = number(random);
  message.kind = static_cast<std::int8_t>(below(random, 7));
  fill(message.size_m, random);
  message.radius_m = number(random);
  message.height_m = number(random);
  message.chord_error_m = number(random);
  message.cell_m = number(random);
  message.hit_probability = number(random);
  message.miss_probability = number(random);
  message.least_probability = number(random);
  message.most_probability = number(random);
  message.max_range_m = number(random);
  fill(message.position_m, random);
  fill(message.orientation_wxyz, random);
  message.first = small(random);
  message.revision = below(random, 2) == 0 ? small(random) : integer(random);
  message.restore_as = text(random, wire::kMaxSceneNameBytes);
  message.deadline_s = number(random);
  return message;
}

template <>
scene_response_t random_message<scene_response_t>(Random& random) {
  scene_response_t message{};
  message.client_id = client_id(random);
  message.request_id = integer(random);
  message.utime = integer(random);
  message.status = static_cast<std::int32_t>(below(random, 12));
  message.message = text(random, wire::kMaxTextBytes);
  message.scene = scene_info(random);
  message.first = small(random);
  message.total = small(random);
  message.map_bytes = integer(random);
  message.map_checksum = integer(random);
  message.num_scenes =
      fill_list(message.scenes, length(random, 80), [&] { return scene_info(random); });
  message.num_objects =
      fill_list(message.objects, length(random, 80), [&] { return scene_object(random); });
  message.num_changes =
      fill_list(message.changes, length(random, 80), [&] { return scene_change(random); });
  return message;
}

template <>
upload_page_t random_message<upload_page_t>(Random& random) {
  upload_page_t message{};
  message.client_id = client_id(random);
  message.request_id = integer(random);
  message.utime = integer(random);
  message.total_bytes = static_cast<std::int64_t>(below(random, 200'000));
  message.checksum = integer(random);
  message.page = static_cast<std::int32_t>(below(random, 5)) - 1;
  message.page_checksum = integer(random);
  message.num_bytes = fill_list(message.bytes, length(random, wire::kUploadPageBytes),
                                [&] { return static_cast<std::uint8_t>(random()); });
  return message;
}

template <>
upload_status_t random_message<upload_status_t>(Random& random) {
  upload_status_t message{};
  message.client_id = client_id(random);
  message.request_id = integer(random);
  message.utime = integer(random);
  message.status = static_cast<std::int32_t>(below(random, 12));
  message.message = text(random, wire::kMaxTextBytes);
  message.total_bytes = integer(random);
  message.checksum = integer(random);
  message.total_missing = small(random);
  message.num_missing = fill_list(message.missing, length(random, wire::kMaxMissingPages),
                                  [&] { return small(random); });
  return message;
}

template <>
watch_t random_message<watch_t>(Random& random) {
  watch_t message{};
  message.client_id = client_id(random);
  message.request_id = integer(random);
  message.utime = integer(random);
  message.lease_s = number(random);
  message.num_paths = fill_list(message.paths, length(random, 1000), [&] {
    watched_path_t path{};
    path.request_id = integer(random);
    path.known_serial = integer(random);
    path.wanted_offer = integer(random);
    path.taken_offer = integer(random);
    return path;
  });
  return message;
}

template <>
watch_report_t random_message<watch_report_t>(Random& random) {
  watch_report_t message{};
  message.client_id = client_id(random);
  message.request_id = integer(random);
  message.utime = integer(random);
  message.message = text(random, wire::kMaxTextBytes);
  message.num_paths = fill_list(message.paths, length(random, 500), [&] {
    path_state_t path{};
    path.request_id = integer(random);
    path.serial = integer(random);
    path.state = static_cast<std::int8_t>(below(random, 6));
    path.scene_revision = integer(random);
    path.answer_revision = integer(random);
    path.offer_revision = integer(random);
    return path;
  });
  message.num_intervals = fill_list(message.intervals, length(random, 500), [&] {
    broken_interval_t interval{};
    interval.request_id = integer(random);
    interval.t_begin_s = number(random);
    interval.t_end_s = number(random);
    return interval;
  });
  return message;
}

template <>
status_t random_message<status_t>(Random& random) {
  status_t message{};
  message.utime = integer(random);
  message.version = text(random, wire::kMaxVersionBytes);
  message.uptime_s = number(random);
  message.num_workers = small(random);
  message.queued_requests = small(random);
  message.running_requests = small(random);
  message.watched_paths = small(random);
  for (std::int64_t* const counter : {&message.answered_requests,
                                      &message.repeated_requests,
                                      &message.cache_hits,
                                      &message.overloaded_requests,
                                      &message.malformed_messages,
                                      &message.dropped_answers,
                                      &message.unsent_messages,
                                      &message.request_pages_asked_again,
                                      &message.answer_pages_asked_again,
                                      &message.scene_changes,
                                      &message.unsigned_messages,
                                      &message.broken_envelopes,
                                      &message.unknown_key_messages,
                                      &message.altered_messages,
                                      &message.stale_messages,
                                      &message.replayed_messages,
                                      &message.crowded_messages,
                                      &message.received_messages,
                                      &message.received_bytes,
                                      &message.sent_messages,
                                      &message.sent_bytes,
                                      &message.broken_paths,
                                      &message.failed_reloads,
                                      &message.failed_reload_utime}) {
    *counter = integer(random);
  }
  for (auto* const answers :
       {&message.plan_answers, &message.occupancy_answers, &message.scene_answers}) {
    for (std::int64_t& count : *answers) count = integer(random);
  }
  for (latency_t* const latency :
       {&message.receipt_to_answer, &message.waiting, &message.planning}) {
    latency->count = integer(random);
    latency->sum_s = number(random);
    latency->num_buckets =
        fill_list(latency->buckets, length(random, 96), [&] { return integer(random); });
  }
  message.signed_only = static_cast<std::int8_t>(below(random, 2));
  message.failed_reload = text(random, wire::kMaxReloadFaultBytes);
  message.reload_failed = static_cast<std::int8_t>(below(random, 2));
  message.total_scenes = small(random);
  message.num_scenes =
      fill_list(message.scenes, length(random, 100), [&] { return scene_info(random); });
  return message;
}

template <>
envelope_t random_message<envelope_t>(Random& random) {
  envelope_t message{};
  message.key_id = small(random);
  message.sender = integer(random);
  message.counter = integer(random);
  message.utime = integer(random);
  for (std::uint8_t& byte : message.tag) byte = static_cast<std::uint8_t>(below(random, 256));
  message.num_bytes = fill_list(message.payload, length(random, wire::kMaxMessageBytes),
                                [&] { return static_cast<std::uint8_t>(below(random, 256)); });
  return message;
}

template <>
claim_t random_message<claim_t>(Random& random) {
  claim_t message{};
  message.start_id = integer(random);
  message.asked_by = integer(random);
  message.utime = integer(random);
  message.state = static_cast<std::int8_t>(below(random, 4));
  message.served_s = number(random);
  message.host = text(random, wire::kMaxHostBytes);
  message.pid = small(random);
  return message;
}

template <>
error_t random_message<error_t>(Random& random) {
  error_t message{};
  message.utime = integer(random);
  message.channel = text(random, wire::kMaxChannelLength);
  message.size_bytes = integer(random);
  message.message = text(random, wire::kMaxTextBytes);
  return message;
}

}  // namespace camway::testing
