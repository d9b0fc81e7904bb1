// SPDX-License-Identifier: MIT
#include "client/engine/watch_list.h"

#include <algorithm>
#include <utility>

#include <camway/watch_t.hpp>

#include "client/engine/handler.h"
#include "client/engine/heartbeat_limits.h"
#include "client/engine/plan_call.h"
#include "client/messages/convert.h"
#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/utime.h"

namespace camway {
namespace {

/// Renewals within the time of a lease, so that two of them may be lost.
constexpr double kRenewals = 3.0;
/// First wait for the answer to a renewal.
constexpr double kAnswerWait_s = 0.5;
/// Time for the pages of a corrected answer to arrive before they are asked for.
constexpr double kPagesWait_s = 0.3;
/// Waits between attempts to have a path watched.
constexpr double kFirstPause_s = 0.2;
constexpr double kLongestPause_s = 30.0;
constexpr double kGrowth = 2.0;
/// Number of paths that fit a message of the largest size.
constexpr std::size_t kPathsPerMessage = 1800;

Clock::duration seconds(double value) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(value));
}

bool has_proof(const PlanResponse& response) { return response.certified; }

/// Returns whether the response is a final answer of the daemon.
bool is_answer(const PlanResponse& response) {
  return static_cast<int>(response.status) < static_cast<int>(Status::kNoDaemon) &&
         response.status != Status::kOverloaded && response.status != Status::kOldScene;
}

/// Returns the event that an answer came.
WatchEvent answer_event(PlanResponse response) {
  WatchEvent event;
  event.kind = WatchEvent::Kind::kAnswer;
  event.scene_revision = response.scene_revision;
  event.answer = std::move(response);
  return event;
}

/// Returns whether two events kBroken say the same of a path. Unrelated changes of the scene alone
/// do not make a difference; that the scene is gone does.
bool is_same_break(const WatchEvent& a, const WatchEvent& b) {
  const auto is_same_interval = [](const CollisionInterval& x, const CollisionInterval& y) {
    return x.t_begin_s == y.t_begin_s && x.t_end_s == y.t_end_s;
  };
  return (a.scene_revision == 0) == (b.scene_revision == 0) &&
         std::ranges::equal(a.broken, b.broken, is_same_interval);
}

}  // namespace

void WatchList::add(const PlanRequest& request, WatchHandler handler) {
  if (is_closed_) return;
  const std::int64_t id = request.request_id;
  if (watched_.empty()) {
    stepped_at_ = heard_at_ = Clock::now();
    was_heard_ = is_silent_ = false;
  }
  unwanted_.erase(id);
  for (auto& [message, ending] : endings_) std::erase(ending.paths, id);
  const PlanCollector collector(context_.options().client_id, id);
  Watched watched{request, std::move(handler), collector, collector};
  watched.ask_again_s = kFirstPause_s;
  watched_.insert_or_assign(id, std::move(watched));
  if (renew_at_ == Clock::time_point::max()) {
    renewed_at_ = Clock::now();
    renew_at_ = renewed_at_ + seconds(context_.options().watch_lease_s / kRenewals);
  }
}

void WatchList::remove(std::int64_t request_id) {
  // The handler that closed the client still runs, in one of the paths.
  if (is_closed_) return;
  if (watched_.erase(request_id) == 0) return;
  to_acknowledge_.erase(request_id);
  if (watched_.empty()) renew_at_ = Clock::time_point::max();
  unwanted_.insert(request_id);
}

bool WatchList::is_ending(std::int64_t request_id) const {
  return unwanted_.contains(request_id) ||
         std::ranges::any_of(endings_, [request_id](const auto& ending) {
           return std::ranges::find(ending.second.paths, request_id) != ending.second.paths.end();
         });
}

