// SPDX-License-Identifier: MIT
#include "daemon/service/occupancy_service.h"

#include <fmt/format.h>

#include <exception>
#include <utility>

#include "daemon/service/occupancy_answer.h"

namespace camway::service {
namespace {

/// The answer of the map, whatever happens.
occupancy_response_t answer_of(const scene::Snapshot& snapshot,
                               const occupancy_request_t& request) {
  try {
    return answer_batch(snapshot, request);
  } catch (const std::exception& exception) {
    return plain_occupancy_answer(request, occupancy_response_t::STATUS_INTERNAL_ERROR,
                                  std::string("internal error: ") + exception.what());
  }
}

}  // namespace

void OccupancyService::on_message(std::span<const std::uint8_t> message) {
  wire::Decoded<occupancy_request_t> decoded = wire::decode<occupancy_request_t>(message);
  if (!decoded.message) {
    on_malformed(message, decoded.fault.text("occupancy_request_t"));
    return;
  }
  if (!wire::is_client_id(decoded.message->client_id)) {
    on_malformed(message, "occupancy_request_t.client_id: is not of [A-Za-z0-9_-]{1,32}");
    return;
  }
  // No scene of ours has a name with control characters, so nothing is lost.
  decoded.message->scene = wire::printable(decoded.message->scene);
  on_request(std::make_shared<const occupancy_request_t>(std::move(*decoded.message)));
}

void OccupancyService::on_malformed(std::span<const std::uint8_t> message,
                                    std::string_view reason) {
  if (!core_.note_malformed(core_.channels.occupancy_request(), message.size(), reason)) return;
  const std::optional<wire::Sender> sender =
      wire::peek_sender(wire::layout_of<occupancy_request_t>(), message);
  if (!sender) {
    core_.report_unanswerable(core_.channels.occupancy_request(), message, reason);
    return;
  }
  occupancy_request_t request{};
  request.client_id = sender->client_id;
  request.request_id = sender->request_id;
  send(plain_occupancy_answer(request, occupancy_response_t::STATUS_MALFORMED, reason));
}

void OccupancyService::on_request(const std::shared_ptr<const occupancy_request_t>& request) {
  std::shared_ptr<const scene::Snapshot> snapshot = core_.scenes.find(request->scene);
  if (!snapshot) {
    send(plain_occupancy_answer(
        *request, occupancy_response_t::STATUS_UNKNOWN_SCENE,
        fmt::format("scene: '{}' is unknown; {}", request->scene, core_.scenes.summary())));
    return;
  }
  Job work;
  work.client = request->client_id;
  work.run = [this, request, snapshot = std::move(snapshot)] {
    auto answer = std::make_shared<const occupancy_response_t>(answer_of(*snapshot, *request));
    core_.mailbox.post([this, answer = std::move(answer)] { send(*answer); });
  };
  work.abandon = [this, request](Refusal why) { refuse(*request, why); };
  core_.submit(std::move(work));
}

void OccupancyService::refuse(const occupancy_request_t& request, Refusal why) {
  ++core_.counters.overloaded;
  const std::string message = core_.refusal_text(why);
  core_.limited_log.refused.write(
      "refused occupancy request",
      {{"client", request.client_id}, {"request", request.request_id}, {"reason", message}});
  send(plain_occupancy_answer(request, occupancy_response_t::STATUS_OVERLOADED, message));
}

void OccupancyService::send(occupancy_response_t answer) {
  answer.utime = utime_now();
  core_.counters.occupancy_answers.add(answer.status);
  core_.limited_log.occupancy.write(
      "answered occupancy request",
      {{"client", answer.client_id},
       {"request", answer.request_id},
       {"scene", answer.scene},
       {"status", answer.status},
       {"queries", answer.num_points + answer.num_boxes + answer.num_spheres + answer.num_rays +
                       answer.num_distances + answer.num_sphere_paths},
       {"message", answer.message}});
  const bool was_asked_of_a_map = answer.status == occupancy_response_t::STATUS_OK;
  if (core_.outbox.add(core_.channels.occupancy_response(answer.client_id),
                       std::make_shared<const std::vector<Bytes>>(1, wire::encode(answer)), {},
                       was_asked_of_a_map ? Outbox::Kind::kAnswer : Outbox::Kind::kRefusal)) {
    ++core_.counters.answered;
  }
}

}  // namespace camway::service
