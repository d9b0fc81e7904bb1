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

struct ClientOptions {
  /// LCM network; empty: the environment's LCM_DEFAULT_URL, else multicast that stays on this host.
  /// With ttl 0 no other host is heard either.
  /// To reach other hosts: "udpm://239.255.76.67:7667?ttl=1", the daemon's `--url` likewise.
  std::string url;
  std::string prefix = "CAMWAY";  ///< of all channels, as the daemon's [Limit: [A-Za-z0-9_-]{1,11}]
  /// How client and daemon know each other's messages; null: what is sent is not signed, and what
  /// comes is believed.
  std::shared_ptr<const Authentication> authentication;
  std::string client_id;  ///< [Limit: [A-Za-z0-9_-]{1,32}] empty: a random one

  /// A call ends by then, whatever happens (planning calls: not before the request's own deadline).
  double deadline_s = 60.0;
  /// How long the daemon may take for a change of a scene, from its receipt; what is not in force
  /// by then changes nothing and ends with `kTimeout`. 0: its own default. [Limit: 0 <= value]
  double change_deadline_s = 0.0;
  double try_timeout_s = 0.4;  ///< how long a first answer may take before the request is repeated
  double backoff = 1.6;        ///< each further try waits so many times longer [Limit: >= 1]
  double max_try_timeout_s = 5.0;  ///< but never longer than this
  /// By how much of itself a wait is made shorter or longer at random, so that many clients that
  /// were refused at once do not come back at once. [Limit: 0 <= value < 1]
  double jitter = 0.2;
  std::uint64_t seed = 0;  ///< of that; 0: another one each time
  /// A watched path is watched for so long after the client fell silent. The daemon may allow less.
  /// [Limit: 1 <= value <= 86400]
  double watch_lease_s = 30.0;
  /// A change of a scene that a daemon refuses because it ends is asked of the next one, for which
  /// the call waits so long; then it ends with `kStopping`. [Limit: 0 <= value]
  double successor_wait_s = std::numeric_limits<double>::infinity();
  int retries = 5;  ///< repetitions without a sign of life before the call gives up
};

/// Asks a Camway daemon over LCM.
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
/// Calls never throw for trouble of network, daemon or planner: the result says how the call ended.
/// A request whose answer does not come is sent again, with growing waits, under the same id, which
/// is harmless: the daemon may die and be started again meanwhile. Parts of an answer that were
/// lost are asked for.
///
/// All members may be called from any thread, and many requests may be on their way at a time. A
/// client has a thread of its own. Any number of clients may live in a process.
class Client {
 public:
  /// Opens the network. Takes up to ten seconds where multicast does not work, for LCM tests that
  /// first; never throws for it (see `error`).
  explicit Client(ClientOptions options = {});
  /// Ends all requests that are on their way; no handler is called once this returns. A handler of
  /// this client may destroy it too, and must not use anything of it afterwards; the client's
  /// thread ends by itself then, soon after the handler returns.
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Why this client cannot be used (bad options, no network); empty when it can.
  const std::string& error() const;
  bool good() const { return error().empty(); }

  /// What somebody should know though the client can be used; empty: nothing. With ttl 0 a client
  /// hears this host only; where the kernel does not permit that, this says why.
  const std::string& warning() const;

  /// What the daemon knows this client by.
  const std::string& client_id() const;

  /// Asks for a path and waits for the answer.
  PlanResponse plan(const PlanRequest& request);

  /// Asks for a path and returns at once. The answer comes in the future, and to the handler if
  /// there is one; when the client is destroyed before, it says so.
  PendingPlan plan_async(const PlanRequest& request, PlanHandlers handlers = {});

  /// Calls off a request that was sent by this client. Its answer comes soon: `kCancelled`, or what
  /// it was if it was ready. Does nothing for other ids, and nothing the second time.
  void cancel(std::int64_t request_id);

  /// Asks for a path and leaves it with the daemon: `on_event` hears of the answer, and from then
  /// on of each change of the scene that breaks the path, of the corrected path, and of a better
  /// one once what was in the way is gone, until `unwatch`. Lost messages and restarts of the
  /// daemon are seen to. Returns the id of the request; 0, after `on_event` heard why, if it cannot
  /// be sent.
  std::int64_t watch(const PlanRequest& request, WatchHandler on_event);

  /// Ends it. An event that is on its way may still come. The daemon is told until it answers, as
  /// long as this client lives; it ends the watch by itself when the lease is over. Does nothing
  /// for other ids.
  void unwatch(std::int64_t request_id);

  /// The same, and waits until the daemon does not watch any more; for who destroys the client
  /// next. True if the daemon said so, or the lease is over; false if `timeout_s` passed or the
  /// network broke. Not for handlers of this client, where it is false at once.
  bool unwatch(std::int64_t request_id, double timeout_s);

  /// Has the daemon watch the better path that it offered last (`WatchEvent::Kind::kBetter`) in the
  /// place of the one before: `kAnswer` tells so, with the same path; `kWithdrawn` or `kBroken` if
  /// a change of the scene came first. Does nothing where none is on offer. For handlers too.
  void take_better(std::int64_t request_id);

  /// Asks a scene's occupancy map.
  OccupancyAnswer occupancy(const OccupancyBatch& batch);

  /// Makes a scene of one mesh, or replaces the one of that name; of nothing if `mesh` names
  /// neither a file nor bytes. The resolution of its occupancy map, 0 for no map, and the bounds
  /// that no body may leave in it, are for its life.
  SceneAnswer load_scene(const std::string& scene, const SceneMesh& mesh,
                         double occupancy_resolution_m = 0.0, const Bounds& body_bounds = {});
  SceneAnswer unload_scene(const std::string& scene);
  SceneAnswer list_scenes();
  /// All objects of a scene.
  SceneAnswer describe_scene(const std::string& scene);

  /// Adds an object to a scene, or replaces the one of that name. Each change makes a new revision;
  /// plans that have begun keep theirs.
  SceneAnswer put_object(const std::string& scene, const std::string& object,
                         const SceneShape& shape, const Pose& pose = {});
  SceneAnswer move_object(const std::string& scene, const std::string& object, const Pose& pose);
  SceneAnswer remove_object(const std::string& scene, const std::string& object);

  /// All revisions of a scene that can be had again, the newest included, and what led to each.
  SceneAnswer scene_history(const std::string& scene);
  /// Makes the newest revision of a scene have the objects of an earlier one; or makes a scene
  /// `restore_as` of them, if that is not empty, or replaces the one of that name.
  SceneAnswer restore_scene(const std::string& scene, std::int64_t revision,
                            const std::string& restore_as = "");

  /// Tells an object that is an OctoMap what a sensor at `origin_m` saw, all in the world's frame.
  /// Each scan makes a new revision.
  SceneAnswer insert_scan(const std::string& scene, const std::string& object,
                          const std::vector<std::array<double, 3>>& points_m,
                          const std::array<double, 3>& origin_m);

  /// Fetches a scene's occupancy map.
  SceneMap export_map(const std::string& scene);
  /// Has the daemon write it to a file below one of its scene roots, of which the name ends with
  /// ".bt". One that is there is replaced.
  SceneAnswer export_map_to(const std::string& scene, const std::string& file);

  /// For another thread than those that wait in calls about scenes: all of them end soon, with
  /// `kCancelled` if they changed nothing, or with their answer if the change was in force already.
  void cancel_scene_calls();

  /// Waits for the daemon's next heartbeat; there is one each second.
  DaemonStatus status(double timeout_s = 3.0);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace camway