void WatchList::ask(Watched& watched) {
  const std::int64_t id = watched.request.request_id;
  watched.is_asked = true;
  watched.ask_at = Clock::time_point::max();
  watched.collector.clear();
  PlanHandlers handlers;
  handlers.on_answer = [this, id](const PlanResponse& response) { answered(id, response); };
  hooks_.start(std::make_shared<PlanCall>(context_, watched.request, id, std::move(handlers)));
}

void WatchList::answered(std::int64_t request_id, const PlanResponse& response) {
  note_start(response.daemon_start);
  const auto position = watched_.find(request_id);
  if (position == watched_.end()) {
    // The path was removed while it was planned; the daemon watches it since its answer.
    if (has_proof(response)) unwanted_.insert(request_id);
    return;
  }
  Watched& watched = position->second;
  watched.is_asked = false;
  if (!is_answer(response)) {
    ask_later(watched, Clock::now());
    tell_lost(watched, {response.status, response.error});
    return;
  }
  const bool is_first = watched.held_revision < 0;
  if (!is_first && !watched.scene.has_all(response.daemon_start, response.scene_digest)) {
    forget(watched, response);
    return;
  }
  watched.held_revision = response.scene_revision;
  watched.scene.take_answer(response.daemon_start, response.scene_revision, response.scene_digest);
  if (has_proof(response)) {
    take_proof(watched, response, is_first);
  } else if (!is_first && watched.serial != 0) {  // the previous path stays watched
    tell(watched, answer_event(response));
  } else {
    end_without_proof(watched, response);
  }
}

void WatchList::forget(Watched& watched, const PlanResponse& response) {
  // The daemon watches the path since its answer, for nobody.
  if (has_proof(response)) unwanted_.insert(watched.request.request_id);
  watched.is_forgotten = true;
  watched.offer.reset();
  tell_lost(watched, {Status::kOldScene,
                      "scene '" + response.scene +
                          "' is another one: the daemon was started anew and has forgotten "
                          "changes; make them again, then watch the path anew"});
}

void WatchList::take_proof(Watched& watched, const PlanResponse& response, bool is_first) {
  watched.is_broken = false;
  to_acknowledge_.insert(watched.request.request_id);
  if (watched.refusal && !is_first) {
    watched.untold = {answer_event(response)};
    return;
  }
  tell(watched, answer_event(response));
  if (watched.refusal) tell_lost(watched, *watched.refusal);
}

void WatchList::end_without_proof(Watched& watched, const PlanResponse& response) {
  Watched last = std::move(watched);
  remove(last.request.request_id);
  tell(last, answer_event(response));
  WatchEvent end;
  end.kind = WatchEvent::Kind::kEnded;
  end.status = response.status;
  end.error = "there is nothing to watch, as the answer has no proved path: " +
              (response.ok() ? response.message : response.error);
  tell(last, std::move(end));
}

void WatchList::take_answer(std::int64_t request_id, std::span<const std::uint8_t> bytes) {
  const auto position = watched_.find(request_id);
  if (position == watched_.end() || position->second.is_asked) return;
  Watched& watched = position->second;
  if (watched.is_forgotten) return;
  watched.collector.take(bytes);
  if (!watched.collector.complete()) return;
  PlanResponse response = watched.collector.response();
  watched.collector.clear();
  response.request_id = request_id;
  if (!is_answer(response) || response.scene_revision <= watched.held_revision) return;
  watched.ask_at = Clock::time_point::max();
  watched.held_revision = response.scene_revision;
  watched.scene.take_answer(response.daemon_start, response.scene_revision, response.scene_digest);
  if (has_proof(response)) watched.is_broken = false;
  tell(watched, answer_event(std::move(response)));
}

void WatchList::take_offer(std::int64_t request_id, std::span<const std::uint8_t> bytes) {
  const auto position = watched_.find(request_id);
  if (position == watched_.end()) return;
  position->second.offered.take(bytes);
  tell_offer(position->second);
}

