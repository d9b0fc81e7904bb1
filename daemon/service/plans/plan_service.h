// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "daemon/service/core/answer_cache.h"
#include "daemon/service/core/core.h"
#include "daemon/service/plans/in_flight.h"
#include "daemon/service/plans/plan_answer.h"
#include "daemon/service/plans/plan_answerer.h"
#include "daemon/service/plans/plan_config.h"
#include "daemon/service/watches/watches.h"

namespace camway::service {

/// Answers plan requests. Workers wait for the answerer and encode; all else runs on the loop
/// thread.
///
/// Stages of a request: bytes checked, decoded, pages joined, looked up in the cache (answered from
/// there, or ignored while it is being planned), scene looked up, queued, planned, encoded, cached,
/// sent. Deadlines count from the arrival of the last page. Answers to requests that were read are
/// cached, with three exceptions: `overloaded`, so that the same request can be sent again later;
/// conflicts, whose ids belong to another request; and refusals before the look-up in the cache.
/// Not thread-safe: for the loop thread.
class PlanService {
 public:
  using Clock = std::chrono::steady_clock;

  /// `core` and `watches` must outlive the service. Requires an answerer that is not null.
  PlanService(Core& core, Watches& watches, const PlanConfig& config,
              std::shared_ptr<PlanAnswerer> answerer)
      : core_(core),
        watches_(watches),
        config_(config),
        answerer_(std::move(answerer)),
        pages_(config.assembly),
        cache_(core.config.cache) {}

  // Handlers of the channels for plan requests, for cancelling them, and for missing pages of
  // answers. They throw only if memory runs out.
  void on_request(std::span<const std::uint8_t> message);
  void on_cancel(std::span<const std::uint8_t> message);
  void on_missing_pages(std::span<const std::uint8_t> message);

  /// Sends progress reports and questions for missing pages that are due by `now`. Begins to plan
  /// watched paths that collide again.
  void tick(Clock::time_point now);
  /// Returns when `tick` is due next; the end of time if never.
  [[nodiscard]] Clock::time_point next_tick() const;

 private:
  struct Pending;
  struct Replan;
  struct Replanned;

  void refuse_malformed(const wire::Sender& sender, std::string_view reason);
  /// `refuse_malformed`, for `Core::read`.
  auto refusing() {
    return [this](const wire::Sender& sender, std::string_view reason) {
      refuse_malformed(sender, reason);
    };
  }
  void take(plan_request_t request);
  /// Refuses a request whose scene is older than its `least_revision`. Returns whether it did.
  bool refuse_old_scene(const plan_request_t& request);
  /// Sends an answer from the cache.
  void repeat_answer(const RequestKey& key, const Pages& pages);
  void begin(std::shared_ptr<const plan_request_t> request, const RequestKey& key);
  void run(const Pending& pending);
  void finish(const Pending& pending, const plan_response_t& answer, Pages pages);
  void finish_plainly(const Pending& pending, std::int32_t status, std::string_view message);
  void abandon(const Pending& pending, Refusal why);
  /// Answers that there is no room, and forgets the request, so that it can be sent again.
  void refuse(const plan_request_t& request, const std::string& message);
  void answer_uncached(const plan_request_t& request, std::int32_t status, std::string_view message,
                       const scene::Snapshot* snapshot = nullptr);
  void send(const RequestKey& key, Pages pages, Outbox::Kind kind = Outbox::Kind::kAnswer);

  void watch(const Pending& pending, const Answered& answered);
  void plan_broken(Clock::time_point now);
  void plan_improvable(Clock::time_point now);
  void put_in_force(Watches::Accepted accepted, Clock::time_point now);
  void plan_again(const Watches::Request& watched, bool for_offer);
  void run_again(const Replan& replan);
  void finish_again(const Replan& replan, const Replanned& done);
  void give_up(const Replan& replan);

  Core& core_;
  Watches& watches_;
  const PlanConfig config_;
  const std::shared_ptr<PlanAnswerer> answerer_;
  wire::PageAssembly<plan_request_t> pages_;
  AnswerCache cache_;
  InFlight in_flight_;
  std::size_t bytes_ = 0;       ///< size of the requests in flight
  std::size_t replanning_ = 0;  ///< watched paths that wait for a worker or are being planned
};

}  // namespace camway::service
