// SPDX-License-Identifier: MIT
#include "tests/service/running_service.h"

#include <gtest/gtest.h>

#include <chrono>

#include "daemon/messages/plan.h"
#include "tests/messages/plan_samples.h"
#include "tests/messages/request_on_wire.h"

namespace camway::testing {

planning::PlanResult FakePlanner::plan(const planning::PlanRequest& request,
                                       const base::Deadline& deadline) {
  std::unique_lock lock(mutex_);
  ++calls_;
  last_budget_s_ = deadline.remaining_s();
  changed_.notify_all();
  // Like planning, this checks the deadline now and then.
  while (held_ && !deadline.stopped()) changed_.wait_for(lock, std::chrono::milliseconds(1));
  lock.unlock();
  return result_(request);
}

void FakePlanner::hold() {
  const std::lock_guard lock(mutex_);
  held_ = true;
}

void FakePlanner::release() {
  {
    const std::lock_guard lock(mutex_);
    held_ = false;
  }
  changed_.notify_all();
}

bool FakePlanner::wait_for_calls(int count) const {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, std::chrono::seconds(30), [&] { return calls_ >= count; });
}

int FakePlanner::calls() const {
  const std::lock_guard lock(mutex_);
  return calls_;
}

double FakePlanner::last_budget_s() const {
  const std::lock_guard lock(mutex_);
  return last_budget_s_;
}

planning::PlanResult echo_result(const planning::PlanRequest& request) {
  planning::PlanResult result;
  result.status = planning::Status::kOk;
  result.message = "as asked";
  result.keyframes = request.keyframes;
  std::vector<motion::Segment> segments(request.keyframes.size());
  for (std::size_t i = 0; i < segments.size(); ++i) {
    segments[i].t0_s = static_cast<double>(i);
    segments[i].t1_s = static_cast<double>(i + 1);
    segments[i].position.fill(request.keyframes[i].pose.position);
    segments[i].orientation.fill(geometry::wxyz(request.keyframes[i].pose.orientation));
  }
  if (!segments.empty()) result.path = motion::Path(std::move(segments));
  return result;
}

RunningService::RunningService(const service::ServiceConfig& config, FakePlanner::Result result,
                               service::ServiceHooks hooks, const scene::SceneStoreLimits& limits,
                               scene::SceneJournal* journal)
    : scenes(limits, journal), planner(std::move(result)), channels{config.prefix} {
  scenes.put(empty_scene("room"));
  scenes.put(empty_scene("hall"));
  service_.emplace(
      transport, scenes, config,
      [this](const scene::Snapshot&, const planning::PlanRequest& request,
             const base::Deadline& deadline) { return planner.plan(request, deadline); },
      log_.log(), std::move(hooks));
  loop_ = std::thread([this] { outcome_ = service_->run(); });
}

RunningService::RunningService(const service::ServiceConfig& config,
                               std::shared_ptr<service::PlanAnswerer> answerer)
    : planner(echo_result), channels{config.prefix} {
  scenes.put(empty_scene("room"));
  scenes.put(empty_scene("hall"));
  service_.emplace(transport, scenes, config, std::move(answerer), log_.log());
  loop_ = std::thread([this] { outcome_ = service_->run(); });
}

RunningService::~RunningService() {
  planner.release();
  if (loop_.joinable()) stop();
}

void RunningService::send(const plan_request_t& request) {
  for (wire::Bytes& page : wire::encode_pages(request)) {
    send_on(channels.plan_request(), std::move(page));
  }
}

void RunningService::send_on(const std::string& channel, wire::Bytes bytes) {
  transport.deliver(channel, std::move(bytes));
}

std::optional<plan_response_t> RunningService::answer_to(const plan_request_t& request,
                                                         std::size_t skip_pages) {
  const std::string channel = channels.plan_response(request.client_id);
  wire::PageAssembly<plan_response_t> assembly;
  for (std::size_t seen = skip_pages;; ++seen) {
    const std::optional<wire::Bytes> bytes = transport.message_on(channel, seen);
    if (!bytes) return std::nullopt;
    wire::Decoded<plan_response_t> decoded = wire::decode<plan_response_t>(*bytes);
    if (!decoded.message) {
      ADD_FAILURE() << decoded.fault.text("plan_response_t");
      return std::nullopt;
    }
    if (decoded.message->request_id != request.request_id) continue;
    auto outcome = assembly.add(std::move(*decoded.message));
    if (outcome.whole) return outcome.whole;
  }
}

service::RunOutcome RunningService::stop() {
  service_->request_stop();
  return wait_for_end();
}

service::RunOutcome RunningService::wait_for_end() {
  loop_.join();
  return *outcome_;
}

plan_request_t request_with(std::int64_t request_id, std::size_t keyframes) {
  Random random(kSeed + static_cast<std::uint64_t>(request_id));
  return messages::to_wire(sample_request(keyframes, random), {"tester", request_id, 0});
}

plan_request_t request_of(const std::string& client, std::int64_t request_id) {
  plan_request_t request = request_with(request_id);
  request.client_id = client;
  return request;
}

}  // namespace camway::testing
