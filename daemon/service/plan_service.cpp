// SPDX-License-Identifier: MIT
#include "daemon/service/plan_service.h"

#include <fmt/format.h>

#include <chrono>
#include <exception>
#include <utility>

#include "daemon/planning/witness.h"
#include "daemon/scene/import_warnings.h"

namespace camway::service {
namespace {

AnswerHeader header_of(const plan_request_t& request, const scene::Snapshot* snapshot) {
  AnswerHeader header;
  header.ids = {request.client_id, request.request_id, utime_now()};
  header.scene = request.scene;
  if (snapshot != nullptr) {
    header.scene_revision = static_cast<std::int64_t>(snapshot->revision);
    header.scene_digest = snapshot->digest;
  }
  return header;
}

/// Numbers that are none are refused once the request's turn comes.
double deadline_in_queue_s(double wire_s, const DeadlineLimits& limits) {
  const double deadline_s = deadline_of(wire_s, limits);
  return deadline_s > 0.0 ? deadline_s : limits.default_s;
}

Priority priority_of(const plan_request_t& request) {
  if (request.priority < 0) return Priority::kLow;
  return request.priority > 0 ? Priority::kHigh : Priority::kNormal;
}

/// What an answer does not hold for, where it is read: behind its message.
void append_warnings(const scene::ImportReport& report, const planning::PlanOptions& options,
                     planning::PlanResult& result) {
  if (result.status == planning::Status::kInvalid) return;
  const double resolution_m =
      scene::finest_length_m(options.interval_tolerance_m, options.clearance_m);
  for (const std::string& warning : scene::import_warnings(report, resolution_m)) {
    result.message += "; warning: " + warning;
  }
}

/// The answer of `planner`, whatever happens.
plan_response_t answer_of(const Planner& planner, const scene::Snapshot& snapshot,
                          const plan_request_t& wire, const DeadlineLimits& limits,
                          const collision::Deadline& deadline) {
  std::string error;
  try {
    const ConvertedRequest converted = from_wire(wire, limits);
    if (!converted.request) {
      return plain_answer(plan_response_t::STATUS_INVALID, converted.error,
                          header_of(wire, &snapshot));
    }
    planning::PlanResult result = planner(snapshot, *converted.request, deadline);
    planning::name_witnesses(snapshot.mesh, *converted.request, result);
    append_warnings(snapshot.report, converted.request->options, result);
    return to_wire(result, header_of(wire, &snapshot));
  } catch (const std::exception& exception) {
    error = exception.what();
  } catch (...) {
    error = "unknown exception";
  }
  return plain_answer(plan_response_t::STATUS_INTERNAL_ERROR, "internal error: " + error,
                      header_of(wire, &snapshot));
}

/// Encodes `answer`, or in its place an answer that says that it is too long.
Pages encode_answer(plan_response_t& answer) {
  const std::size_t pages = count_pages(answer);
  if (pages > static_cast<std::size_t>(wire::kMaxResponsePages)) {
    const AnswerHeader header{{answer.client_id, answer.request_id, answer.utime},
                              answer.scene,
                              answer.scene_revision,
                              answer.scene_digest};
    answer = plain_answer(plan_response_t::STATUS_INTERNAL_ERROR,
                          fmt::format("the answer takes {} pages, more than the {} allowed", pages,
                                      wire::kMaxResponsePages),
                          header);
  }
  return std::make_shared<const std::vector<Bytes>>(encode_pages(answer));
}

}  // namespace

/// A request on its way to and through a worker.
struct PlanService::Pending {
  RequestKey key;
  std::shared_ptr<const plan_request_t> request;
  std::shared_ptr<const scene::Snapshot> snapshot;
  double deadline_s;
  collision::Deadline deadline;
};

void PlanService::on_message(std::span<const std::uint8_t> message) {
  wire::Decoded<plan_request_t> decoded = wire::decode<plan_request_t>(message);
  if (!decoded.message) {
    on_malformed(message, decoded.fault.text("plan_request_t"));
    return;
  }
  if (!wire::is_client_id(decoded.message->client_id)) {
    on_malformed(message, "plan_request_t.client_id: is not of [A-Za-z0-9_-]{1,32}");
    return;
  }
  // No scene or method of ours has a name with control characters, so nothing is lost.
  decoded.message->scene = wire::printable(decoded.message->scene);
  decoded.message->method = wire::printable(decoded.message->method);
  PageAssembly<plan_request_t>::Outcome outcome = pages_.add(std::move(*decoded.message));
  if (!outcome.error.empty()) on_malformed(message, "plan_request_t." + outcome.error);
  if (outcome.whole) on_request(std::move(*outcome.whole));
}

void PlanService::on_malformed(std::span<const std::uint8_t> message, std::string_view reason) {
  core_.note_malformed(core_.channels.plan_request(), message.size(), reason);
  const std::optional<wire::Sender> sender =
      wire::peek_sender(wire::layout_of<plan_request_t>(), message);
  if (!sender) {
    core_.report_unanswerable(core_.channels.plan_request(), message, reason);
    return;
  }
  plan_request_t request{};
  request.client_id = sender->client_id;
  request.request_id = sender->request_id;
  answer_uncached(request, plan_response_t::STATUS_MALFORMED, reason);
}

void PlanService::on_request(plan_request_t request) {
  const RequestKey key{request.client_id, request.request_id};
  const AnswerCache::Found found = cache_.find_or_begin(key, digest_of(request));
  switch (found.known) {
    case AnswerCache::Known::kRunning:
      ++core_.counters.repeated;
      return;
    case AnswerCache::Known::kAnswered:
      ++core_.counters.repeated;
      core_.log->info("repeated answer client={} request={} pages={}", key.client_id,
                      key.request_id, found.pages->size());
      send(key, found.pages);
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

void PlanService::begin(std::shared_ptr<const plan_request_t> request, const RequestKey& key) {
  const double deadline_s = deadline_in_queue_s(request->deadline_s, core_.config.deadline);
  const Pending pending{key, request, core_.scenes.find(request->scene), deadline_s,
                        collision::Deadline::after_s(deadline_s)};
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
  job.priority = priority_of(*request);
  job.expires =
      Job::Clock::now() + std::chrono::duration_cast<Job::Clock::duration>(
                              std::chrono::duration<double>(pending.deadline.remaining_s()));
  core_.submit(std::move(job));
}

// On a worker: touches nothing of the service but the planner and what is made for many threads.
void PlanService::run(const Pending& pending) {
  if (pending.deadline.passed()) {
    core_.mailbox.post([this, pending] { abandon(pending, Refusal::kExpired); });
    return;
  }
  auto answer = std::make_shared<plan_response_t>(answer_of(
      planner_, *pending.snapshot, *pending.request, core_.config.deadline, pending.deadline));
  Pages pages = encode_answer(*answer);
  core_.mailbox.post([this, pending, answer = std::move(answer), pages = std::move(pages)] {
    finish(pending, *answer, pages);
  });
}

void PlanService::finish(const Pending& pending, const plan_response_t& answer, Pages pages) {
  core_.log->info(
      "answered client={} request={} scene={} status={} keyframes={} segments={} collisions={} "
      "remaining={} pages={} ms={:.1f} since_receipt_ms={:.1f}: {}",
      pending.key.client_id, pending.key.request_id, pending.request->scene,
      status_name(answer.status), pending.request->keyframes.size(), answer.segments.size(),
      answer.collisions.size(), answer.remaining.size(), pages->size(), answer.total_ms,
      pending.deadline.elapsed_ms(), answer.message);
  cache_.finish(pending.key, pages);
  send(pending.key, std::move(pages));
}

void PlanService::finish_plainly(const Pending& pending, std::int32_t status,
                                 std::string_view message) {
  plan_response_t answer =
      plain_answer(status, message, header_of(*pending.request, pending.snapshot.get()));
  Pages pages = encode_answer(answer);
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
  cache_.forget(pending.key);
  ++core_.counters.overloaded;
  const std::string message = core_.refusal_text(why);
  core_.overload_warnings.warn(fmt::format("refused request {} of {}: {}", pending.key.request_id,
                                           pending.key.client_id, message));
  answer_uncached(*pending.request, plan_response_t::STATUS_OVERLOADED, message);
}

void PlanService::answer_uncached(const plan_request_t& request, std::int32_t status,
                                  std::string_view message) {
  plan_response_t answer = plain_answer(status, message, header_of(request, nullptr));
  send({request.client_id, request.request_id}, encode_answer(answer));
}

void PlanService::send(const RequestKey& key, Pages pages) {
  if (core_.outbox.add(core_.channels.plan_response(key.client_id), std::move(pages))) {
    ++core_.counters.answered;
  }
}

}  // namespace camway::service