/// Reports an offer once the watch report and all pages of the answer have come, in any order.
void WatchList::tell_offer(Watched& watched) {
  if (!watched.offer || watched.offer->is_told || !watched.offered.complete()) return;
  PlanResponse response = watched.offered.response();
  if (response.scene_revision != watched.offer->revision) return;
  response.request_id = watched.request.request_id;
  watched.offered.clear();
  watched.offer->is_told = true;
  watched.offer->ask_at = Clock::time_point::max();
  WatchEvent event;
  event.kind = WatchEvent::Kind::kBetter;
  event.scene_revision = response.scene_revision;
  event.answer = std::move(response);
  tell(watched, std::move(event));
}

void WatchList::take_better(std::int64_t request_id) {
  const auto position = watched_.find(request_id);
  if (position == watched_.end() || !position->second.offer) return;
  Offer& offer = *position->second.offer;
  if (!offer.is_told || std::exchange(offer.is_taken, true)) return;
  offer.ask_at = Clock::time_point{};
  offer.again_s = kFirstPause_s;
}

void WatchList::ask_for_offers(Clock::time_point now) {
  std::vector<watched_path_t> paths;
  for (auto& [id, watched] : watched_) {
    if (!watched.offer || now < watched.offer->ask_at) continue;
    Offer& offer = *watched.offer;
    paths.emplace_back();
    paths.back().request_id = id;
    paths.back().known_serial = watched.serial;
    (offer.is_taken ? paths.back().taken_offer : paths.back().wanted_offer) = offer.revision;
    offer.ask_at = now + seconds(offer.again_s);
    offer.again_s = std::min(kGrowth * offer.again_s, kLongestPause_s);
    if (paths.size() == kPathsPerMessage) {
      send(std::exchange(paths, {}), context_.new_request_id(), 0.0);
    }
  }
  if (!paths.empty()) send(std::move(paths), context_.new_request_id(), 0.0);
}

void WatchList::take_report(std::span<const std::uint8_t> bytes, Clock::time_point now) {
  const auto decoded = wire::decode<watch_report_t>(bytes);
  if (!decoded.message || decoded.message->client_id != context_.options().client_id) return;
  const watch_report_t& report = *decoded.message;
  note_life(now);
  DaemonStart start;
  convert(report.daemon_start, start);
  note_start(start);
  endings_.erase(report.request_id);
  const bool is_renewed = unanswered_.erase(report.request_id) > 0 && unanswered_.empty();
  if (is_renewed) {
    renewed_at_ = now;
    renew_at_ = now + seconds(context_.options().watch_lease_s / kRenewals);
  }
  for (const path_state_t& state : report.paths) take_state(state, report, now);
  if (is_renewed) tell_watched_again();
}

/// Reports kWatched for lost paths: the answer to a renewal does not list paths with a known state.
void WatchList::tell_watched_again() {
  for (auto& [id, watched] : watched_) {
    const bool is_asked_for = watched.is_asked || watched.ask_at != Clock::time_point::max();
    if (!watched.is_lost || watched.is_forgotten || watched.serial == 0 || is_asked_for) continue;
    WatchEvent event;
    event.kind = WatchEvent::Kind::kWatched;
    event.scene_revision = watched.scene_revision;
    tell(watched, std::move(event));
  }
}

