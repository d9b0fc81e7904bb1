// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <camway/plan_request_t.hpp>
#include <camway/watch_report_t.hpp>
#include <camway/watch_t.hpp>

#include "daemon/service/core/core.h"
#include "daemon/service/transport/answer_pages.h"
#include "daemon/service/watches/answer_quality.h"
#include "daemon/service/watches/watch_checker.h"
#include "daemon/service/watches/watch_limits.h"

namespace camway::service {

/// An answer whose path can be watched.
struct WatchableAnswer {
  RequestKey key;
  std::shared_ptr<const plan_request_t> request;
  std::shared_ptr<const planning::WatchedPath> path;
  std::int64_t revision = 0;  ///< revision of the scene in which the path is proved free
  /// That revision; null if it is not at hand: then nothing is known of the path here.
  std::shared_ptr<const scene::Snapshot> proved_in;
  AnswerQuality quality;
  /// The path as interpolated, which collides in `revision` for `colliding_s`; null if it is free.
  std::shared_ptr<const planning::WatchedPath> interpolated;
  double colliding_s = 0.0;
};

/// The watched paths of all clients: their leases, their states, and the states that the clients
/// know. A path is watched until its lease ends, unless the client renews it. A new state is sent
/// at once, and repeated with growing pauses until the client confirms it. So the protocol
/// tolerates lost messages, and restarts of the client or the daemon.
///
/// When a path was replaced because it collided, the replacement stays in use even after the
/// obstacle is gone. To notice that, up to three former paths are watched too: the path as
/// interpolated, if it collided from the beginning, the first one and the most recent one. When a
/// former path collides for less time than before, the request is planned again. Only one request
/// is planned for this reason at a time. Each request waits between two attempts for a pause that
/// grows (`kFirstImprovePause`). If the new answer is better (`is_better`), the client gets it as
/// an offer and decides whether to accept it. An offer whose path collides after a change is
/// withdrawn.
///
/// Not thread-safe: for the loop thread.
class Watches {
 public:
  using Clock = std::chrono::steady_clock;

  /// Requires that `core` and `scenes` outlive this object.
  Watches(Core& core, scene::SceneStore& scenes, const WatchLimits& limits);

  /// Watches the path of a first answer, or replaces the path that is watched under its key.
  /// If a limit prevents that, sends the client a report and returns false.
  bool begin(const WatchableAnswer& answer, Clock::time_point now);

  /// Renews the lease of a path whose request came in again, and reports its state. Returns false
  /// if nothing is watched under that key.
  bool renew(const RequestKey& key, Clock::time_point now);

  /// Handles a message on the watch channel. Throws only if memory runs out.
  void on_message(std::span<const std::uint8_t> message);

  /// Sends the reports that are due, and ends leases.
  void tick(Clock::time_point now);
  /// Returns the next time at which `tick`, `take_broken` or `take_improvable` has work;
  /// `time_point::max()` if there is none. Work of `take_broken` and `take_improvable` that is due
  /// at `now` already is not counted.
  [[nodiscard]] Clock::time_point next_tick(Clock::time_point now) const;

  struct Request {
    RequestKey key;
    std::shared_ptr<const plan_request_t> request;
  };
  /// Returns up to `most` requests whose paths collide now, to be planned again. Requires a call of
  /// `planned` or `not_planned` for each.
  std::vector<Request> take_broken(std::size_t most, Clock::time_point now);
  /// Notes that the request was planned. Returns true if the path still collides: then the answer
  /// should be sent, and `begin` or `answered` must be called.
  bool planned(const RequestKey& key);
  /// Notes that the request was not planned; it is tried again a little later.
  void not_planned(const RequestKey& key, Clock::time_point now);
  /// Notes that the answer that was sent has no proved path. The previous path remains watched.
  void answered(const RequestKey& key, std::int64_t answer_revision, Clock::time_point now);

  /// Returns a request whose path is free, but for which there may be a better path by now.
  /// Requires a call of `offer`, `no_offer` or `not_improved` before the next call.
  std::optional<Request> take_improvable(Clock::time_point now);
  /// Notes that the request was planned, with this answer. Offers the answer to the client if it is
  /// better.
  void offer(const WatchableAnswer& answer, Pages pages, Clock::time_point now);
  /// Notes that the request was planned, and that the answer has no proved path.
  void no_offer(const RequestKey& key, Clock::time_point now);
  /// Notes that the request was not planned; it is tried again later.
  void not_improved(const RequestKey& key, Clock::time_point now);

