// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/service/service.h"
#include "lcmtypes/wire/page_assembly.h"
#include "tests/service/fake_transport.h"
#include "tests/support/captured_log.h"

namespace camway::testing {

/// A stand-in for planning that answers with `result(request)` and can hold every call until
/// `release`. Thread-safe.
class FakePlanner {
 public:
  using Result = std::function<planning::PlanResult(const planning::PlanRequest&)>;

  explicit FakePlanner(Result result) : result_(std::move(result)) {}

  planning::PlanResult plan(const planning::PlanRequest& request, const base::Deadline& deadline);

  void hold();
  void release();
  /// Waits until `count` calls have begun. Returns false if that takes too long.
  [[nodiscard]] bool wait_for_calls(int count) const;
  [[nodiscard]] int calls() const;
  /// Returns the time that the last call's deadline left at its begin.
  [[nodiscard]] double last_budget_s() const;

 private:
  Result result_;
  mutable std::mutex mutex_;  ///< guards all members below
  mutable std::condition_variable changed_;
  int calls_ = 0;
  double last_budget_s_ = 0.0;
  bool held_ = false;
};

/// Returns an answer that depends on the request only: a path of one segment for each keyframe.
planning::PlanResult echo_result(const planning::PlanRequest& request);

/// Returns the default settings with these two changed.
inline service::ServiceConfig with_workers(int workers, std::size_t queue_capacity) {
  service::ServiceConfig config;
  config.workers = workers;
  config.queue.jobs = queue_capacity;
  return config;
}

/// A service on a fake transport with the scenes "room" and "hall". Runs on a thread of its own.
class RunningService {
 public:
  explicit RunningService(const service::ServiceConfig& config = {},
                          FakePlanner::Result result = echo_result,
                          service::ServiceHooks hooks = {},
                          const scene::SceneStoreLimits& limits = {},
                          scene::SceneJournal* journal = nullptr);
  /// `planner` is not asked then.
  RunningService(const service::ServiceConfig& config,
                 std::shared_ptr<service::PlanAnswerer> answerer);
  ~RunningService();

  /// Sends all pages of a request, in this order.
  void send(const plan_request_t& request);
  void send_on(const std::string& channel, wire::Bytes bytes);

  /// Returns the first complete answer to `request` after `skip_pages` messages on its channel.
  std::optional<plan_response_t> answer_to(const plan_request_t& request,
                                           std::size_t skip_pages = 0);

  /// Stops the service and returns the outcome of its run.
  service::RunOutcome stop();
  service::RunOutcome wait_for_end();

  [[nodiscard]] service::Service& service() { return *service_; }
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

/// Returns a request of client "tester" on scene "room" with arbitrary finite keyframes.
plan_request_t request_with(std::int64_t request_id, std::size_t keyframes = 3);
/// Returns such a request of another client.
plan_request_t request_of(const std::string& client, std::int64_t request_id);

}  // namespace camway::testing
