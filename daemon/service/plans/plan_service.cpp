// SPDX-License-Identifier: MIT
#include "daemon/service/plans/plan_service.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>

#include <camway/cancel_t.hpp>
#include <camway/missing_pages_t.hpp>
#include <camway/plan_progress_t.hpp>

#include "daemon/messages/text.h"
#include "daemon/service/plans/plan_answer.h"

namespace camway::service {
namespace {

constexpr double kMillisecondsPerSecond = 1e3;

/// Checks the members that concern the handling of a request, which planning does not see. Returns
/// an error or an empty text.
std::string fault_of_handling(const plan_request_t& request) {
  for (const auto& [name, value] : {std::pair{"deadline_s", request.deadline_s},
                                    std::pair{"progress_period_s", request.progress_period_s},
                                    std::pair{"watch_lease_s", request.watch_lease_s}}) {
    if (!(value >= 0.0)) return fmt::format("{}: is {}; it must be at least 0", name, value);
  }
  if (request.least_revision < 0) {
    return fmt::format("least_revision: is {}; it must be at least 0", request.least_revision);
  }
  if (request.priority < plan_request_t::LOW || request.priority > plan_request_t::HIGH) {
    return fmt::format("priority: is {}; it must be -1 (low), 0 or 1 (high)",
                       static_cast<int>(request.priority));
  }
  return {};
}

/// Returns an answer with what watching needs to know.
WatchableAnswer watchable(const RequestKey& key, std::shared_ptr<const plan_request_t> request,
                          const Answered& answered) {
  WatchableAnswer watchable{key,
                            std::move(request),
                            answered.path,
                            answered.wire.scene_revision,
                            answered.proved_in,
                            AnswerQuality::of(answered.wire),
                            answered.interpolated};
  for (const collision_interval_t& collision : answered.wire.collisions) {
    watchable.colliding_s += collision.t_end_s - collision.t_begin_s;
  }
  return watchable;
}

/// Requires that `fault_of_handling` finds nothing.
Priority priority_of(const plan_request_t& request) {
  switch (request.priority) {
    case plan_request_t::LOW:
      return Priority::kLow;
    case plan_request_t::HIGH:
      return Priority::kHigh;
    default:
      return Priority::kNormal;
  }
}

/// Watched paths, for each worker that may plan, that are planned again or wait for that.
constexpr std::size_t kReplansPerWorker = 2;

}  // namespace

/// A request that waits for a worker or is being planned.
struct PlanService::Pending {
  RequestKey key;
  std::shared_ptr<const plan_request_t> request;
  std::shared_ptr<const scene::Snapshot> snapshot;
  std::size_t bytes;  ///< size of the request
  double deadline_s;
  base::Deadline deadline;
};

/// A watched path that collides, or for which there may be a better one, and is planned again.
struct PlanService::Replan {
  RequestKey key;
  std::shared_ptr<const plan_request_t> request;
  base::Deadline deadline;
  bool for_offer;
};

/// Result of planning it again.
struct PlanService::Replanned {
  Answered answered;
  Pages pages;
};

void PlanService::refuse_malformed(const wire::Sender& sender, std::string_view reason) {
  plan_request_t request{};
  request.client_id = sender.client_id;
  request.request_id = sender.request_id;
  answer_uncached(request, plan_response_t::STATUS_MALFORMED, reason);
}

void PlanService::on_request(std::span<const std::uint8_t> message) {
  const std::string channel = core_.channels.plan_request();
  auto page = core_.read<plan_request_t>(channel, message, refusing());
  if (!page) return;
  // No scene or method has a name with control characters, so nothing is lost.
  page->scene = wire::printable(page->scene);
  page->method = wire::printable(page->method);
  wire::PageAssembly<plan_request_t>::Outcome outcome = pages_.add(std::move(*page));
  if (!outcome.error.empty()) {
    core_.on_malformed<plan_request_t>(channel, message, "plan_request_t." + outcome.error,
                                       refusing());
  }
  if (outcome.given_up > 0) {
    core_.limited_log.refused.write(
        "half received requests are given up",
        {{"requests", outcome.given_up}, {"reason", "memory.half_received_requests or _bytes"}});
  }
  if (outcome.whole) take(std::move(*outcome.whole));
}

void PlanService::on_cancel(std::span<const std::uint8_t> message) {
  const auto cancel = core_.read<cancel_t>(core_.channels.cancel(), message, refusing());
  if (!cancel) return;
  const RequestKey key{cancel->client_id, cancel->request_id};
  if (in_flight_.cancel(key)) {
    // A request that is being planned ends by itself.
    if (const std::optional<Job> waiting = core_.workers.take(key.client_id, key.request_id)) {
      waiting->abandon(Refusal::kCancelled);
    }
  } else if (Pages answer = cache_.find(key)) {
    send(key, std::move(answer));
  } else {
    plan_request_t unknown{};
    unknown.client_id = key.client_id;
    unknown.request_id = key.request_id;
    answer_uncached(unknown, plan_response_t::STATUS_CANCELLED, "the daemon knows no such request");
  }
}

void PlanService::on_missing_pages(std::span<const std::uint8_t> message) {
  const auto asked =
      core_.read<missing_pages_t>(core_.channels.missing_pages(), message, refusing());
  if (!asked) return;
  const RequestKey key{asked->client_id, asked->request_id};
  Pages answer = cache_.find(key);
  if (!answer) return;
  std::set<std::size_t> which;
  for (const std::int32_t page : asked->missing) {
    if (page >= 0 && static_cast<std::size_t>(page) < answer->size()) {
      which.insert(static_cast<std::size_t>(page));
    }
  }
  if (which.empty()) return;
  core_.counters.answer_pages_asked_again += static_cast<std::int64_t>(which.size());
  core_.outbox.add(core_.channels.plan_response(key.client_id), std::move(answer),
                   {which.begin(), which.end()});
}

void PlanService::tick(Clock::time_point now) {
  for (Watches::Accepted& accepted : watches_.take_accepted()) {
    put_in_force(std::move(accepted), now);
  }
  plan_broken(now);
  plan_improvable(now);
  for (plan_progress_t& progress : in_flight_.take_due(now)) {
    const auto ahead = core_.workers.ahead_of(progress.client_id, progress.request_id);
    progress.requests_ahead = static_cast<std::int32_t>(ahead.value_or(0));
    core_.outbox.add(core_.channels.plan_progress(progress.client_id),
                     one_page(wire::encode(progress)));
  }
  for (missing_pages_t& question : pages_.take_missing(now)) {
    core_.counters.request_pages_asked_again += question.num_missing;
    question.utime = utime_now();
    core_.outbox.add(core_.channels.missing_pages(question.client_id),
                     one_page(wire::encode(question)));
  }
}

PlanService::Clock::time_point PlanService::next_tick() const {
  return std::min(in_flight_.next_due(), pages_.next_missing());
}

void PlanService::take(plan_request_t request) {
  const RequestKey key{request.client_id, request.request_id};
  if (request.keyframes.size() > config_.keyframes) {
    answer_uncached(request, plan_response_t::STATUS_LIMIT,
                    fmt::format("keyframes: holds {}; the daemon plans {} at most "
                                "(planning.keyframes)",
                                request.keyframes.size(), config_.keyframes));
    return;
  }
  if (const std::string fault = fault_of_handling(request); !fault.empty()) {
    answer_uncached(request, plan_response_t::STATUS_INVALID, fault);
    return;
  }
  if (refuse_old_scene(request)) return;
  const AnswerCache::Found found = cache_.find_or_begin(key, digest_of(request));
  switch (found.known) {
    case AnswerCache::Known::kRunning:
      ++core_.counters.repeated;
      return;
    case AnswerCache::Known::kAnswered:
      if (found.was_watched && !watches_.renew(key, Clock::now())) {
        // The lease is over, so the answer may be out of date.
        cache_.forget_answer(key);
        take(std::move(request));
        return;
      }
      repeat_answer(key, found.pages);
      return;
    case AnswerCache::Known::kConflict:
      answer_uncached(
          request, plan_response_t::STATUS_INVALID,
          fmt::format("request_id: {} was used before for another request", request.request_id));
      return;
    case AnswerCache::Known::kNew:
      begin(std::make_shared<const plan_request_t>(std::move(request)), key);
      return;
  }
}

bool PlanService::refuse_old_scene(const plan_request_t& request) {
  const auto snapshot = core_.scenes.find(request.scene);
  if (!snapshot || static_cast<std::int64_t>(snapshot->revision) >= request.least_revision) {
    return false;
  }
  answer_uncached(request, plan_response_t::STATUS_OLD_SCENE,
                  fmt::format("least_revision: is {}, but scene '{}' is at revision {}: the daemon "
                              "was started anew and has forgotten changes; make them again, or "
                              "start it with a folder for its state",
                              request.least_revision, request.scene, snapshot->revision),
                  snapshot.get());
  return true;
}

void PlanService::repeat_answer(const RequestKey& key, const Pages& pages) {
  ++core_.counters.repeated;
  ++core_.counters.cache_hits;
  core_.limited_log.answers.write(
      "repeated answer",
      {{"client", key.client_id}, {"request", key.request_id}, {"pages", pages->size()}});
  send(key, pages);
}

void PlanService::begin(std::shared_ptr<const plan_request_t> request, const RequestKey& key) {
  const auto bytes = static_cast<std::size_t>(request->getEncodedSize());
  if (bytes_ > 0 && bytes_ + bytes > config_.request_bytes) {
    refuse(*request, fmt::format("the requests that wait or are planned take {} bytes, {} at most "
                                 "(queue.request_bytes); send it again later",
                                 bytes_, config_.request_bytes));
    return;
  }
  bytes_ += bytes;
  const double deadline_s = messages::deadline_of(request->deadline_s, config_.deadline);
  const Pending pending{
      key,   request,    core_.scenes.find(request->scene),
      bytes, deadline_s, in_flight_.begin(key, deadline_s, request->progress_period_s)};
  if (!pending.snapshot) {
    const std::string message =
        fmt::format("scene: '{}' is unknown; {}", request->scene, core_.scenes.summary());
    finish_plainly(pending, plan_response_t::STATUS_UNKNOWN_SCENE, message);
    return;
  }
  Job job;
  job.run = [this, pending] { run(pending); };
  job.abandon = [this, pending](Refusal why) { abandon(pending, why); };
  job.client = key.client_id;
  job.id = key.request_id;
  job.priority = priority_of(*request);
  job.expires =
      Job::Clock::now() + std::chrono::duration_cast<Job::Clock::duration>(
                              std::chrono::duration<double>(pending.deadline.remaining_s()));
  core_.submit(std::move(job));
}

// Runs on a worker: uses nothing of the service but the answerer and thread-safe members.
void PlanService::run(const Pending& pending) {
  if (pending.deadline.passed()) {
    const Refusal why = pending.deadline.stopped() ? Refusal::kCancelled : Refusal::kExpired;
    core_.mailbox.post([this, pending, why] { abandon(pending, why); });
    return;
  }
  const double waited_s = pending.deadline.elapsed_ms() / kMillisecondsPerSecond;
  auto answered = std::make_shared<Answered>(
      answerer_->answer(pending.snapshot, *pending.request, pending.deadline));
  Pages pages = encode_answer(answered->wire, core_.start, config_.answer_pages);
  core_.mailbox.post(
      [this, pending, waited_s, answered = std::move(answered), pages = std::move(pages)] {
        core_.counters.waiting.add(waited_s);
        core_.counters.planning.add(answered->wire.total_ms / kMillisecondsPerSecond);
        if (in_flight_.cancelled(pending.key)) {
          abandon(pending, Refusal::kCancelled);
        } else {
          finish(pending, answered->wire, pages);
          if (answered->path) watch(pending, *answered);
        }
      });
}

void PlanService::finish(const Pending& pending, const plan_response_t& answer, Pages pages) {
  core_.limited_log.answers.write("answered", {{"client", pending.key.client_id},
                                               {"request", pending.key.request_id},
                                               {"scene", pending.request->scene},
                                               {"status", messages::status_name(answer.status)},
                                               {"keyframes", pending.request->keyframes.size()},
                                               {"segments", answer.segments.size()},
                                               {"collisions", answer.collisions.size()},
                                               {"remaining", answer.remaining.size()},
                                               {"pages", pages->size()},
                                               {"ms", answer.total_ms},
                                               {"since_receipt_ms", pending.deadline.elapsed_ms()},
                                               {"message", answer.message}});
  core_.counters.plan_answers.add(answer.status);
  core_.counters.receipt_to_answer.add(pending.deadline.elapsed_ms() / kMillisecondsPerSecond);
  in_flight_.end(pending.key);
  bytes_ -= pending.bytes;
  cache_.finish(pending.key, pages);
  send(pending.key, std::move(pages));
}

void PlanService::watch(const Pending& pending, const Answered& answered) {
  const WatchableAnswer watched = watchable(pending.key, pending.request, answered);
  if (watches_.begin(watched, Clock::now())) cache_.mark_watched(pending.key);
}

// Plans a few at a time: they must not fill the queue, nor all be planned in a scene that has
// changed again by then.
void PlanService::plan_broken(Clock::time_point now) {
  const std::size_t most = kReplansPerWorker * static_cast<std::size_t>(core_.workers.allowed());
  if (replanning_ >= most) return;
  for (const Watches::Request& broken : watches_.take_broken(most - replanning_, now)) {
    ++replanning_;
    plan_again(broken, /*for_offer=*/false);
  }
}

void PlanService::plan_improvable(Clock::time_point now) {
  if (const auto watched = watches_.take_improvable(now)) plan_again(*watched, /*for_offer=*/true);
}

void PlanService::plan_again(const Watches::Request& watched, bool for_offer) {
  const double deadline_s = messages::deadline_of(watched.request->deadline_s, config_.deadline);
  const Replan replan{watched.key, watched.request, base::Deadline::after_s(deadline_s), for_offer};
  Job job;
  job.run = [this, replan] { run_again(replan); };
  job.abandon = [this, replan](Refusal) { give_up(replan); };
  job.client = replan.key.client_id;
  job.priority = Priority::kLow;
  job.expires = Job::Clock::now() + std::chrono::duration_cast<Job::Clock::duration>(
                                        std::chrono::duration<double>(deadline_s));
  core_.submit(std::move(job));
}

// Runs on a worker.
void PlanService::run_again(const Replan& replan) {
  const auto snapshot = core_.scenes.find(replan.request->scene);
  if (!snapshot || replan.deadline.passed()) {
    core_.mailbox.post([this, replan] { give_up(replan); });
    return;
  }
  auto done = std::make_shared<Replanned>();
  done->answered = answerer_->answer(snapshot, *replan.request, replan.deadline);
  done->answered.interpolated.reset();  // watched since the first answer
  done->pages = encode_answer(done->answered.wire, core_.start, config_.answer_pages);
  core_.mailbox.post([this, replan, done] { finish_again(replan, *done); });
}

void PlanService::finish_again(const Replan& replan, const Replanned& done) {
  const Clock::time_point now = Clock::now();
  const plan_response_t& answer = done.answered.wire;
  const WatchableAnswer watched = watchable(replan.key, replan.request, done.answered);
  if (replan.for_offer) {
    if (watched.path) {
      watches_.offer(watched, done.pages, now);
    } else {
      watches_.no_offer(replan.key, now);
    }
    return;
  }
  --replanning_;
  if (!watches_.planned(replan.key)) return;
  core_.limited_log.answers.write("answered again",
                                  {{"client", replan.key.client_id},
                                   {"request", replan.key.request_id},
                                   {"scene", answer.scene},
                                   {"revision", answer.scene_revision},
                                   {"status", messages::status_name(answer.status)},
                                   {"message", answer.message}});
  cache_.replace(replan.key, digest_of(*replan.request), done.pages);
  send(replan.key, done.pages);
  if (watched.path) {
    watches_.begin(watched, now);
  } else {
    watches_.answered(replan.key, answer.scene_revision, now);
  }
}

// Sends the pages although the client had them with the offer: it may have lost them since, and a
// client that repeats the request gets them too.
void PlanService::put_in_force(Watches::Accepted accepted, Clock::time_point now) {
  const RequestKey& key = accepted.answer.key;
  cache_.replace(key, digest_of(*accepted.answer.request), accepted.pages);
  send(key, std::move(accepted.pages));
  watches_.begin(accepted.answer, now);
}

void PlanService::give_up(const Replan& replan) {
  if (replan.for_offer) {
    watches_.not_improved(replan.key, Clock::now());
    return;
  }
  --replanning_;
  watches_.not_planned(replan.key, Clock::now());
}

void PlanService::finish_plainly(const Pending& pending, std::int32_t status,
                                 std::string_view message) {
  plan_response_t answer =
      messages::plain_answer(status, message, header_of(*pending.request, pending.snapshot.get()));
  Pages pages = encode_answer(answer, core_.start, config_.answer_pages);
  finish(pending, answer, std::move(pages));
}

void PlanService::abandon(const Pending& pending, Refusal why) {
  if (why == Refusal::kExpired) {
    finish_plainly(pending, plan_response_t::STATUS_TIMEOUT,
                   fmt::format("the deadline of {:g} s passed while the request waited for a "
                               "worker; nothing was planned",
                               pending.deadline_s));
    return;
  }
  if (why == Refusal::kCancelled) {
    finish_plainly(pending, plan_response_t::STATUS_CANCELLED, "cancelled by its client");
    return;
  }
  in_flight_.end(pending.key);
  bytes_ -= pending.bytes;
  refuse(*pending.request, core_.refusal_text(why));
}

void PlanService::refuse(const plan_request_t& request, const std::string& message) {
  cache_.forget({request.client_id, request.request_id});
  ++core_.counters.overloaded;
  core_.limited_log.refused.write(
      "refused plan request",
      {{"client", request.client_id}, {"request", request.request_id}, {"reason", message}});
  answer_uncached(request, plan_response_t::STATUS_OVERLOADED, message);
}

void PlanService::answer_uncached(const plan_request_t& request, std::int32_t status,
                                  std::string_view message, const scene::Snapshot* snapshot) {
  plan_response_t answer = messages::plain_answer(status, message, header_of(request, snapshot));
  core_.counters.plan_answers.add(status);
  send({request.client_id, request.request_id},
       encode_answer(answer, core_.start, config_.answer_pages), Outbox::Kind::kRefusal);
}

void PlanService::send(const RequestKey& key, Pages pages, Outbox::Kind kind) {
  if (core_.outbox.add(core_.channels.plan_response(key.client_id), std::move(pages), {}, kind)) {
    ++core_.counters.answered;
  }
}

}  // namespace camway::service
