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
#include "daemon/service/plans/plan_config.h"
#include "daemon/service/watches/watches.h"

namespace camway::service {

/// Answers plan requests. The loop thread calls it; workers only run the planner and encode.
///
/// A request takes this way: bytes checked, decoded, pages joined, known ones answered from the
/// cache or left alone while they are being planned, scene looked up, queued, planned, encoded,
/// cached, sent. Deadlines run from when all pages are there. All answers to requests that were
/// read are cached but `overloaded`, so that the same request can be sent again later, and
/// conflicts, whose ids belong to another request, and what is refused before it is looked up.
class PlanService {
 public:
  using Clock = std::chrono::steady_clock;

  /// `core` and `watches` must outlive the service.
  PlanService(Core& core, Watches& watches, const PlanConfig& config, Planner planner)
      : core_(core),
        watches_(watches),
        config_(config),
        planner_(std::move(planner)),
        pages_(config.assembly),
        cache_(core.config.cache) {}

  // Messages on the channels for plan requests, for calling them off, for pages of answers that did
  // not come. They throw only for want of memory.
  void on_request(std::span<const std::uint8_t> message);
  void on_cancel(std::span<const std::uint8_t> message);
  void on_missing_pages(std::span<const std::uint8_t> message);

  /// Sends what is due by now: how far planning is, and questions for pages of requests. Has
  /// watched paths planned again that collide.
  void tick(Clock::time_point now);
  /// When `tick` has something to do next; the end of time if never.
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
  void begin(std::shared_ptr<const plan_request_t> request, const RequestKey& key);
  void run(const Pending& pending);
  void finish(const Pending& pending, const plan_response_t& answer, Pages pages);
  void finish_plainly(const Pending& pending, std::int32_t status, std::string_view message);
  void abandon(const Pending& pending, Refusal why);
  /// Answers that there is no room; a request that is sent again is as good as new.
  void refuse(const plan_request_t& request, const std::string& message);
  void answer_uncached(const plan_request_t& request, std::int32_t status,
                       std::string_view message);
  void send(const RequestKey& key, Pages pages, Outbox::Kind kind = Outbox::Kind::kAnswer);

  void watch(const Pending& pending, const Answered& answered);
  void plan_broken(Clock::time_point now);
  void plan_improvable(Clock::time_point now);
  void put_in_force(Watches::Taken taken, Clock::time_point now);
  void plan_again(const Watches::Request& watched, bool for_offer);
  void run_again(const Replan& replan);
  void finish_again(const Replan& replan, const Replanned& done);
  void give_up(const Replan& replan);

  Core& core_;
  Watches& watches_;
  const PlanConfig config_;
  Planner planner_;
  PageAssembly<plan_request_t> pages_;
  AnswerCache cache_;
  InFlight in_flight_;
  std::size_t bytes_ = 0;       ///< of the requests in flight
  std::size_t replanning_ = 0;  ///< watched paths that wait for a worker or are being planned
};

}  // namespace camway::service
