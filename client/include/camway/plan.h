// SPDX-License-Identifier: MIT
#pragma once

#include <camway/body.h>
#include <camway/constraints.h>
#include <camway/correction.h>
#include <camway/path.h>
#include <camway/status.h>

#include <array>
#include <cstdint>
#include <functional>
#include <future>
#include <optional>
#include <string>
#include <vector>

namespace camway {

/// A perspective camera; its near quadrilateral must not collide. The camera looks down its -Z
/// axis, +Y is up. [Limit: fields of view in (0, π), 0 < near_m; or all 0 if another body moves]
struct Camera {
  double fov_x_rad = 1.5707963267948966;  ///< full horizontal field of view
  double fov_y_rad = 1.0471975511965976;  ///< full vertical field of view
  double near_m = 0.1;                    ///< distance from the eye to the near plane
};

/// A pose that the path must pass through.
struct Keyframe {
  std::optional<double> time_s;  ///< set in all keyframes of a request, or in none
  std::array<double, 3> position_m{};
  std::array<double, 4> orientation_wxyz{1, 0, 0, 0};  ///< Hamilton quaternion, camera to world
  std::array<double, 4> image{};  ///< `PathKeyframe::image`; counts only with `PlanRequest::frame`
};

/// A pose that the path of an answer passes through.
struct PathKeyframe {
  double time_s = 0.0;
  std::array<double, 3> position_m{};
  std::array<double, 4> orientation_wxyz{1, 0, 0, 0};  ///< Hamilton quaternion, camera to world
  bool inserted = false;                               ///< whether a correction inserted it
  bool repaired = false;  ///< whether it is a given keyframe that was moved because it collided
  /// Point of the spline of orientations, for planning again; zero without a frame.
  std::array<double, 4> image{};

  /// Returns the keyframe of a request for the same path (`PlanResponse::frame`).
  Keyframe again() const { return {time_s, position_m, orientation_wxyz, image}; }
};

/// First derivatives of a path at one of its ends, as `PathFrame` has them.
struct PathEnd {
  std::array<double, 3> velocity_m_per_s{};
  std::array<double, 4> image_rate_per_s{};
};

/// The part of a corrected path that its keyframes do not determine. Copy it from an answer to a
/// request, together with the keyframes; its numbers are not meant to be edited.
struct PathFrame {
  std::array<double, 4> reference_wxyz{1, 0, 0, 0};
  PathEnd begin;
  PathEnd end;
};

/// The priority of a request in the daemon's queue. It orders the waiting requests of one client.
/// Between clients it weighs the planning time that each is charged: low counts four times, high a
/// quarter. So a client that sends high gets four times as much planned as one that sends normal.
enum class Priority { kLow = -1, kNormal = 0, kHigh = 1 };

/// A request for a path. A zero or empty option stands for the daemon's default, which
/// docs/requests.md lists.
struct PlanRequest {
  std::string scene;  ///< name of a scene that the daemon holds [Limit: 128 bytes]
  Camera camera;
  Body body;  ///< shape that must not collide; by default the near quadrilateral of `camera`
  /// Poses that the path must pass through. They must be free of collision unless
  /// `repair_keyframes` is set. [Limit: 2 to 100,000]
  std::vector<Keyframe> keyframes;
  /// Frame of the answer whose keyframes these are, as they were or edited. Without edits, the path
  /// is that of the answer. The keyframes must have times.
  std::optional<PathFrame> frame;
  /// Speed for keyframes without times; 0 for the default of 1 m/s. The interval between two
  /// keyframes lasts √(t² + r²) seconds, where t is their distance divided by this speed and r is
  /// the angle between them in radians, but at least a hundredth of the mean interval. Leave it 0
  /// if the keyframes have times. [Limit: 1e-6 to 1e6]
  double default_speed_m_per_s = 0.0;
  /// Distance of what the picture shows, by which corrections weigh moves against turns; 0: taken
  /// from the scene. [Limit: 0 <= value]
  double viewing_distance_m = 0.0;