void WatchList::take_state(const path_state_t& state, const watch_report_t& report,
                           Clock::time_point now) {
  const auto position = watched_.find(state.request_id);
  if (position == watched_.end() || position->second.is_forgotten) return;
  Watched& watched = position->second;
  DaemonStart start;
  convert(report.daemon_start, start);
  watched.scene.hear(start, std::max(state.scene_revision, state.offer_revision));
  switch (state.state) {
    case path_state_t::UNKNOWN:
      watched.serial = 0;
      watched.offer.reset();
      if (!watched.is_asked && watched.ask_at == Clock::time_point::max()) ask_later(watched, now);
      return;
    case path_state_t::REFUSED:
      watched.serial = 0;
      watched.offer.reset();
      ask_later(watched, now);
      // The request is repeated, but only the first refusal is reported. If it comes before the
      // first answer, it is reported after that.
      if (!watched.refusal) {
        watched.refusal = {Status::kLimit, "the daemon has no room to watch it: " + report.message};
        if (watched.held_revision >= 0) tell_lost(watched, *watched.refusal);
      }
      return;
    case path_state_t::FREE:
    case path_state_t::BROKEN:
      // The answer of a daemon that was started anew tells whether it has forgotten changes.
      if (watched.held_revision >= 0 && !watched.scene.is_continued_by(start)) return;
      to_acknowledge_.insert(state.request_id);
      watched.refusal.reset();
      for (WatchEvent& answer : std::exchange(watched.untold, {})) tell(watched, std::move(answer));
      if (state.serial > watched.serial) take_new_state(watched, state, report, now);
      return;
    default:
      return;
  }
}

void WatchList::take_new_state(Watched& watched, const path_state_t& state,
                               const watch_report_t& report, Clock::time_point now) {
  watched.serial = state.serial;
  watched.ask_again_s = kFirstPause_s;
  if (state.answer_revision > watched.held_revision && !watched.is_asked) {
    watched.ask_at = std::min(watched.ask_at, now + seconds(kPagesWait_s));
  }
  take_offer_state(watched, state, now);
  // The state is of an earlier answer: its report was overtaken.
  if (state.answer_revision < watched.held_revision) return;
  WatchEvent event;
  event.scene_revision = state.scene_revision;
  if (state.state == path_state_t::BROKEN) {
    event.kind = WatchEvent::Kind::kBroken;
    for (const broken_interval_t& interval : report.intervals) {
      if (interval.request_id != state.request_id) continue;
      event.broken.push_back({interval.t_begin_s, interval.t_end_s, std::nullopt});
    }
    // The daemon numbers the state anew with each answer. After one without a proved path, it is
    // the state that the handler has heard of.
    const bool is_told =
        watched.is_broken && !watched.is_lost && is_same_break(event, watched.last_break);
    watched.is_broken = true;
    if (is_told) return;
    watched.last_break = event;
    tell(watched, std::move(event));
  } else if (watched.is_broken && state.answer_revision == watched.held_revision) {
    event.kind = WatchEvent::Kind::kFree;
    watched.is_broken = false;
    tell(watched, std::move(event));
  }
}

void WatchList::take_offer_state(Watched& watched, const path_state_t& state,
                                 Clock::time_point now) {
  const std::int64_t before = watched.offer ? watched.offer->revision : 0;
  if (state.offer_revision == before) return;
  const bool was_told = watched.offer && watched.offer->is_told;
  watched.offer.reset();
  if (state.offer_revision != 0) {
    watched.offer = Offer{state.offer_revision, now + seconds(kPagesWait_s), kPagesWait_s};
    tell_offer(watched);
    return;
  }
  // Other events already report a path that breaks, and an offer that became the answer.
  const bool is_current = state.answer_revision <= watched.held_revision;
  if (!was_told || state.state != path_state_t::FREE || !is_current ||
      watched.held_revision >= before) {
    return;
  }
  WatchEvent event;
  event.kind = WatchEvent::Kind::kWithdrawn;
  event.scene_revision = state.scene_revision;
  tell(watched, std::move(event));
}

void WatchList::ask_later(Watched& watched, Clock::time_point now) {
  watched.ask_at = now + seconds(watched.ask_again_s);
  watched.ask_again_s = std::min(kGrowth * watched.ask_again_s, kLongestPause_s);
}

void WatchList::note_life(Clock::time_point now) {
  heard_at_ = std::max(heard_at_, now);
  was_heard_ = true;
  // The daemon may still watch the paths, or may have restarted.
  if (std::exchange(is_silent_, false)) renew_at_ = now;
}