  /// An offer that a client accepted. Its answer replaces the earlier answer to the request.
  struct Accepted {
    WatchableAnswer answer;
    Pages pages;
  };
  /// Returns the accepted offers and forgets them. Requires a call of `begin` for each.
  std::vector<Accepted> take_accepted();

 private:
  enum class Planning : std::uint8_t { kNot, kWaits, kRuns };
  /// Least pause between two searches for a better path of one request. It grows with each failure.
  static constexpr std::chrono::milliseconds kFirstImprovePause{1000};
  /// A path that was watched before, or that collided from the beginning.
  struct Former {
    WatchChecker::Id id = 0;
    bool is_interpolated = false;
    std::size_t bytes = 0;
    double colliding_s = 0.0;  ///< total time during which it collides
  };
  struct Offer {
    WatchableAnswer answer;
    Pages pages;
    WatchChecker::Id id = 0;
    std::size_t bytes = 0;
    bool is_checked =
        false;  ///< whether its path is checked and free, and the client knows the offer
  };
  struct Watch {
    WatchableAnswer answer;
    WatchChecker::Id id = 0;
    std::size_t bytes = 0;
    Clock::duration lease{};
    Clock::time_point until;
    bool is_checked = false;  ///< whether `collisions` and `revision` are set
    std::vector<collision::CollisionInterval> collisions;
    std::uint64_t revision = 0;  ///< revision of the scene that `collisions` hold for
    std::int64_t answer_revision = 0;
    std::int64_t serial = 0;  ///< number of the newest state
    bool is_known = false;    ///< whether the client knows the newest state
    Clock::time_point tell_at;
    Clock::duration pause{};  ///< until the state is sent again
    Planning planning = Planning::kNot;
    bool is_outdated = false;     ///< whether the scene near the path changed since planning began
    Clock::time_point due;        ///< its place in `due_`
    std::vector<Former> formers;  ///< as interpolated, the first path, and the one before this
    std::optional<Offer> offer;
    std::optional<Clock::time_point> improve_at;  ///< its place in `improvable_`
    Clock::time_point improve_not_before{};
    Clock::duration improve_pause = kFirstImprovePause;  ///< between two attempts
  };
  using WatchMap = std::map<RequestKey, Watch>;
  using Times = std::set<std::pair<Clock::time_point, RequestKey>>;

  void note(const WatchChecker::News& news, Clock::time_point now);
  void note(Watch& watch, const WatchChecker::Verdict& verdict, std::uint64_t revision,
            Clock::time_point now);
  void apply(const watch_t& message, Clock::time_point now);
  void note_of_former(Watch& watch, const WatchChecker::Verdict& verdict, Clock::time_point now);
  void note_of_offer(Watch& watch, const WatchChecker::Verdict& verdict, Clock::time_point now);
  void apply_offers(Watch& watch, const watched_path_t& path);
  void refuse(const RequestKey& key, const std::string& limit);
  void set_answer(Watch& watch, const WatchableAnswer& answer, std::size_t bytes);
  void make_room(Watch& watch, std::size_t bytes);
  void keep_interpolated(Watch& watch);
  void keep_former(Watch& watch, std::size_t next_bytes);
  void forget_former(Watch& watch, std::size_t which);
  void withdraw_offer(Watch& watch);
  void send_offer(const Watch& watch);
  void improve_soon(Watch& watch, Clock::time_point now);
  void make_news(Watch& watch, Clock::time_point now);
  void plan_at(Watch& watch, Clock::time_point time);
  void schedule(Watch& watch);
  void end(WatchMap::iterator position);
  /// Returns the limit that prevents watching another path; an empty text if there is none.
  [[nodiscard]] std::string limit_hit(const RequestKey& key, bool is_new, std::size_t bytes) const;
  [[nodiscard]] path_state_t state_of(const Watch& watch) const;

  Core& core_;
  const WatchLimits limits_;
  WatchMap watches_;
  std::map<WatchChecker::Id, RequestKey> keys_;
  std::map<std::string, std::size_t> of_client_;
  std::size_t bytes_ = 0;
  /// Newest revision for which all watched paths of a scene were checked, by scene.
  std::map<std::string, std::uint64_t> checked_;
  Times due_;
  Times broken_;      ///< to be planned again, not before that time
  Times improvable_;  ///< to be planned again in hope of a better path, not before that time
  std::optional<RequestKey> improving_;  ///< request that is being planned for a better path
  std::vector<Accepted> accepted_;
  WatchChecker::Id next_id_ = 1;
  std::int64_t next_serial_;
  WatchChecker checker_;  ///< last: its thread ends before all above is destroyed
};

}  // namespace camway::service