  std::string method;  ///< "ladder", "keyframe_insertion", or empty for the daemon's default
  Priority priority = Priority::kNormal;
  /// Time between two calls of `PlanHandlers::on_progress`. 0 means 0.5 s if there is such a
  /// handler, and no progress reports otherwise. Values below 0.1 count as 0.1.
  double progress_period_s = 0.0;
  /// Time for which the daemon watches the path after its answer. `Client::watch` sets it.
  double watch_lease_s = 0.0;
  /// The answer must be for this revision of the scene or a later one; else it is `kOldScene`. 0:
  /// any. A client that waits for its change, `SceneAnswer::scene`, sets the revision of that.
  std::int64_t least_revision = 0;
  double deadline_s = 0.0;  ///< time from the daemon's receipt to its answer, waiting included
  /// Largest error of the tessellated swept surface. Only the method "keyframe_insertion" uses it.
  double chord_error_m = 0.0;
  /// Accuracy of the ends of collision intervals, as a distance: no point of the body moves farther
  /// between the true and the reported end.
  double interval_tolerance_m = 0.0;
  double clearance_m = 0.0;  ///< required distance between body and scene [Limit: 0 <= value]
  /// Largest number of keyframes that corrections may insert. With 0 collisions are only reported.
  /// Unset: the daemon's default.
  std::optional<std::int32_t> max_inserted_keyframes;
  Objective objective = Objective::kClosest;
  Orientation orientation;
  MotionLimits limits;
  /// Box that the body must not leave, in addition to the bounds of the scene. `clearance_m` does
  /// not apply to it.
  Bounds bounds;
  /// Largest fraction by which the near distance may shrink if no other correction succeeds. Only
  /// for cameras. [Limit: 0 <= value < 1]
  double max_shrink = 0.0;
  /// Whether a given keyframe that collides is moved to the nearest free pose. If not, the request
  /// ends with `kInvalid`.
  bool repair_keyframes = false;
  bool clearance_profile = false;  ///< whether the answer has `PlanResponse::clearance_profile`
  std::int64_t seed = 0;  ///< random seed of the searches for detours

  /// Id of the request; 0 lets the client pick one. Any other number must never have been used by
  /// this client id for another request: the daemon sends the same answer to the same id, without
  /// planning again.
  std::int64_t request_id = 0;
};

/// The progress of a request in the daemon.
struct PlanProgress {
  enum class Stage {
    kWaiting = 0,     ///< waits for a worker
    kPreparing = 1,   ///< interpolates the keyframes and checks them
    kDetecting = 2,   ///< searches the path for collisions
    kCorrecting = 3,  ///< corrects the collisions
    kCertifying = 4,  ///< proves the path as it will be sent
  };
  Stage stage = Stage::kWaiting;
  std::int32_t requests_ahead = 0;  ///< kWaiting: estimated number of requests that start earlier
  /// Collisions of the path as interpolated; 0 before kCorrecting.
  std::int32_t num_collisions = 0;
  std::int32_t num_corrected = 0;  ///< number of these collisions that are corrected
  double since_receipt_s = 0.0;    ///< time since the daemon received the request
  double deadline_s = 0.0;         ///< deadline of the request, counted from its receipt
};

/// The deepest point of a collision, as far as the daemon searched. It shows where to look and is
/// no part of a proof.
struct Witness {
  double time_s = 0.0;
  std::string object;  ///< object of the scene; empty if it has no name
  /// Triangle of the scene, counted from 0. From -1 to -6: the body left the side min.x, min.y,
  /// min.z, max.x, max.y or max.z of its bounds, which `object` names ("bounds.min.y").
  std::int32_t triangle = 0;
  /// Part of the body: "edge 2", "corner 0" or "inside" of a near quadrilateral, "surface" of a
  /// sphere, "face 7" of other bodies.
  std::string feature;
  double depth_m = 0.0;             ///< estimated distance that the body has to move to be free
  std::array<double, 3> point_m{};  ///< point of the scene or of the bounds, in the world frame
};

/// A time range of a path in which the body collides with the scene, is nearer to it than the
/// required clearance, or leaves its bounds.
struct CollisionInterval {
  double t_begin_s = 0.0;
  double t_end_s = 0.0;
  std::optional<Witness> witness;
};

/// Wall-clock times of the stages of planning, in milliseconds.
struct PlanTiming {
  double motion_ms = 0.0;   ///< interpolation and the check of the keyframes
  double detect_ms = 0.0;   ///< search for collisions
  double correct_ms = 0.0;  ///< correction
  double certify_ms = 0.0;  ///< proof of the final path
  double total_ms = 0.0;
};

/// The answer to a request for a path.
struct PlanResponse {
  Status status = Status::kNoAnswer;
  std::string error;    ///< the failure and its remedy; empty when `ok()`
  std::string message;  ///< one sentence of the daemon, also when `ok()`

