// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "daemon/messages/pages.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/service/service.h"
#include "tests/service/fake_transport.h"
#include "tests/support/captured_log.h"

namespace camway::testing {

/// Stands in for planning: answers with what `result` makes of the request, and can be told to hold
/// every call until released. From any thread.
class FakePlanner {
 public:
  using Result = std::function<planning::PlanResult(const planning::PlanRequest&)>;

  explicit FakePlanner(Result result) : result_(std::move(result)) {}

  planning::PlanResult plan(const planning::PlanRequest& request, const base::Deadline& deadline);

  void hold();
  void release();
  /// Waits until `count` calls have begun; false if that takes too long.
  [[nodiscard]] bool wait_for_calls(int count) const;
  [[nodiscard]] int calls() const;
  /// What was left of the last call's deadline when it began.
  [[nodiscard]] double last_budget_s() const;

 private:
  Result result_;
  mutable std::mutex mutex_;  ///< guards all below
  mutable std::condition_variable changed_;
  int calls_ = 0;
  double last_budget_s_ = 0.0;
  bool held_ = false;
};

/// An answer that depends on nothing but the request: a path of one segment for each keyframe.
planning::PlanResult echo_result(const planning::PlanRequest& request);

/// The service's own settings but for these.
inline service::ServiceConfig with_workers(int workers, std::size_t queue_capacity) {
  service::ServiceConfig config;
  config.workers = workers;
  config.queue.jobs = queue_capacity;
  return config;
}

/// A service on a fake transport, run by a thread of its own, with scenes "room" and "hall".
class RunningService {
 public:
  explicit RunningService(const service::ServiceConfig& config = {},
                          FakePlanner::Result result = echo_result,
                          service::ServiceHooks hooks = {},
                          const scene::SceneStoreLimits& limits = {});
  ~RunningService();

  /// Sends all pages of a request, in this order.
  void send(const plan_request_t& request);
  void send_on(const std::string& channel, service::Bytes bytes);

  /// The first complete answer to `request` after the first `skip_pages` messages on its channel.
  std::optional<plan_response_t> answer_to(const plan_request_t& request,
                                           std::size_t skip_pages = 0);

  /// Asks for the end of the run and returns how it ended.
  service::RunOutcome stop();
  service::RunOutcome wait_for_end();

  [[nodiscard]] std::string log_text() const { return log_.text(); }

  FakeTransport transport;
  scene::SceneStore scenes;
  FakePlanner planner;
  const wire::Channels channels;

 private:
  CapturedLog log_;
  std::optional<service::Service> service_;
  std::optional<service::RunOutcome> outcome_;
  std::thread loop_;
};

/// A request of client "tester" on scene "room" with arbitrary finite keyframes.
plan_request_t request_with(std::int64_t request_id, std::size_t keyframes = 3);
/// The same of another client.
plan_request_t request_of(const std::string& client, std::int64_t request_id);

}  // namespace camway::testing
