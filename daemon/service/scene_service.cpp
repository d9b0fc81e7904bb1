// SPDX-License-Identifier: MIT
#include "daemon/service/scene_service.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <exception>
#include <set>
#include <utility>

#include <camway/missing_pages_t.hpp>

#include "lcmtypes/wire_check.h"

namespace camway::service {
namespace {

/// Of all but when it was sent.
RequestDigest digest_of(scene_request_t request) {
  request.utime = 0;
  const Bytes bytes = wire::encode(request);
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return {hash.high64, hash.low64};
}

/// The answer, whatever happens.
Performed answer_of(const scene_request_t& request, const UploadedBytes& upload,
                    const SceneContext& context) {
  try {
    return perform(request, upload, context);
  } catch (const std::exception& exception) {
    return {plain_scene_answer(request, scene_response_t::STATUS_INTERNAL_ERROR,
                               std::string("internal error: ") + exception.what()),
            {}};
  }
}

/// Of a client run all but one of the workers at most.
FairQueue::Limits with_room_for_others(FairQueue::Limits limits, int workers) {
  limits.running_of_a_client = static_cast<std::size_t>(std::max(workers - 1, 1));
  return limits;
}

}  // namespace

SceneService::SceneService(Core& core, scene::SceneStore& scenes)
    : core_(core),
      scenes_(scenes),
      rules_(core.config.scene_rules),
      uploads_(core.config.uploads),
      exports_(core.config.exports),
      cache_(core.config.cache),
      workers_(core.config.scene_workers,
               with_room_for_others(core.config.changes, core.config.scene_workers)) {}

void SceneService::on_request(std::span<const std::uint8_t> message) {
  wire::Decoded<scene_request_t> decoded = wire::decode<scene_request_t>(message);
  if (!decoded.message) {
    refuse_malformed(message, decoded.fault.text("scene_request_t"));
    return;
  }
  if (!wire::is_client_id(decoded.message->client_id)) {
    refuse_malformed(message, "scene_request_t.client_id: is not of [A-Za-z0-9_-]{1,32}");
    return;
  }
  // No scene or object of ours has a name with control characters, so nothing is lost.
  decoded.message->scene = wire::printable(decoded.message->scene);
  decoded.message->object = wire::printable(decoded.message->object);
  decoded.message->restore_as = wire::printable(decoded.message->restore_as);
  const auto request = std::make_shared<const scene_request_t>(std::move(*decoded.message));
  if (only_looks(*request)) {
    finish(*request, answer_of(*request, nullptr, context()).answer);
    return;
  }
  const RequestKey key{request->client_id, request->request_id};
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

void SceneService::begin(const std::shared_ptr<const scene_request_t>& request) {
  unanswered_.emplace(RequestKey{request->client_id, request->request_id}, request);
  const UploadedBytes upload =
      uploads_.find({request->client_id, request->upload_bytes, request->upload_checksum});
  Job work;
  work.client = request->client_id;
  work.strand = target_of(*request);
  work.run = [this, request, upload] {
    auto done = std::make_shared<Performed>(answer_of(*request, upload, context()));
    Pages map;
    if (!done->map.empty()) map = map_pages({request->client_id, request->request_id}, done->map);
    core_.mailbox.post([this, request, done, map] {
      if (!unanswered_.contains({request->client_id, request->request_id})) return;  // given up
      if (done->is_called_off) return refuse(*request, Refusal::kStopping);
      const RequestKey key{request->client_id, request->request_id};
      if (map && !exports_.keep(key, map, MapExports::Clock::now())) {
        done->answer = plain_scene_answer(
            *request, scene_response_t::STATUS_LIMIT,
            fmt::format("the map is larger than all exports may be together, {} bytes "
                        "(scenes.all_exports_bytes)",
                        core_.config.exports.bytes));
      }
      finish(*request, std::move(done->answer));
    });
  };
  work.abandon = [this, request](Refusal why) { refuse(*request, why); };
  if (std::optional<FairQueue::Refused> refused = workers_.submit(std::move(work))) {
    refused->job.abandon(refused->why);
  }
}

void SceneService::finish(const scene_request_t& request, scene_response_t answer) {
  core_.limited_log.scenes.write("answered scene request", {{"client", request.client_id},
                                                            {"request", request.request_id},
                                                            {"operation", operation_name(request)},
                                                            {"scene", request.scene},
                                                            {"object", request.object},
                                                            {"status", answer.status},
                                                            {"revision", answer.scene.revision},
                                                            {"message", answer.message}});
  const bool changed = !only_looks(request) && answer.status == scene_response_t::STATUS_OK;
  if (changed) ++core_.counters.scene_changes;
  Pages pages = send(std::move(answer));
  if (!only_looks(request)) {
    unanswered_.erase({request.client_id, request.request_id});
    cache_.finish({request.client_id, request.request_id}, std::move(pages));
  }
}

Pages SceneService::send(scene_response_t answer) {
  answer.utime = utime_now();
  core_.counters.scene_answers.add(answer.status);
  const std::string channel = core_.channels.scene_response(answer.client_id);
  auto pages = std::make_shared<const std::vector<Bytes>>(1, wire::encode(answer));
  const bool is_refused = answer.status == scene_response_t::STATUS_OVERLOADED ||
                          answer.status == scene_response_t::STATUS_MALFORMED;
  if (core_.outbox.add(channel, pages, {},
                       is_refused ? Outbox::Kind::kRefusal : Outbox::Kind::kAnswer)) {
    ++core_.counters.answered;
  }
  return pages;
}

void SceneService::refuse(const scene_request_t& request, Refusal why) {
  unanswered_.erase({request.client_id, request.request_id});
  cache_.forget({request.client_id, request.request_id});
  ++core_.counters.overloaded;
  const std::string_view message =
      why == Refusal::kStopping ? "the daemon is stopping"
                                : "too many changes of scenes wait (scenes.waiting_changes and "
                                  "scenes.waiting_changes_of_a_client); send it again later";
  core_.limited_log.refused.write(
      "refused scene request",
      {{"client", request.client_id}, {"request", request.request_id}, {"reason", message}});
  send(plain_scene_answer(request, scene_response_t::STATUS_OVERLOADED, message));
}

void SceneService::refuse_malformed(std::span<const std::uint8_t> message,
                                    std::string_view reason) {
  if (!core_.note_malformed(core_.channels.scene_request(), message.size(), reason)) return;
  const std::optional<wire::Sender> sender =
      wire::peek_sender(wire::layout_of<scene_request_t>(), message);
  if (!sender) {
    core_.report_unanswerable(core_.channels.scene_request(), message, reason);
    return;
  }
  scene_request_t request{};
  request.client_id = sender->client_id;
  request.request_id = sender->request_id;
  send(plain_scene_answer(request, scene_response_t::STATUS_MALFORMED, reason));
}

void SceneService::on_upload(std::span<const std::uint8_t> message) {
  const wire::Decoded<upload_page_t> decoded = wire::decode<upload_page_t>(message);
  std::string reason;
  if (!decoded.message) {
    reason = decoded.fault.text("upload_page_t");
  } else if (!wire::is_client_id(decoded.message->client_id)) {
    reason = "upload_page_t.client_id: is not of [A-Za-z0-9_-]{1,32}";
  }
  if (!reason.empty()) {
    if (core_.note_malformed(core_.channels.upload(), message.size(), reason)) {
      core_.report_unanswerable(core_.channels.upload(), message, reason);
    }
    return;
  }
  Uploads::Taken taken = uploads_.take(*decoded.message, Uploads::Clock::now());
  if (!taken.answer) return;
  taken.status.utime = utime_now();
  taken.status.message = clipped(taken.status.message, wire::kMaxTextBytes);
  core_.outbox.add(core_.channels.upload_status(taken.status.client_id),
                   std::make_shared<const std::vector<Bytes>>(1, wire::encode(taken.status)));
}

void SceneService::on_missing_map_pages(std::span<const std::uint8_t> message) {
  const wire::Decoded<missing_pages_t> decoded = wire::decode<missing_pages_t>(message);
  std::string reason;
  if (!decoded.message) {
    reason = decoded.fault.text("missing_pages_t");
  } else if (!wire::is_client_id(decoded.message->client_id)) {
    reason = "missing_pages_t.client_id: is not of [A-Za-z0-9_-]{1,32}";
  }
  if (!reason.empty()) {
    if (core_.note_malformed(core_.channels.missing_map_pages(), message.size(), reason)) {
      core_.report_unanswerable(core_.channels.missing_map_pages(), message, reason);
    }
    return;
  }
  const RequestKey key{decoded.message->client_id, decoded.message->request_id};
  const std::string channel = core_.channels.map_page(key.client_id);
  const Pages pages = exports_.find(key, MapExports::Clock::now());
  if (!pages) {
    core_.outbox.add(channel,
                     std::make_shared<const std::vector<Bytes>>(1, wire::encode(no_such_map(key))));
    return;
  }
  std::set<std::size_t> which;
  for (const std::int32_t page : decoded.message->missing) {
    if (page >= 0 && static_cast<std::size_t>(page) < pages->size()) {
      which.insert(static_cast<std::size_t>(page));
    }
  }
  if (!which.empty()) core_.outbox.add(channel, pages, {which.begin(), which.end()});
}

SceneContext SceneService::context() { return {rules_, scenes_, writing_, stop_.get_token()}; }

void SceneService::close() {
  stop_.request_stop();
  for (const Job& job : workers_.close()) job.abandon(Refusal::kStopping);
}

void SceneService::give_up() {
  // Each refusal takes one out.
  while (!unanswered_.empty()) {
    const std::shared_ptr<const scene_request_t> request = unanswered_.begin()->second;
    refuse(*request, Refusal::kStopping);
  }
}

void SceneService::stop() {
  stop_.request_stop();
  workers_.stop();
}

}  // namespace camway::service
