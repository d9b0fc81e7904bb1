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

/// The part of a perspective camera that can run into things: the near quadrilateral. The camera
/// looks down its -Z axis, +Y is up. [Limit: fields of view in (0, π), 0 < near_m; or all 0 where
/// another body moves]
struct Camera {
  double fov_x_rad = 1.5707963267948966;  ///< full horizontal field of view
  double fov_y_rad = 1.0471975511965976;  ///< full vertical field of view
  double near_m = 0.1;                    ///< from the eye to the near plane
};

/// A pose that the path is to pass through.
struct Keyframe {
  std::optional<double> time_s;  ///< when; all keyframes of a request have a time, or none has
  std::array<double, 3> position_m{};
  std::array<double, 4> orientation_wxyz{1, 0, 0, 0};  ///< Hamilton quaternion, camera to world
};

/// A pose that the path of an answer passes through.
struct PathKeyframe {
  double time_s = 0.0;
  std::array<double, 3> position_m{};
  std::array<double, 4> orientation_wxyz{1, 0, 0, 0};  ///< Hamilton quaternion, camera to world
  bool inserted = false;  ///< put in by the daemon to avoid a collision
  bool repaired = false;  ///< a given one that was moved because it collided
};

/// Which of the requests that wait goes first. A client's time counts four times for requests of
/// low priority, a quarter for those of high priority: beside a client that says normal, one that
/// says high gets four times as much planned.
enum class Priority { kLow = -1, kNormal = 0, kHigh = 1 };

/// A question for a path. Zero or empty options stand for the daemon's defaults.
struct PlanRequest {
  std::string scene;  ///< name of a scene that the daemon holds [Limit: 128 bytes]
  Camera camera;
  Body body;  ///< what must not collide; the camera's near quadrilateral unless set
  /// [Limit: 2 to 100,000, free of collision unless `repair_keyframes`]
  std::vector<Keyframe> keyframes;
  /// Of keyframes without times: from one to the next takes √(t² + r²) seconds, where t is their
  /// distance divided by this and r the angle between them in radians, but no less than a hundredth
  /// of the mean of all these. 0: 1 m/s, as in a request with times. [Limit: 1e-6 to 1e6]
  double default_speed_m_per_s = 0.0;

  std::string method;  ///< "ladder", "keyframe_insertion" or empty
  Priority priority = Priority::kNormal;
  /// How often the daemon says how far it is, to `PlanHandlers::on_progress`. 0: twice a second if
  /// there is such a handler, else never. [Limit: at least 0.1 counts]
  double progress_period_s = 0.0;
  /// How long the daemon watches the path after its answer; `Client::watch` sees to that.
  double watch_lease_s = 0.0;
  double deadline_s = 0.0;            ///< from the daemon's receipt on, waiting included
  double chord_error_m = 0.0;         ///< how far the tessellated swept surface may stray
  double interval_tolerance_m = 0.0;  ///< how closely ends of collision intervals are bracketed
  double clearance_m = 0.0;  ///< how far the body has to stay from the scene [Limit: 0 <= value]
  /// Cut-off of the correction; 0: correct nothing. The daemon's default if not set.
  std::optional<std::int32_t> max_inserted_keyframes;
  Objective objective = Objective::kClosest;
  Orientation orientation;
  MotionLimits limits;
  Bounds bounds;  ///< beside those of the scene; `clearance_m` is about the scene alone
  /// Where nothing else helps, the near distance may be made smaller by up to this share; cameras
  /// only. [Limit: 0 <= value < 1]
  double max_shrink = 0.0;
  /// Given keyframes that collide are moved to the nearest free pose instead of being refused.
  bool repair_keyframes = false;
  std::int64_t seed = 0;  ///< of the searches for ways round

  /// 0: the client picks a new one. Otherwise a number that this client id never used for another
  /// request; the daemon answers the same id with the same answer, without planning again.
  std::int64_t request_id = 0;
};

