// SPDX-License-Identifier: MIT
#include "daemon/service/scenes/scene_service.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <set>
#include <utility>
#include <vector>

#include <camway/cancel_t.hpp>
#include <camway/missing_pages_t.hpp>

#include "daemon/messages/text.h"
#include "daemon/service/scenes/ineffective_members.h"
#include "daemon/service/scenes/request_digest.h"
#include "daemon/service/scenes/scene_answers.h"
#include "lcmtypes/wire/check.h"

namespace camway::service {
namespace {

RequestKey key_of(const scene_request_t& request) {
  return {request.client_id, request.request_id};
}

/// Returns a request that holds only these ids.
scene_request_t request_of(const RequestKey& key) {
  scene_request_t request{};
  request.client_id = key.client_id;
  request.request_id = key.request_id;
  return request;
}

/// Returns the answer. Does not throw.
SceneReply reply_to(const scene_request_t& request, const UploadedBytes& upload,
                    const OperationContext& context) {
  try {
    return execute(request, upload, context);
  } catch (const std::exception& exception) {
    return {plain_scene_answer(request, scene_response_t::STATUS_INTERNAL_ERROR,
                               std::string("internal error: ") + exception.what()),
            {}};
  }
}

/// Lets one client use all workers but one at most, if there are several.
FairQueue::Limits with_room_for_others(FairQueue::Limits limits, int workers) {
  limits.running_of_a_client = static_cast<std::size_t>(std::max(workers - 1, 1));
  return limits;
}

scene_response_t late_answer(const scene_request_t& request) {
  return plain_scene_answer(request, scene_response_t::STATUS_TIMEOUT,
                            "the deadline passed before the change was committed, and nothing was "
                            "changed; allow more time with deadline_s (up to "
                            "scenes.max_deadline_s)");
}

}  // namespace

SceneService::SceneService(Core& core, scene::SceneStore& scenes, const SceneConfig& config)
    : core_(core),
      scenes_(scenes),
      config_(config),
      uploads_(config.uploads),
      exports_(config.exports),
      cache_(core.config.cache),
      workers_(config.scene_workers, with_room_for_others(config.changes, config.scene_workers)) {}

void SceneService::refuse_malformed(const wire::Sender& sender, std::string_view reason) {
  send(plain_scene_answer(request_of({sender.client_id, sender.request_id}),
                          scene_response_t::STATUS_MALFORMED, reason));
}

void SceneService::on_request(std::span<const std::uint8_t> message) {
  auto decoded = core_.read<scene_request_t>(core_.channels.scene_request(), message, refusing());
  if (!decoded) return;
  // No scene or object has a name with control characters, so nothing is lost.
  decoded->scene = wire::printable(decoded->scene);
  decoded->object = wire::printable(decoded->object);
  decoded->restore_as = wire::printable(decoded->restore_as);
  const auto request = std::make_shared<const scene_request_t>(std::move(*decoded));
  if (const std::string idle = ineffective_member(*request); !idle.empty()) {
    send(plain_scene_answer(*request, scene_response_t::STATUS_INVALID, idle));
  } else if (is_query(*request)) {
    finish(*request, reply_to(*request, nullptr, context({})).answer);
  } else if (!(request->deadline_s >= 0.0)) {
    send(plain_scene_answer(
        *request, scene_response_t::STATUS_INVALID,
        fmt::format("deadline_s: is {}; it must be at least 0", request->deadline_s)));
  } else {
    take_change(request);
  }
}

void SceneService::take_change(const Request& request) {
  const RequestKey key = key_of(*request);
  const AnswerCache::Found found = cache_.find_or_begin(key, digest_of(*request));
  switch (found.known) {
    case AnswerCache::Known::kRunning:
      ++core_.counters.repeated;
      return;
    case AnswerCache::Known::kAnswered:
      ++core_.counters.repeated;
      ++core_.counters.cache_hits;
      core_.outbox.add(core_.channels.scene_response(key.client_id), found.pages);
      return;
    case AnswerCache::Known::kConflict:
      send(plain_scene_answer(
          *request, scene_response_t::STATUS_INVALID,
          fmt::format("request_id: {} was used before for another request", key.request_id)));
      return;
    case AnswerCache::Known::kNew:
      begin(request);
      return;
  }
}

void SceneService::begin(const Request& request) {
  const RequestKey key = key_of(*request);
  const std::chrono::duration<double> allowed(
      messages::deadline_of(request->deadline_s, config_.change_deadline));
  const Pending pending{
      request, {}, Clock::now() + std::chrono::duration_cast<Clock::duration>(allowed)};
  unanswered_.insert_or_assign(key, pending);
  deadlines_.emplace(pending.deadline, key);
  const UploadedBytes upload =
      uploads_.find({request->client_id, request->upload_bytes, request->upload_checksum});
  Job work;
  work.client = request->client_id;
  work.id = request->request_id;
  // Triangles need not wait for changes of their scene.
  work.strand = target_of(*request);
  if (request->operation == scene_request_t::TRIANGLES) work.strand += " triangles";
  work.run = [this, request, upload, ticket = pending.ticket, deadline = pending.deadline] {
    // A small change would be committed before the loop looks at deadlines.
    const bool is_late = Clock::now() >= deadline;
    auto done = std::make_shared<SceneReply>(is_late ? SceneReply{late_answer(*request), {}}
                                                     : reply_to(*request, upload, context(ticket)));
    Pages map;
    if (!done->map.empty()) map = map_pages(key_of(*request), done->map);
    core_.mailbox.post([this, request, done, map] { take_done(request, std::move(*done), map); });
  };
  work.abandon = [this, request](Refusal why) { refuse(*request, why); };
  if (std::optional<FairQueue::Refused> refused = workers_.submit(std::move(work))) {
    refused->job.abandon(refused->why);
  }
}

void SceneService::take_done(const Request& request, SceneReply done, const Pages& map) {
  left_behind_.erase(request);
  const RequestKey key = key_of(*request);
  const auto pending = unanswered_.find(key);
  if (pending == unanswered_.end() || pending->second.request != request) return;  // cancelled
  if (map && !exports_.keep(key, map, MapExports::Clock::now())) {
    done.answer =
        plain_scene_answer(*request, scene_response_t::STATUS_LIMIT,
                           fmt::format("it is larger than all exports may be together, {} bytes "
                                       "(scenes.all_exports_bytes)",
                                       config_.exports.bytes));
  }
  finish(*request, std::move(done.answer));
}

void SceneService::on_cancel(std::span<const std::uint8_t> message) {
  const auto cancel = core_.read<cancel_t>(core_.channels.cancel_scene(), message, refusing());
  if (!cancel) return;
  const RequestKey key{cancel->client_id, cancel->request_id};
  if (const auto found = unanswered_.find(key); found != unanswered_.end()) {
    const Pending pending = found->second;
    if (!cancel_pending(pending)) return;  // its answer is on the way
    finish(*pending.request,
           plain_scene_answer(*pending.request, scene_response_t::STATUS_CANCELLED,
                              "cancelled by its client; nothing was changed"));
  } else if (const Pages answer = cache_.find(key)) {
    core_.outbox.add(core_.channels.scene_response(key.client_id), answer);
  } else {
    send(plain_scene_answer(request_of(key), scene_response_t::STATUS_CANCELLED,
                            "the daemon knows no such request"));
  }
}

bool SceneService::cancel_pending(const Pending& pending) {
  if (!pending.ticket.cancel()) return false;
  const RequestKey key = key_of(*pending.request);
  if (!workers_.take(key.client_id, key.request_id)) left_behind_.insert(pending.request);
  return true;
}

void SceneService::tick(Clock::time_point now) {
  while (!deadlines_.empty() && deadlines_.begin()->first <= now) {
    const Pending pending = unanswered_.at(deadlines_.begin()->second);
    deadlines_.erase(deadlines_.begin());
    if (!cancel_pending(pending)) continue;  // committed, and its answer is on the way
    finish(*pending.request, late_answer(*pending.request));
  }
}

SceneService::Clock::time_point SceneService::next_tick() const {
  return deadlines_.empty() ? Clock::time_point::max() : deadlines_.begin()->first;
}

void SceneService::finish(const scene_request_t& request, scene_response_t answer) {
  core_.limited_log.scenes.write("answered scene request",
                                 {{"client", request.client_id},
                                  {"request", request.request_id},
                                  {"operation", operation_name(request)},
                                  {"scene", request.scene},
                                  {"object", request.object},
                                  {"status", messages::status_name(answer.status)},
                                  {"revision", answer.scene.revision},
                                  {"message", answer.message}});
  // The client is told to send it again, to know whether it was made.
  const bool is_unclear = answer.status == scene_response_t::STATUS_INTERNAL_ERROR;
  const bool changed = !is_query(request) && request.operation != scene_request_t::TRIANGLES &&
                       answer.status == scene_response_t::STATUS_OK;
  if (changed) ++core_.counters.scene_changes;
  Pages pages = send(std::move(answer));
  if (is_query(request)) return;
  forget(key_of(request));
  if (is_unclear) {
    cache_.forget(key_of(request));
  } else {
    cache_.finish(key_of(request), std::move(pages));
  }
}

Pages SceneService::send(scene_response_t answer) {
  answer.utime = utime_now();
  answer.daemon_start = core_.start;
  core_.counters.scene_answers.add(answer.status);
  const std::string channel = core_.channels.scene_response(answer.client_id);
  auto pages = std::make_shared<const std::vector<Bytes>>(1, wire::encode(answer));
  const bool is_refused = answer.status == scene_response_t::STATUS_OVERLOADED ||
                          answer.status == scene_response_t::STATUS_STOPPING ||
                          answer.status == scene_response_t::STATUS_MALFORMED;
  if (core_.outbox.add(channel, pages, {},
                       is_refused ? Outbox::Kind::kRefusal : Outbox::Kind::kAnswer)) {
    ++core_.counters.answered;
  }
  return pages;
}

void SceneService::forget(const RequestKey& key) {
  const auto pending = unanswered_.find(key);
  deadlines_.erase({pending->second.deadline, key});
  unanswered_.erase(pending);
}

void SceneService::refuse(const scene_request_t& request, Refusal why) {
  forget(key_of(request));
  cache_.forget(key_of(request));
  ++core_.counters.overloaded;
  const bool is_stopping = why == Refusal::kStopping;
  const std::string_view message =
      is_stopping ? "the daemon is stopping; nothing was changed"
                  : "too many changes of scenes wait (scenes.waiting_changes and "
                    "scenes.waiting_changes_of_a_client); send it again later";
  core_.limited_log.refused.write(
      "refused scene request",
      {{"client", request.client_id}, {"request", request.request_id}, {"reason", message}});
  std::int32_t status = scene_response_t::STATUS_OVERLOADED;
  if (is_stopping) status = scene_response_t::STATUS_STOPPING;
  send(plain_scene_answer(request, status, message));
}

void SceneService::on_upload(std::span<const std::uint8_t> message) {
  const auto page = core_.read<upload_page_t>(core_.channels.upload(), message);
  if (!page) return;
  Uploads::Taken taken = uploads_.take(*page, Uploads::Clock::now());
  if (!taken.answer) return;
  taken.status.utime = utime_now();
  taken.status.message = messages::clipped(taken.status.message, wire::kMaxTextBytes);
  core_.outbox.add(core_.channels.upload_status(taken.status.client_id),
                   std::make_shared<const std::vector<Bytes>>(1, wire::encode(taken.status)));
}

void SceneService::on_missing_map_pages(std::span<const std::uint8_t> message) {
  const auto asked = core_.read<missing_pages_t>(core_.channels.missing_map_pages(), message);
  if (!asked) return;
  const RequestKey key{asked->client_id, asked->request_id};
  const std::string channel = core_.channels.map_page(key.client_id);
  const Pages pages = exports_.find(key, MapExports::Clock::now());
  if (!pages) {
    core_.outbox.add(channel,
                     std::make_shared<const std::vector<Bytes>>(1, wire::encode(no_such_map(key))));
    return;
  }
  std::set<std::size_t> which;
  for (const std::int32_t page : asked->missing) {
    if (page >= 0 && static_cast<std::size_t>(page) < pages->size()) {
      which.insert(static_cast<std::size_t>(page));
    }
  }
  if (!which.empty()) core_.outbox.add(channel, pages, {which.begin(), which.end()});
}

OperationContext SceneService::context(const scene::ChangeTicket& ticket) {
  return {config_.scene_rules, scenes_, writing_, ticket};
}

void SceneService::close() {
  for (const Job& job : workers_.close()) job.abandon(Refusal::kStopping);
  std::vector<Pending> begun;
  for (const auto& [key, pending] : unanswered_) begun.push_back(pending);
  for (const Pending& pending : begun) {
    if (cancel_pending(pending)) refuse(*pending.request, Refusal::kStopping);
  }
}

std::size_t SceneService::leave_cancelled() {
  const std::size_t left = left_behind_.size();
  left_behind_.clear();
  return left;
}

void SceneService::give_up() {
  // Each answer removes one.
  while (!unanswered_.empty()) {
    const Request request = unanswered_.begin()->second.request;
    finish(*request, plain_scene_answer(*request, scene_response_t::STATUS_INTERNAL_ERROR,
                                        "the daemon stopped before the change was kept; send it "
                                        "again to know whether it was made"));
  }
}

void SceneService::stop() {
  for (const auto& [key, pending] : unanswered_) pending.ticket.cancel();
  workers_.stop();
}

}  // namespace camway::service
