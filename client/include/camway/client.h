// SPDX-License-Identifier: MIT
#pragma once

#include <camway/authentication.h>
#include <camway/body.h>
#include <camway/daemon_status.h>
#include <camway/occupancy.h>
#include <camway/path.h>
#include <camway/plan.h>
#include <camway/scene.h>
#include <camway/status.h>
#include <camway/watch.h>

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace camway {

/// The options of a client. The defaults suit a daemon on the same host.
struct ClientOptions {
  /// URL of the LCM network. Empty: LCM_DEFAULT_URL of the environment, or else multicast on this
  /// host alone. With ttl 0 neither side hears other hosts. To reach other hosts, use
  /// "udpm://239.255.76.67:7667?ttl=1" here and as the daemon's `--url`.
  std::string url;
  /// First part of all channel names, the same as the daemon's. [Limit: [A-Za-z0-9_-]{1,11}]
  std::string prefix = "CAMWAY";
  /// Signs and checks messages. Null: messages are not signed, and received ones not checked.
  std::shared_ptr<const Authentication> authentication;
  /// Name of this client, different from all others. Empty: random. [Limit: [A-Za-z0-9_-]{1,32}]
  std::string client_id;

  /// Largest duration of a call. A planning call lasts at least until the deadline of its request,
  /// once a daemon was heard. [Limit: 0 < value]
  double deadline_s = 60.0;
  /// Time for a change of a scene, from its receipt by the daemon; 0 for the daemon's default. A
  /// change that takes longer is cancelled and ends with `kTimeout`. [Limit: 0 <= value]
  double change_deadline_s = 0.0;
  double try_timeout_s = 0.4;  ///< wait before the first repetition of a request [Limit: 0 < value]
  double backoff = 1.6;        ///< factor from one wait to the next [Limit: 1 <= value]
  double max_try_timeout_s = 5.0;  ///< longest wait before a repetition [Limit: 0 < value]
  /// Largest random change of a wait, as a fraction of the wait. It keeps clients that were refused
  /// together from coming back together. [Limit: 0 <= value < 1]
  double jitter = 0.2;
  std::uint64_t seed = 0;  ///< random seed of the jitter; 0: a different one for each client
  /// Time for which a path stays watched after the last message of the client. The daemon may
  /// allow less. [Limit: 1 <= value <= 86400]
  double watch_lease_s = 30.0;
  /// Time to wait for the next daemon if one refuses a change of a scene because it is stopping.
  /// After that the call ends with `kStopping`. [Limit: 0 <= value]
  double successor_wait_s = std::numeric_limits<double>::infinity();
  /// Repetitions without a sign of life from a daemon after which a call ends. [Limit: 0 <= value]
  int retries = 5;
};

/// A connection to a Camway daemon over LCM.
///
///     camway::Client client;
///     camway::PlanRequest request;
///     request.scene = "office";
///     request.keyframes.resize(2);
///     request.keyframes[0].position_m = {1.0, 2.0, 1.6};
///     request.keyframes[1].position_m = {9.0, 2.0, 1.6};
///     const camway::PlanResponse answer = client.plan(request);
///     if (!answer.ok()) {
///       std::cerr << answer.error << '\n';
///       return 1;
///     }
///     for (double t = answer.path.begin(); t <= answer.path.end(); t += 0.04) {
///       const camway::Pose pose = answer.path.pose(t);
///       std::cout << t << ' ' << pose.position_m[0] << ' ' << pose.position_m[1] << '\n';
///     }
///
/// Faults of the network, the daemon or planning never throw; the status of the result reports
/// them. A request without an answer is repeated under the same id, with growing waits, also across
/// a restart of the daemon. Missing pages of an answer are requested again.
///
/// Members that return an answer block until the call has ended. Called from a handler of the same
/// client, they return `kBusy` at once.
///
/// Thread-safe. Many requests may be pending at a time. Each client has a thread of its own, and a
/// process may have any number of clients.
class Client {
 public:
  /// Opens the network. Takes up to ten seconds where multicast does not work, because LCM tests
  /// that first. Does not throw for a network that cannot be used; see `error`.
  explicit Client(ClientOptions options = {});
  /// Ends all pending requests; no handler runs after it returns. A handler of this client may
  /// destroy it, and must not use it afterwards; the client's thread then ends soon after the
  /// handler returns.
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Returns why this client cannot be used (bad options, no network); empty if it can.
  const std::string& error() const;
  bool good() const { return error().empty(); }

  /// Returns a warning about a client that can be used, or nothing: with ttl 0 it says why the
  /// kernel does not let the client ignore other hosts.
  const std::string& warning() const;

  /// Returns the id under which the daemon knows this client.
  const std::string& client_id() const;

  /// Requests a path and waits for the answer.
  PlanResponse plan(const PlanRequest& request);

  /// Requests a path and returns at once. The answer goes to `handlers.on_answer`, if set, and then
  /// to the future. If the client is destroyed first, the answer has the status `kNoAnswer`.
  PendingPlan plan_async(const PlanRequest& request, PlanHandlers handlers = {});

  /// Cancels a plan request of this client. Its answer comes soon: `kCancelled`, or the finished
  /// answer if there is one. Has no effect on other ids; may be repeated.
  void cancel(std::int64_t request_id);

  /// Requests a path and has the daemon watch it until `unwatch`. `on_event` receives the answer;
  /// then each change of the scene that breaks the path, the corrected path, and a better path once
  /// an obstacle is gone. Handles lost messages and daemon restarts. Returns the id of the request.
  /// If the request cannot be sent, calls `on_event` with `kEnded` and returns 0.
  std::int64_t watch(const PlanRequest& request, WatchHandler on_event);

  /// Ends a watch. A pending event may still arrive. The daemon is told until it answers, as long
  /// as this client exists; otherwise it ends the watch when the lease is over. Has no effect on
  /// other ids.
  void unwatch(std::int64_t request_id);

  /// Ends a watch and waits until the daemon has ended it, for example before the client is
  /// destroyed. Returns true if the daemon confirmed it or the lease is over; false if `timeout_s`
  /// passed or the network failed. In a handler of this client it returns false without effect.
  bool unwatch(std::int64_t request_id, double timeout_s);

  /// Has the daemon watch the better path that it offered last (`WatchEvent::Kind::kBetter`)
  /// instead of the present one. The event `kAnswer` confirms it, with the same path; `kWithdrawn`
  /// or `kBroken` comes instead if the scene changed first. Has no effect without an offer.
  /// Handlers may call it.
  void take_better(std::int64_t request_id);

  /// Queries the occupancy map of a scene.
  OccupancyAnswer occupancy(const OccupancyBatch& batch);

  /// Makes a scene of one mesh, or replaces the scene of that name. The scene is empty if `mesh`
  /// has neither a file nor bytes. The resolution of the occupancy map (0: no map) and the bounds
  /// that no body may leave are the same for all later revisions.
  SceneAnswer load_scene(const std::string& scene, const SceneMesh& mesh,
                         double occupancy_resolution_m = 0.0, const Bounds& body_bounds = {});
  SceneAnswer unload_scene(const std::string& scene);
  SceneAnswer list_scenes();
  /// Lists all objects of a scene.
  SceneAnswer describe_scene(const std::string& scene);

  /// Adds an object to a scene, or replaces the object of that name. Each change makes a new
  /// revision; a plan keeps the revision with which it began.
  SceneAnswer put_object(const std::string& scene, const std::string& object,
                         const SceneShape& shape, const Pose& pose = {});
  SceneAnswer move_object(const std::string& scene, const std::string& object, const Pose& pose);
  SceneAnswer remove_object(const std::string& scene, const std::string& object);

  /// Lists the revisions of a scene that can be restored, the newest included, and the change that
  /// made each.
  SceneAnswer scene_history(const std::string& scene);
  /// Makes a new revision of a scene with the objects of an earlier one. With `restore_as`, makes
  /// or replaces the scene of that name instead.
  SceneAnswer restore_scene(const std::string& scene, std::int64_t revision,
                            const std::string& restore_as = "");

  /// Inserts a scan into an object that is an OctoMap: a sensor at `origin_m` saw `points_m`, in
  /// the world frame. Each scan makes a new revision.
  SceneAnswer insert_scan(const std::string& scene, const std::string& object,
                          const std::vector<std::array<double, 3>>& points_m,
                          const std::array<double, 3>& origin_m);

  /// Returns the occupancy map of a scene.
  SceneMap export_map(const std::string& scene);
  /// Returns the triangles of the object of a scene that has this digest (`describe_scene`). Equal
  /// digests have equal triangles in the world, so they can be kept by digest. `kInvalid` if the
  /// scene has no such object now.
  SceneTriangles object_triangles(const std::string& scene, const std::string& digest);
  /// Has the daemon write the occupancy map of a scene to a file below one of its scene roots. The
  /// name must end with ".bt"; an existing file is replaced.
  SceneAnswer export_map_to(const std::string& scene, const std::string& file);

  /// Ends all calls about scenes that other threads wait in. Each returns soon: with `kCancelled`
  /// if nothing was changed, or with its answer if the change was made already.
  void cancel_scene_calls();

  /// Waits for the next heartbeat of the daemon, which comes once a second by default. Returns
  /// `kNoDaemon` if none comes within `timeout_s`.
  DaemonStatus status(double timeout_s = 3.0);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace camway