/// How far the daemon is with a request.
struct PlanProgress {
  enum class Stage {
    kWaiting = 0,     ///< for a worker
    kPreparing = 1,   ///< the path through the keyframes is made, and they are checked
    kDetecting = 2,   ///< its collisions are searched for
    kCorrecting = 3,  ///< they are corrected
    kCertifying = 4,  ///< the path is proved as it will be sent
  };
  Stage stage = Stage::kWaiting;
  std::int32_t requests_ahead = 0;  ///< while waiting: about how many are begun before
  std::int32_t num_collisions = 0;  ///< of the path as interpolated; 0 before they are corrected
  std::int32_t num_corrected = 0;   ///< of them
  double since_receipt_s = 0.0;
  double deadline_s = 0.0;  ///< that holds for the request, from its receipt
};

/// Where a collision was seen to be deepest.
struct Witness {
  double time_s = 0.0;
  std::string object;  ///< of the scene; empty if it has no name
  /// Of the scene, counted from 0; -1 to -6: the body left min.x, min.y, min.z, max.x, max.y or
  /// max.z of its bounds, which `object` names, too.
  std::int32_t triangle = 0;
  /// Part of the body: "edge 2", "corner 0", "inside" of a near quadrilateral, "surface" of a
  /// sphere, "face 7" of other bodies.
  std::string feature;
  double depth_m = 0.0;             ///< about how far the body had to move to be free
  std::array<double, 3> point_m{};  ///< of the scene, in the world frame
};

/// A stretch of a path in which the body collides with the scene, or comes nearer than the required
/// clearance.
struct CollisionInterval {
  double t_begin_s = 0.0;
  double t_end_s = 0.0;
  std::optional<Witness> witness;
};

/// Wall-clock milliseconds that the daemon took.
struct PlanTiming {
  double motion_ms = 0.0;
  double detect_ms = 0.0;
  double correct_ms = 0.0;
  double certify_ms = 0.0;
  double total_ms = 0.0;
};

/// What came of a request.
struct PlanResponse {
  Status status = Status::kNoAnswer;
  std::string error;    ///< what failed and what to do about it; empty when `ok()`
  std::string message;  ///< the daemon's own sentence, also when all is well

  bool ok() const { return status == Status::kOk; }

  std::int32_t keyframe = -1;                 ///< of the given one at fault or without a way out; -1 if none
  Path path;                                  ///< empty unless ok, partial or timeout
  std::vector<PathKeyframe> keyframes;        ///< given and inserted ones, with their times
  std::vector<CollisionInterval> collisions;  ///< of the interpolated path, before correction
  std::vector<CollisionInterval> remaining;   ///< of `path`; none when `ok()`

  bool certified =
      false;  ///< whether freedom of collision is proved for `path`, between samples too
  double clearance_lower_bound_m = 0.0;

  Bounds bounds;  ///< that the body had to keep to: those of request and scene together
  std::vector<Correction> corrections;          ///< what became of each of `collisions`
  std::optional<PathMeasures> measures_before;  ///< of the path as interpolated
  std::optional<PathMeasures> measures;         ///< of `path`
  double near_scale = 1.0;  ///< the near distance that is proved, as a share of the one asked for
  /// Duration of `path` by the one asked for; above 1 where it was slowed to meet limits. All times
  /// of the answer are new ones then.
  double time_scale = 1.0;
  std::vector<SlowedStretch> slowed;           ///< where that was, in order of time
  std::vector<KeyframeFault> keyframe_faults;  ///< why invalid, or what was repaired
  std::optional<Infeasibility> infeasibility;  ///< the proof, if infeasible
  /// Whether the deadline left anything undone, of whatever status: then, and only then, the same
  /// request may have another answer the next time.
  bool deadline_reached = false;

  std::string scene;
  std::int64_t scene_revision = 0;  ///< of the scene that the answer holds for
  std::string scene_digest;
  std::int64_t request_id = 0;
  PlanTiming timing;
  int tries = 0;           ///< how often the request was sent
  double elapsed_s = 0.0;  ///< from the call to its return
};

/// What a client calls on its own thread: quick things, that do not wait for the client.
struct PlanHandlers {
  std::function<void(const PlanProgress&)> on_progress;
  std::function<void(const PlanResponse&)> on_answer;  ///< once, before `PendingPlan::answer`
};

/// A request that was sent.
struct PendingPlan {
  std::int64_t request_id = 0;  ///< for `Client::cancel`; 0 if the request could not be sent
  std::future<PlanResponse> answer;
};

}  // namespace camway
