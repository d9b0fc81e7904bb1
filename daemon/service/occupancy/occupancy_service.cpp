// SPDX-License-Identifier: MIT
#include "daemon/service/occupancy/occupancy_service.h"

#include <fmt/format.h>

#include <exception>
#include <optional>
#include <utility>

#include <camway/cancel_t.hpp>

#include "daemon/messages/text.h"
#include "daemon/service/occupancy/occupancy_answer.h"

namespace camway::service {
namespace {

using Response = occupancy_response_t;

/// Returns the answer of the map. Does not throw.
Response answer_of(const scene::Snapshot& snapshot, const occupancy_request_t& request,
                   const base::Deadline& deadline) {
  try {
    return answer_batch(snapshot, request, deadline);
  } catch (const std::exception& exception) {
    return plain_occupancy_answer(request, Response::STATUS_INTERNAL_ERROR,
                                  std::string("internal error: ") + exception.what());
  }
}

RequestKey key_of(const occupancy_request_t& request) {
  return {request.client_id, request.request_id};
}

/// Returns whether both ask for the same; `utime` does not count.
bool same(const occupancy_request_t& a, const occupancy_request_t& b) {
  return a.scene == b.scene && a.deadline_s == b.deadline_s && a.points_m == b.points_m &&
         a.boxes_m == b.boxes_m && a.spheres_m == b.spheres_m && a.rays_m == b.rays_m &&
         a.distances_m == b.distances_m && a.sphere_paths_m == b.sphere_paths_m;
}

}  // namespace

void OccupancyService::refuse_malformed(const wire::Sender& sender, std::string_view reason) {
  occupancy_request_t request{};
  request.client_id = sender.client_id;
  request.request_id = sender.request_id;
  send(plain_occupancy_answer(request, Response::STATUS_MALFORMED, reason));
}

void OccupancyService::on_message(std::span<const std::uint8_t> message) {
  auto request =
      core_.read<occupancy_request_t>(core_.channels.occupancy_request(), message, refusing());
  if (!request) return;
  // No scene has a name with control characters, so nothing is lost.
  request->scene = wire::printable(request->scene);
  on_request(std::make_shared<const occupancy_request_t>(std::move(*request)));
}

void OccupancyService::on_cancel(std::span<const std::uint8_t> message) {
  const auto cancel = core_.read<cancel_t>(core_.channels.cancel_occupancy(), message, refusing());
  if (!cancel) return;
  const auto flight = flights_.find({cancel->client_id, cancel->request_id});
  if (flight == flights_.end()) {
    occupancy_request_t unknown{};
    unknown.client_id = cancel->client_id;
    unknown.request_id = cancel->request_id;
    send(plain_occupancy_answer(unknown, Response::STATUS_CANCELLED,
                                "the daemon knows no such request"));
    return;
  }
  // A worker that is at it checks before its next query; a batch that waits ends when its turn
  // comes.
  flight->second.stop.request_stop();
  const Request called_off = flight->second.request;
  finish(called_off, plain_occupancy_answer(*called_off, Response::STATUS_CANCELLED,
                                            "cancelled by its client"));
}

void OccupancyService::on_request(const Request& request) {
  const auto refuse = [&](std::int32_t status, const std::string& message) {
    send(plain_occupancy_answer(*request, status, message));
  };
  const auto known = flights_.find(key_of(*request));
  if (known != flights_.end() && same(*known->second.request, *request)) {
    ++core_.counters.repeated;
    return;
  }
  if (known != flights_.end()) {
    refuse(Response::STATUS_INVALID,
           fmt::format("request_id: {} is that of another request that is not answered yet",
                       request->request_id));
    return;
  }
  if (!(request->deadline_s >= 0.0)) {
    refuse(Response::STATUS_INVALID,
           fmt::format("deadline_s: is {}; it must be at least 0", request->deadline_s));
    return;
  }
  std::shared_ptr<const scene::Snapshot> snapshot = core_.scenes.find(request->scene);
  if (!snapshot) {
    refuse(Response::STATUS_UNKNOWN_SCENE,
           fmt::format("scene: '{}' is unknown; {}", request->scene, core_.scenes.summary()));
    return;
  }
  begin(request, std::move(snapshot));
}

void OccupancyService::begin(const Request& request,
                             std::shared_ptr<const scene::Snapshot> snapshot) {
  const std::stop_source stop;
  flights_.insert_or_assign(key_of(*request), Flight{request, stop});
  const double deadline_s = messages::deadline_of(request->deadline_s, deadline_);
  const auto deadline = base::Deadline::after_s(deadline_s).watched(stop.get_token(), nullptr);
  Job work;
  work.client = request->client_id;
  work.expires = Job::Clock::now() + std::chrono::duration_cast<Job::Clock::duration>(
                                         std::chrono::duration<double>(deadline.remaining_s()));
  work.run = [this, request, deadline, snapshot = std::move(snapshot)] {
    auto answer = std::make_shared<const Response>(answer_of(*snapshot, *request, deadline));
    core_.mailbox.post([this, request, answer = std::move(answer)] { finish(request, *answer); });
  };
  work.abandon = [this, request](Refusal why) { abandon(request, why); };
  core_.submit(std::move(work));
}

void OccupancyService::abandon(const Request& request, Refusal why) {
  if (why == Refusal::kExpired) {
    finish(request, plain_occupancy_answer(*request, Response::STATUS_TIMEOUT,
                                           "the deadline passed while the request waited for a "
                                           "worker; nothing was asked of the map"));
    return;
  }
  ++core_.counters.overloaded;
  const std::string message = core_.refusal_text(why);
  core_.limited_log.refused.write(
      "refused occupancy request",
      {{"client", request->client_id}, {"request", request->request_id}, {"reason", message}});
  finish(request, plain_occupancy_answer(*request, Response::STATUS_OVERLOADED, message));
}

void OccupancyService::finish(const Request& request, Response answer) {
  const auto flight = flights_.find(key_of(*request));
  if (flight == flights_.end() || flight->second.request != request) return;
  flights_.erase(flight);
  send(std::move(answer));
}

void OccupancyService::send(occupancy_response_t answer) {
  answer.utime = utime_now();
  answer.daemon_start = core_.start;
  core_.counters.occupancy_answers.add(answer.status);
  core_.limited_log.occupancy.write("answered occupancy request",
                                    {{"client", answer.client_id},
                                     {"request", answer.request_id},
                                     {"scene", answer.scene},
                                     {"status", messages::status_name(answer.status)},
                                     {"queries", queries_of(answer)},
                                     {"message", answer.message}});
  const bool was_asked_of_a_map = answer.status == occupancy_response_t::STATUS_OK;
  if (core_.outbox.add(core_.channels.occupancy_response(answer.client_id),
                       one_page(wire::encode(answer)), {},
                       was_asked_of_a_map ? Outbox::Kind::kAnswer : Outbox::Kind::kRefusal)) {
    ++core_.counters.answered;
  }
}

}  // namespace camway::service