  bool ok() const { return status == Status::kOk; }

  DaemonStart daemon_start;  ///< of the daemon that answered
  /// Index of the given keyframe that is at fault, or from which no way out was found; -1 if none.
  std::int32_t keyframe = -1;
  Path path;                            ///< empty unless ok, partial or timeout
  std::vector<PathKeyframe> keyframes;  ///< given and inserted keyframes, with their times
  /// Set if the path was corrected, and not slowed. A request with this frame and
  /// `PathKeyframe::again()` of each of `keyframes` has the same path; edit some of them to change
  /// it there.
  std::optional<PathFrame> frame;
  std::vector<CollisionInterval> collisions;  ///< collisions of the path as interpolated
  std::vector<CollisionInterval> remaining;   ///< collisions of `path`; none when `ok()`

  /// Whether `path` is proved free of collision at every instant, rounding included.
  bool certified = false;
  double clearance_lower_bound_m = 0.0;  ///< proved distance between body and scene

  Bounds bounds;                        ///< intersection of the request's and the scene's bounds
  std::vector<Correction> corrections;  ///< one for each of `collisions`; may be empty
  std::optional<PathMeasures> measures_before;  ///< measures of the path as interpolated
  std::optional<PathMeasures> measures;         ///< measures of `path`
  /// Viewing distance of all shifts in the answer: that of the request, or the one that was taken
  /// from the scene. 0 if no shift was measured: nothing was corrected, or by "keyframe_insertion".
  double viewing_distance_m = 0.0;
  double near_scale = 1.0;  ///< near distance that is proved, divided by the requested one
  /// Duration of `path` divided by the requested one; above 1 if the path was slowed to meet motion
  /// limits. Then all times in the answer are times on the slowed path.
  double time_scale = 1.0;
  std::vector<SlowedStretch> slowed;           ///< slowed parts of `path`, in order of time
  /// Proved clearance of all of `path`, stretch after stretch; empty unless the request asks for it.
  std::vector<ClearanceStretch> clearance_profile;
  std::vector<KeyframeFault> keyframe_faults;  ///< given keyframes that collide, or were repaired
  std::optional<Infeasibility> infeasibility;  ///< the proof of `kInfeasible`
  /// Whether the deadline left anything undone, whatever the status. Only then may the same request
  /// have another answer the next time.
  bool deadline_reached = false;

  std::string scene;
  std::int64_t scene_revision = 0;  ///< revision of the scene that the answer holds for; 0 if none
  std::string scene_digest;         ///< digest of that revision
  std::int64_t request_id = 0;
  PlanTiming timing;
  int tries = 0;           ///< number of times that the request was sent
  double elapsed_s = 0.0;  ///< time from the call to the answer
};

/// Callbacks of `Client::plan_async`. They run on the client's own thread, so they must be quick
/// and must not call a blocking member of the client. Exceptions are ignored there.
struct PlanHandlers {
  std::function<void(const PlanProgress&)> on_progress;
  /// Runs once, before `PendingPlan::answer` is ready. A request that cannot be sent runs it on the
  /// caller's thread, before `plan_async` returns.
  std::function<void(const PlanResponse&)> on_answer;
};

/// A pending request for a path.
struct PendingPlan {
  std::int64_t request_id = 0;       ///< argument for `Client::cancel`; 0 if nothing was sent
  std::future<PlanResponse> answer;  ///< the answer, or the reason why there is none
};

}  // namespace camway