void WatchList::take_heartbeat(const DaemonStatus& status, Clock::time_point now) {
  note_life(now);
  note_start(status.daemon_start);
  for (auto& [id, watched] : watched_) {
    const auto scene = std::ranges::find(status.scenes, watched.request.scene, &SceneInfo::name);
    if (scene != status.scenes.end()) watched.scene.hear(status.daemon_start, scene->revision);
  }
  // A daemon that started after the last renewal does not know the watched paths.
  if (!watched_.empty() &&
      std::chrono::duration<double>(now - renewed_at_).count() > status.uptime_s) {
    renewed_at_ = now;
    renew_at_ = now;
  }
}

void WatchList::note_start(const DaemonStart& start) {
  if (start.id == 0) return;
  const bool is_first = starts_.empty();
  if (!starts_.insert(start.id).second || is_first) return;
  renew_at_ = Clock::time_point{};
  // A handler may remove paths.
  std::vector<std::int64_t> ids;
  for (const auto& [id, watched] : watched_) ids.push_back(id);
  for (const std::int64_t id : ids) {
    const auto position = watched_.find(id);
    if (position == watched_.end() || position->second.held_revision < 0) continue;
    Watched& watched = position->second;
    if (watched.is_forgotten) continue;
    // It must not answer for a scene that it has forgotten changes of.
    watched.request.least_revision =
        std::max(watched.request.least_revision, watched.scene.newest_revision());
    WatchEvent event;
    event.kind = WatchEvent::Kind::kRestarted;
    event.scene_revision = watched.scene_revision;
    tell(watched, std::move(event));
  }
}

void WatchList::step(Clock::time_point now) {
  for (auto& [id, watched] : watched_) {
    if (!watched.is_asked && now >= watched.ask_at) ask(watched);
  }
  look_for_life(now);
  if (now >= renew_at_) renew(now);
  acknowledge();
  ask_for_offers(now);
  end_unwanted(now);
}

void WatchList::look_for_life(Clock::time_point now) {
  const Clock::duration elsewhere = now - std::exchange(stepped_at_, now) - seconds(kLongestStep_s);
  heard_at_ += std::max(elsewhere, Clock::duration::zero());
  if (watched_.empty() || is_silent_) return;
  if (now >= heard_at_ + seconds(kSilence_s)) {
    is_silent_ = true;
    lose_all(was_heard_ ? context_.silence(kSilence_s)
                        : context_.explain(Outcome::kSilence, false, {}, {}));
  } else if (now >= heard_at_ + seconds(kPingAfter_s) && now >= ping_at_) {
    ping_at_ = now + seconds(kPingAgain_s);
    send({}, context_.new_request_id(), 0.0);
  }
}

Clock::time_point WatchList::wake() const {
  if (!to_acknowledge_.empty() || !unwanted_.empty()) return Clock::time_point{};
  Clock::time_point next = renew_at_;
  for (const auto& [id, ending] : endings_) next = std::min(next, ending.send_at);
  for (const auto& [id, watched] : watched_) {
    if (!watched.is_asked) next = std::min(next, watched.ask_at);
    if (watched.offer) next = std::min(next, watched.offer->ask_at);
  }
  if (!watched_.empty() && !is_silent_) {
    const Clock::time_point ping_at = std::max(heard_at_ + seconds(kPingAfter_s), ping_at_);
    next = std::min({next, heard_at_ + seconds(kSilence_s), ping_at});
  }
  return next;
}

