// SPDX-License-Identifier: MIT
#include "daemon/service/watches/watches.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "daemon/service/watches/watch_reports.h"

namespace camway::service {
namespace {

using std::chrono::milliseconds;

/// A state that is not confirmed is sent again after the first pause, then after twice the pause
/// each time, up to the longest: three times within a status period.
constexpr milliseconds kFirstPause{200};
constexpr milliseconds kLongestPause{5000};
/// How long planning waits after a full queue refused it.
constexpr milliseconds kPlanAgainIn{500};
/// Pause after a change before a better path is looked for, in case another change follows.
constexpr milliseconds kSettle{100};
constexpr milliseconds kLongestImprovePause{30'000};
/// Number of former answers whose paths are kept for each watched path.
constexpr std::size_t kFormers = 2;

std::chrono::steady_clock::duration lease_of(double lease_s, milliseconds most) {
  const std::chrono::duration<double> asked(lease_s);
  // An infinite number of seconds has no duration.
  if (!(asked < most)) return most;
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(asked);
}

path_state_t unwatched(std::int64_t request_id, std::int8_t state) {
  path_state_t none{};
  none.request_id = request_id;
  none.state = state;
  return none;
}

/// Returns the sum of the lengths of all intervals.
double length_s(const std::vector<collision::CollisionInterval>& intervals) {
  double length_s = 0.0;
  for (const collision::CollisionInterval& interval : intervals) {
    length_s += interval.t_end_s - interval.t_begin_s;
  }
  return length_s;
}

/// Returns a random first number, so that the numbers of another daemon are not taken for ours.
std::int64_t random_serial() {
  std::random_device device;
  return static_cast<std::int64_t>(device()) << 20U;
}

}  // namespace

Watches::Watches(Core& core, scene::SceneStore& scenes, const WatchLimits& limits)
    : core_(core),
      limits_(limits),
      next_serial_(random_serial() + 1),
      checker_(scenes, [this](WatchChecker::News news) {
        core_.mailbox.post([this, news = std::move(news)] { note(news, Clock::now()); });
      }) {}

bool Watches::begin(const WatchableAnswer& answer, Clock::time_point now) {
  const RequestKey& key = answer.key;
  const std::size_t bytes =
      answer.path->memory_bytes() + static_cast<std::size_t>(answer.request->getEncodedSize());
  auto position = watches_.find(key);
  const bool is_new = position == watches_.end();
  if (!is_new) {
    bytes_ -= position->second.bytes;
    make_room(position->second, bytes);
  }
  if (const std::string limit = limit_hit(key, is_new, bytes); !limit.empty()) {
    if (!is_new) {
      bytes_ += position->second.bytes;
      end(position);
    }
    refuse(key, limit);
    return false;
  }
  if (is_new) {
    position = watches_.try_emplace(key).first;
    ++of_client_[key.client_id];
    position->second.lease = lease_of(answer.request->watch_lease_s, limits_.longest_lease);
    position->second.until = now + position->second.lease;
  } else {
    keep_former(position->second, bytes);
  }
  set_answer(position->second, answer, bytes);
  if (is_new) keep_interpolated(position->second);
  position->second.answer.interpolated.reset();
  make_news(position->second, now);
  core_.counters.watched_paths = static_cast<std::int32_t>(watches_.size());
  return true;
}

/// Says that a path is not watched because of a limit.
void Watches::refuse(const RequestKey& key, const std::string& limit) {
  core_.limited_log.refused.write(
      "path is not watched",
      {{"client", key.client_id}, {"request", key.request_id}, {"reason", limit}});
  WatchReports report(core_, key.client_id, 0);
  report.add(unwatched(key.request_id, path_state_t::REFUSED));
  report.explain(limit);
  report.finish();
}

/// Makes the path of `answer` the one that is watched, and has it checked.
void Watches::set_answer(Watch& watch, const WatchableAnswer& answer, std::size_t bytes) {
  watch.answer = answer;
  watch.bytes = bytes;
  bytes_ += bytes;
  watch.id = next_id_++;
  keys_.emplace(watch.id, answer.key);
  watch.is_checked = false;
  watch.collisions.clear();
  watch.revision = static_cast<std::uint64_t>(answer.revision);
  watch.answer_revision = answer.revision;
  checker_.watch(watch.id, answer.request->scene, answer.path, answer.proved_in);
}

std::string Watches::limit_hit(const RequestKey& key, bool is_new, std::size_t bytes) const {
  if (bytes_ + bytes > limits_.bytes) {
    return fmt::format("watch.bytes: the paths that are watched take {} bytes, {} at most", bytes_,
                       limits_.bytes);
  }
  if (!is_new) return {};
  if (watches_.size() >= limits_.paths) {
    return fmt::format("watch.paths: {} paths are watched already", watches_.size());
  }
  const auto count = of_client_.find(key.client_id);
  if (count != of_client_.end() && count->second >= limits_.paths_of_a_client) {
    return fmt::format("watch.paths_of_a_client: {} paths of this client are watched already",
                       count->second);
  }
  return {};
}

bool Watches::renew(const RequestKey& key, Clock::time_point now) {
  const auto position = watches_.find(key);
  if (position == watches_.end()) return false;
  position->second.until = now + position->second.lease;
  position->second.is_known = false;
  position->second.tell_at = now;
  schedule(position->second);
  return true;
}

void Watches::on_message(std::span<const std::uint8_t> bytes) {
  const std::string channel = core_.channels.watch();
  const auto message = core_.read<watch_t>(channel, bytes);
  if (!message) return;
  if (std::isnan(message->lease_s)) {
    constexpr std::string_view kReason = "watch_t.lease_s: is not a number";
    if (core_.note_malformed(channel, bytes.size(), kReason)) {
      core_.report_unanswerable(channel, bytes, kReason);
    }
    return;
  }
  apply(*message, Clock::now());
}

void Watches::apply(const watch_t& message, Clock::time_point now) {
  WatchReports report(core_, message.client_id, message.request_id);
  for (const watched_path_t& path : message.paths) {
    const auto position = watches_.find(RequestKey{message.client_id, path.request_id});
    if (position == watches_.end()) {
      if (message.lease_s >= 0.0) report.add(unwatched(path.request_id, path_state_t::UNKNOWN));
      continue;
    }
    if (message.lease_s < 0.0) {
      end(position);
      continue;
    }
    Watch& watch = position->second;
    if (message.lease_s > 0.0) {
      watch.lease = lease_of(message.lease_s, limits_.longest_lease);
    }
    watch.until = now + watch.lease;
    apply_offers(watch, path);
    watch.is_known = path.known_serial == watch.serial;
    if (!watch.is_known) {
      report.add(state_of(watch), watch.collisions);
      watch.pause = kFirstPause;
      watch.tell_at = now + watch.pause;
    }
    schedule(watch);
  }
  report.finish();
}

void Watches::tick(Clock::time_point now) {
  std::map<std::string, WatchReports> reports;
  while (!due_.empty() && due_.begin()->first <= now) {
    const auto position = watches_.find(due_.begin()->second);
    Watch& watch = position->second;
    if (now >= watch.until) {
      core_.limited_log.watches.write(
          "lease of watched path is over",
          {{"client", position->first.client_id}, {"request", position->first.request_id}});
      end(position);
      continue;
    }
    const std::string& client = position->first.client_id;
    reports.try_emplace(client, core_, client, 0)
        .first->second.add(state_of(watch), watch.collisions);
    watch.tell_at = now + watch.pause;
    watch.pause = std::min<Clock::duration>(2 * watch.pause, kLongestPause);
    schedule(watch);
  }
  for (auto& [client, report] : reports) report.finish();
}

Watches::Clock::time_point Watches::next_tick(Clock::time_point now) const {
  Clock::time_point next = due_.empty() ? Clock::time_point::max() : due_.begin()->first;
  const auto later = broken_.upper_bound({now, RequestKey{}});
  if (later != broken_.end()) next = std::min(next, later->first);
  const auto improvable = improvable_.upper_bound({now, RequestKey{}});
  if (improvable != improvable_.end()) next = std::min(next, improvable->first);
  return next;
}

std::vector<Watches::Request> Watches::take_broken(std::size_t most, Clock::time_point now) {
  std::vector<Request> taken;
  while (taken.size() < most && !broken_.empty() && broken_.begin()->first <= now) {
    const RequestKey key = broken_.begin()->second;
    broken_.erase(broken_.begin());
    const auto position = watches_.find(key);
    if (position == watches_.end()) continue;
    Watch& watch = position->second;
    // Otherwise the time is that of a watch of the same request that has ended.
    if (watch.planning != Planning::kWaits) continue;
    const bool is_wanted = !watch.collisions.empty();
    watch.planning = is_wanted ? Planning::kRuns : Planning::kNot;
    watch.is_outdated = false;
    if (is_wanted) taken.push_back({key, watch.answer.request});
  }
  return taken;
}

bool Watches::planned(const RequestKey& key) {
  const auto position = watches_.find(key);
  if (position == watches_.end()) return false;
  position->second.planning = Planning::kNot;
  return !position->second.collisions.empty();
}

void Watches::not_planned(const RequestKey& key, Clock::time_point now) {
  const auto position = watches_.find(key);
  if (position == watches_.end()) return;
  position->second.planning = Planning::kNot;
  if (!position->second.collisions.empty()) plan_at(position->second, now + kPlanAgainIn);
}

void Watches::answered(const RequestKey& key, std::int64_t answer_revision, Clock::time_point now) {
  const auto position = watches_.find(key);
  if (position == watches_.end()) return;
  Watch& watch = position->second;
  watch.answer_revision = answer_revision;
  make_news(watch, now);
  if (watch.is_outdated) plan_at(watch, now);
}

void Watches::note(const WatchChecker::News& news, Clock::time_point now) {
  for (const WatchChecker::Verdict& verdict : news.verdicts) {
    const auto key = keys_.find(verdict.id);
    if (key == keys_.end()) continue;
    Watch& watch = watches_.at(key->second);
    if (verdict.id == watch.id) {
      note(watch, verdict, news.revision, now);
    } else if (watch.offer && verdict.id == watch.offer->id) {
      note_of_offer(watch, verdict, now);
    } else {
      note_of_former(watch, verdict, now);
    }
  }
  if (!news.is_last) return;
  if (news.revision == 0) {
    checked_.erase(news.scene);
  } else {
    checked_[news.scene] = news.revision;
  }
}

void Watches::note(Watch& watch, const WatchChecker::Verdict& verdict, std::uint64_t revision,
                   Clock::time_point now) {
  const bool was_free = watch.collisions.empty();
  const bool is_first = !std::exchange(watch.is_checked, true);
  watch.collisions = verdict.collisions;
  watch.revision = revision;
  watch.is_outdated = true;
  const bool is_free = watch.collisions.empty();
  if (is_first && is_free) return;  // the client was told so when the watch began
  if (was_free && !is_free) {
    ++core_.counters.broken_paths;
    withdraw_offer(watch);  // the path that is planned now is as good
    core_.limited_log.watches.write("watched path collides",
                                    {{"client", watch.answer.key.client_id},
                                     {"request", watch.answer.key.request_id},
                                     {"scene", watch.answer.request->scene},
                                     {"revision", revision},
                                     {"t_begin_s", watch.collisions.front().t_begin_s}});
  }
  make_news(watch, now);
  // Without its scene there is nothing to plan in.
  if (!is_free && revision != 0 && watch.planning == Planning::kNot) plan_at(watch, now);
}

void Watches::note_of_former(Watch& watch, const WatchChecker::Verdict& verdict,
                             Clock::time_point now) {
  const auto former = std::ranges::find(watch.formers, verdict.id, &Former::id);
  const double before_s = std::exchange(former->colliding_s, length_s(verdict.collisions));
  if (former->colliding_s < (1.0 - kBetterShare) * before_s) improve_soon(watch, now);
}

void Watches::note_of_offer(Watch& watch, const WatchChecker::Verdict& verdict,
                            Clock::time_point now) {
  const bool was_told = std::exchange(watch.offer->is_checked, true);
  if (verdict.collisions.empty()) {
    send_offer(watch);
  } else {
    withdraw_offer(watch);
    if (!was_told) return;
  }
  make_news(watch, now);
}

void Watches::send_offer(const Watch& watch) {
  core_.outbox.add(core_.channels.plan_offer(watch.answer.key.client_id), watch.offer->pages);
}

void Watches::withdraw_offer(Watch& watch) {
  if (!watch.offer) return;
  checker_.forget(watch.offer->id, watch.answer.request->scene);
  keys_.erase(watch.offer->id);
  bytes_ -= watch.offer->bytes;
  watch.offer.reset();
}

void Watches::forget_former(Watch& watch, std::size_t which) {
  const Former& former = watch.formers[which];
  checker_.forget(former.id, watch.answer.request->scene);
  keys_.erase(former.id);
  bytes_ -= former.bytes;
  watch.formers.erase(watch.formers.begin() + static_cast<std::ptrdiff_t>(which));
}

// Drops what could only lead to a better path first.
void Watches::make_room(Watch& watch, std::size_t bytes) {
  withdraw_offer(watch);
  if (bytes_ + bytes <= limits_.bytes) return;
  while (!watch.formers.empty()) forget_former(watch, 0);
}

/// Has the path as interpolated checked, too, if it collides. A better one may be found when it
/// collides less.
void Watches::keep_interpolated(Watch& watch) {
  // The checker shares the path from now on.
  const auto path = std::exchange(watch.answer.interpolated, nullptr);
  if (!path || bytes_ + path->memory_bytes() > limits_.bytes) return;
  const WatchChecker::Id id = next_id_++;
  keys_.emplace(id, watch.answer.key);
  watch.formers.push_back({id, true, path->memory_bytes(), watch.answer.colliding_s});
  bytes_ += path->memory_bytes();
  checker_.watch(id, watch.answer.request->scene, path, nullptr);
}

/// Keeps the present path of `watch` in the checker, although one of `next_bytes` replaces it, if
/// it may become better than that one.
void Watches::keep_former(Watch& watch, std::size_t next_bytes) {
  // A plan of today is no worse than former paths that are free.
  for (std::size_t i = watch.formers.size(); i-- > 0;) {
    if (watch.formers[i].colliding_s == 0.0) forget_former(watch, i);
  }
  const std::size_t bytes = watch.answer.path->memory_bytes();
  if (watch.collisions.empty() || bytes_ + next_bytes + bytes > limits_.bytes) {
    checker_.forget(watch.id, watch.answer.request->scene);
    keys_.erase(watch.id);
    return;
  }
  const auto answers = std::ranges::count(watch.formers, false, &Former::is_interpolated);
  if (std::cmp_equal(answers, kFormers)) forget_former(watch, watch.formers.size() - 1);
  watch.formers.push_back({watch.id, false, bytes, length_s(watch.collisions)});
  bytes_ += bytes;
}

void Watches::improve_soon(Watch& watch, Clock::time_point now) {
  if (watch.improve_at) return;
  watch.improve_at = std::max<Clock::time_point>(now + kSettle, watch.improve_not_before);
  improvable_.insert({*watch.improve_at, watch.answer.key});
}

std::optional<Watches::Request> Watches::take_improvable(Clock::time_point now) {
  while (!improving_ && !improvable_.empty() && improvable_.begin()->first <= now) {
    const RequestKey key = improvable_.begin()->second;
    improvable_.erase(improvable_.begin());
    Watch& watch = watches_.at(key);
    watch.improve_at.reset();
    // A path that collides is planned again anyway.
    if (!watch.collisions.empty() || watch.planning != Planning::kNot) continue;
    improving_ = key;
    return Request{key, watch.answer.request};
  }
  return std::nullopt;
}

void Watches::offer(const WatchableAnswer& answer, Pages pages, Clock::time_point now) {
  no_offer(answer.key, now);
  const auto position = watches_.find(answer.key);
  if (position == watches_.end()) return;
  Watch& watch = position->second;
  if (!watch.collisions.empty() || watch.planning != Planning::kNot) return;
  const AnswerQuality& best = watch.offer ? watch.offer->answer.quality : watch.answer.quality;
  const bool is_newer = answer.revision > watch.answer_revision;
  std::size_t bytes = answer.path->memory_bytes();
  for (const Bytes& page : *pages) bytes += page.size();
  if (!is_newer || !is_better(answer.quality, best, answer.request->objective) ||
      bytes_ + bytes > limits_.bytes) {
    return;
  }
  withdraw_offer(watch);
  watch.improve_pause = kFirstImprovePause;
  watch.offer = Offer{answer, std::move(pages), next_id_++, bytes};
  bytes_ += bytes;
  keys_.emplace(watch.offer->id, answer.key);
  checker_.watch(watch.offer->id, answer.request->scene, answer.path, answer.proved_in);
  core_.limited_log.watches.write("better path on offer", {{"client", answer.key.client_id},
                                                           {"request", answer.key.request_id},
                                                           {"scene", answer.request->scene},
                                                           {"revision", answer.revision}});
}

void Watches::no_offer(const RequestKey& key, Clock::time_point now) {
  improving_.reset();
  const auto position = watches_.find(key);
  if (position == watches_.end()) return;
  Watch& watch = position->second;
  watch.improve_not_before = now + watch.improve_pause;
  watch.improve_pause = std::min<Clock::duration>(2 * watch.improve_pause, kLongestImprovePause);
}

void Watches::not_improved(const RequestKey& key, Clock::time_point now) {
  no_offer(key, now);
  const auto position = watches_.find(key);
  if (position != watches_.end()) improve_soon(position->second, now);
}

/// Handles the client's reply to an offer.
void Watches::apply_offers(Watch& watch, const watched_path_t& path) {
  if (!watch.offer || !watch.offer->is_checked) return;
  const std::int64_t revision = watch.offer->answer.revision;
  if (path.taken_offer == revision) {
    accepted_.push_back({watch.offer->answer, watch.offer->pages});
    withdraw_offer(watch);
  } else if (path.wanted_offer == revision) {
    send_offer(watch);
  }
}

std::vector<Watches::Accepted> Watches::take_accepted() {
  // A watch may have ended since.
  std::erase_if(accepted_,
                [this](const Accepted& taken) { return !watches_.contains(taken.answer.key); });
  return std::exchange(accepted_, {});
}

void Watches::make_news(Watch& watch, Clock::time_point now) {
  watch.serial = next_serial_++;
  watch.is_known = false;
  watch.tell_at = now;
  watch.pause = kFirstPause;
  schedule(watch);
}

void Watches::plan_at(Watch& watch, Clock::time_point time) {
  watch.planning = Planning::kWaits;
  broken_.insert({time, watch.answer.key});
}

void Watches::schedule(Watch& watch) {
  due_.erase({watch.due, watch.answer.key});
  watch.due = watch.is_known ? watch.until : std::min(watch.until, watch.tell_at);
  due_.insert({watch.due, watch.answer.key});
}

void Watches::end(WatchMap::iterator position) {
  Watch& watch = position->second;
  withdraw_offer(watch);
  while (!watch.formers.empty()) forget_former(watch, 0);
  if (watch.improve_at) improvable_.erase({*watch.improve_at, position->first});
  due_.erase({watch.due, position->first});
  checker_.forget(watch.id, watch.answer.request->scene);
  keys_.erase(watch.id);
  bytes_ -= watch.bytes;
  const auto count = of_client_.find(position->first.client_id);
  if (--count->second == 0) of_client_.erase(count);
  watches_.erase(position);
  core_.counters.watched_paths = static_cast<std::int32_t>(watches_.size());
}

path_state_t Watches::state_of(const Watch& watch) const {
  path_state_t state{};
  state.request_id = watch.answer.key.request_id;
  state.serial = watch.serial;
  state.state = watch.collisions.empty() ? path_state_t::FREE : path_state_t::BROKEN;
  std::uint64_t revision = watch.revision;
  const auto checked = checked_.find(watch.answer.request->scene);
  if (watch.is_checked && revision != 0 && checked != checked_.end()) {
    revision = std::max(revision, checked->second);
  }
  state.scene_revision = static_cast<std::int64_t>(revision);
  state.answer_revision = watch.answer_revision;
  if (watch.offer && watch.offer->is_checked) {
    state.offer_revision = watch.offer->answer.revision;
  }
  return state;
}

}  // namespace camway::service
