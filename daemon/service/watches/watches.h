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

#include "daemon/messages/answer_pages.h"
#include "daemon/service/core/core.h"
#include "daemon/service/watches/answer_quality.h"
#include "daemon/service/watches/watch_checker.h"
#include "daemon/service/watches/watch_limits.h"

namespace camway::service {

/// An answer whose path can be watched.
struct WatchableAnswer {
  RequestKey key;
  std::shared_ptr<const plan_request_t> request;
  std::shared_ptr<const planning::WatchedPath> path;
  std::shared_ptr<const scene::Snapshot> proved_in;
  AnswerQuality quality;
};

/// The answered paths that clients left with the daemon: who wants to hear of them for how long,
/// what became of them, and what of that each client knows. A path is watched until its lease ends
/// unless the client renews it. News is told at once, and again with longer and longer pauses until
/// the client says that it knows: so messages may be lost, and a client or the daemon may be
/// started anew.
///
/// A path that replaced a broken one stays when the obstacle goes. So of the paths before it the
/// first and the last are looked after too: when one of them collides less than it did, the request
/// is planned again, one at a time and of each path rarely, and an answer that is better (see
/// `is_better`) is put on offer. It is the client who takes it, or not; an offer that a change
/// breaks is withdrawn. The loop thread calls everything here.
class Watches {
 public:
  using Clock = std::chrono::steady_clock;

  /// `core` and `scenes` must outlive this.
  Watches(Core& core, scene::SceneStore& scenes, const WatchLimits& limits);

  /// Watches the path of a first answer, or another one in the place of what is watched under that
  /// key. False where a limit is in the way, which the client is told.
  bool begin(const WatchableAnswer& answer, Clock::time_point now);

  /// The client asked again: begins the lease anew and tells all. False if nothing is watched under
  /// that key.
  bool renew(const RequestKey& key, Clock::time_point now);

  /// A message on the watch channel. Throws only for want of memory.
  void on_message(std::span<const std::uint8_t> message);

  /// Tells what is due, and ends leases.
  void tick(Clock::time_point now);
  /// When `tick` or `take_broken` has something to do next, work that is due already apart; the end
  /// of time if never.
  [[nodiscard]] Clock::time_point next_tick(Clock::time_point now) const;

  struct Request {
    RequestKey key;
    std::shared_ptr<const plan_request_t> request;
  };
  /// Up to `most` requests whose paths collide now, to be planned again. Of each, `ended` or
  /// `not_planned` has to be told.
  std::vector<Request> take_broken(std::size_t most, Clock::time_point now);
  /// It was planned. Whether the path collides still, so that the answer is worth sending; then
  /// `begin` or `answered` has to be told.
  bool ended(const RequestKey& key);
  /// It was not planned: to be tried again a little later.
  void not_planned(const RequestKey& key, Clock::time_point now);
  /// An answer was sent that proves no path: the one before is watched on.
  void answered(const RequestKey& key, std::int64_t answer_revision, Clock::time_point now);

  /// A request whose path is free, but for which there may be a better one by now. Before the next
  /// is taken, `offer`, `no_offer` or `not_improved` has to be told of it.
  std::optional<Request> take_improvable(Clock::time_point now);
  /// It was planned, and this is the answer: an offer, if it is better.
  void offer(const WatchableAnswer& answer, Pages pages, Clock::time_point now);
  /// It was planned, and the answer proves no path.
  void no_offer(const RequestKey& key, Clock::time_point now);
  /// It was not planned: to be tried again later.
  void not_improved(const RequestKey& key, Clock::time_point now);

  /// An offer that a client took: the answer to its request from now on. Of each, `begin` has to be
  /// told.
  struct Taken {
    WatchableAnswer answer;
    Pages pages;
  };
  std::vector<Taken> take_taken();

 private:
  enum class Planning : std::uint8_t { kNot, kWaits, kRuns };
  /// A better path is looked for of each path no more often; the longer, the more often in vain.
  static constexpr std::chrono::milliseconds kFirstImprovePause{1000};
  /// A path that was watched before.
  struct Former {
    WatchChecker::Id id = 0;
    std::size_t bytes = 0;
    double colliding_s = 0.0;  ///< for how much of its time it collides
  };
  struct Offer {
    WatchableAnswer answer;
    Pages pages;
    WatchChecker::Id id = 0;
    std::size_t bytes = 0;
    bool is_checked = false;  ///< and free: it is told of
  };
  struct Watch {
    WatchableAnswer answer;
    WatchChecker::Id id = 0;
    std::size_t bytes = 0;
    Clock::duration lease{};
    Clock::time_point until;
    bool is_checked = false;  ///< a verdict has come
    std::vector<collision::CollisionInterval> collisions;
    std::uint64_t revision = 0;  ///< that they hold for
    std::int64_t answer_revision = 0;
    std::int64_t serial = 0;  ///< of the newest state
    bool is_known = false;    ///< by the client
    Clock::time_point tell_at;
    Clock::duration pause{};  ///< until it is told again
    Planning planning = Planning::kNot;
    bool is_outdated = false;  ///< what is being planned; something near the path has changed since
    Clock::time_point due;     ///< its place in `due_`
    std::vector<Former> formers;  ///< the first, and the one before this
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
  void make_room(Watch& watch, std::size_t bytes);
  void keep_former(Watch& watch, std::size_t next_bytes);
  void forget_former(Watch& watch, std::size_t which);
  void withdraw_offer(Watch& watch);
  void send_offer(const Watch& watch);
  void improve_soon(Watch& watch, Clock::time_point now);
  void make_news(Watch& watch, Clock::time_point now);
  void plan_at(Watch& watch, Clock::time_point time);
  void schedule(Watch& watch);
  void end(WatchMap::iterator position);
  /// What speaks against another path, or nothing.
  [[nodiscard]] std::string limit_hit(const RequestKey& key, bool is_new, std::size_t bytes) const;
  [[nodiscard]] path_state_t state_of(const Watch& watch) const;

  Core& core_;
  const WatchLimits limits_;
  WatchMap watches_;
  std::map<WatchChecker::Id, RequestKey> keys_;
  std::map<std::string, std::size_t> of_client_;
  std::size_t bytes_ = 0;
  std::map<std::string, std::uint64_t>
      checked_;  ///< revision that all paths of a scene were brought to
  Times due_;
  Times broken_;                         ///< to be planned, not before
  Times improvable_;                     ///< likewise, in hope of a better path
  std::optional<RequestKey> improving_;  ///< which is being planned for that
  std::vector<Taken> taken_;
  WatchChecker::Id next_id_ = 1;
  std::int64_t next_serial_;
  WatchChecker checker_;  ///< last: its thread ends before all above goes
};

}  // namespace camway::service