void WatchList::renew(Clock::time_point now) {
  const double lease_s = context_.options().watch_lease_s;
  const bool was_answered = unanswered_.empty();
  renew_again_s_ =
      was_answered ? kAnswerWait_s : std::min(kGrowth * renew_again_s_, lease_s / kRenewals);
  renew_at_ = now + seconds(renew_again_s_);
  unanswered_.clear();
  std::vector<watched_path_t> paths;
  const auto flush = [&] {
    if (paths.empty()) return;
    const std::int64_t id = context_.new_request_id();
    unanswered_.insert(id);
    send(std::exchange(paths, {}), id, 0.0);
  };
  for (const auto& [id, watched] : watched_) {
    if (watched.held_revision < 0 || watched.is_forgotten) continue;  // it is not watched
    paths.emplace_back();
    paths.back().request_id = id;
    paths.back().known_serial = watched.serial;
    if (paths.size() == kPathsPerMessage) flush();
  }
  flush();
  // The lease is over, even if the daemon is heard otherwise.
  if (now - renewed_at_ >= seconds(lease_s)) {
    lose_all(context_.explain(Outcome::kSilence, was_heard_, {}, {}));
  }
}

void WatchList::lose_all(const Failure& why) {
  // A handler may remove paths.
  std::vector<std::int64_t> ids;
  for (const auto& [id, watched] : watched_) ids.push_back(id);
  for (const std::int64_t id : ids) {
    const auto position = watched_.find(id);
    if (position != watched_.end()) tell_lost(position->second, why);
  }
}

void WatchList::acknowledge() {
  std::vector<watched_path_t> paths;
  for (const std::int64_t id : std::exchange(to_acknowledge_, {})) {
    const auto position = watched_.find(id);
    if (position == watched_.end()) continue;
    paths.emplace_back();
    paths.back().request_id = id;
    paths.back().known_serial = position->second.serial;
    if (paths.size() == kPathsPerMessage)
      send(std::exchange(paths, {}), context_.new_request_id(), 0.0);
  }
  if (!paths.empty()) send(std::move(paths), context_.new_request_id(), 0.0);
}

void WatchList::end_unwanted(Clock::time_point now) {
  const Clock::time_point give_up_at = now + seconds(context_.options().watch_lease_s);
  while (!unwanted_.empty()) {
    Ending& ending =
        endings_.try_emplace(context_.new_request_id(), Ending{{}, now, give_up_at, kFirstPause_s})
            .first->second;
    while (!unwanted_.empty() && ending.paths.size() < kPathsPerMessage) {
      ending.paths.push_back(unwanted_.extract(unwanted_.begin()).value());
    }
  }
  std::erase_if(endings_, [now](const auto& ending) {
    return ending.second.paths.empty() || now >= ending.second.give_up_at;
  });
  for (auto& [id, ending] : endings_) {
    if (now < ending.send_at) continue;
    std::vector<watched_path_t> paths(ending.paths.size());
    for (std::size_t i = 0; i < paths.size(); ++i) paths[i].request_id = ending.paths[i];
    send(std::move(paths), id, -1.0);
    ending.send_at = now + seconds(ending.again_s);
    ending.again_s *= kGrowth;
  }
}

void WatchList::send(std::vector<watched_path_t> paths, std::int64_t id, double lease_s) {
  watch_t message{};
  message.client_id = context_.options().client_id;
  message.request_id = id;
  message.utime = wire::utime_now();
  message.lease_s = lease_s;
  message.paths = std::move(paths);
  message.num_paths = static_cast<std::int32_t>(message.paths.size());
  hooks_.send({context_.channels().watch(), wire::encode(message)});
}

void WatchList::tell(Watched& watched, WatchEvent event) {
  watched.is_lost = event.kind == WatchEvent::Kind::kLost;
  if (!watched.is_lost) watched.scene_revision = event.scene_revision;
  if (is_closed_) return;
  event.request_id = watched.request.request_id;
  call_handler(watched.handler, event);
}

void WatchList::tell_lost(Watched& watched, const Failure& why) {
  if (watched.is_lost) return;
  WatchEvent event;
  event.kind = WatchEvent::Kind::kLost;
  event.status = why.status;
  event.error = why.error;
  tell(watched, std::move(event));
}

}  // namespace camway
