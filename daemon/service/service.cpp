// SPDX-License-Identifier: MIT
#include "daemon/service/service.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "daemon/service/heartbeat.h"

namespace camway::service {

namespace {

/// A worker that becomes idle after its answer does not wake the loop, so a stop polls.
constexpr std::chrono::milliseconds kDrainLook{5};

/// Time between two questions whether another daemon serves.
constexpr std::chrono::milliseconds kAskPause{50};

/// How long a stop waits for workers that are still at cancelled changes of scenes, which may take
/// minutes to notice.
constexpr std::chrono::milliseconds kDrainCancelled{500};

std::chrono::milliseconds in_milliseconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::ceil<std::chrono::milliseconds>(
      std::max(duration, std::chrono::steady_clock::duration::zero()));
}

}  // namespace

Service::Service(Transport& transport, scene::SceneStore& scenes, const ServiceConfig& config,
                 std::shared_ptr<PlanAnswerer> answerer, std::shared_ptr<Log> log,
                 ServiceHooks hooks)
    : hooks_(std::move(hooks)),
      longest_deadline_s_(config.deadline.max_s),
      core_(transport, scenes, config, std::move(log)),
      claim_(core_),
      watches_(core_, scenes, config.watches),
      plans_(core_, watches_, config, std::move(answerer)),
      occupancy_(core_, config.occupancy_deadline),
      scenes_(core_, scenes, config) {}

Service::Service(Transport& transport, scene::SceneStore& scenes, const ServiceConfig& config,
                 Planner planner, std::shared_ptr<Log> log, ServiceHooks hooks)
    : Service(transport, scenes, config,
              std::make_shared<LocalAnswerer>(std::move(planner), config.deadline), std::move(log),
              std::move(hooks)) {}

// Jobs use the services, which are destroyed before the workers in `core_`. So the workers end
// here.
Service::~Service() {
  scenes_.stop();
  core_.workers.stop();
}

std::optional<RunOutcome> Service::look_for_rival() {
  // Before all other subscriptions: no request is taken before it is clear which daemon answers.
  if (!listen_for_claims()) return RunOutcome::kNotSubscribed;
  ask_for_rivals();
  if (broken_) return RunOutcome::kTransportBroken;
  if (claim_.rival()) return yield();
  return std::nullopt;
}

RunOutcome Service::run() {
  if (const std::optional<RunOutcome> end = look_for_rival()) return *end;
  if (!subscribe()) return RunOutcome::kNotSubscribed;
  claim_.serve(Clock::now());
  heartbeat(Clock::now());
  core_.log->info("ready");
  if (hooks_.ready) hooks_.ready();
  while (!stop_.load() && !broken_) {
    const Clock::time_point now = Clock::now();
    if (now >= next_heartbeat_) heartbeat(now);
    if (now >= next_alive_) tell_alive(now);
    run_round(std::min(next_heartbeat_, next_alive_) - now);
    if (claim_.rival()) return yield();
  }
  if (broken_) return RunOutcome::kTransportBroken;
  return drain();
}

void Service::request_stop() noexcept {
  stop_.store(true);
  core_.transport.wake();
}

bool Service::listen_for_claims() {
  if (hears_claims_) return true;
  const auto take = [this](std::span<const std::uint8_t> message) { claim_.on_message(message); };
  const std::string channel = core_.channels.claim();
  hears_claims_ = core_.transport.subscribe(channel, core_.config.subscription_capacity,
                                            guarded(take, channel));
  return hears_claims_;
}

void Service::ask_for_rivals() {
  const Clock::time_point end = Clock::now() + core_.config.claim_window;
  Clock::time_point next = Clock::now();
  while (!stop_.load() && !broken_ && !claim_.rival()) {
    const Clock::time_point now = Clock::now();
    if (now >= end) return;
    if (now >= next) {
      claim_.ask();
      next = now + kAskPause;
    }
    if (!core_.transport.poll(in_milliseconds(std::min(next, end) - now))) broken_ = true;
  }
}

RunOutcome Service::yield() {
  core_.log->error("another daemon serves with this prefix",
                   {{"prefix", core_.config.prefix},
                    {"other", *claim_.rival()},
                    {"hint",
                     "stop it, give this one another --prefix, or let both serve with "
                     "--share-prefix (lcm.share_prefix)"}});
  return RunOutcome::kPrefixTaken;
}

bool Service::subscribe() {
  const auto to = [this](const std::string& channel, auto& service, auto handler) {
    const auto handle = [&service, handler](std::span<const std::uint8_t> message) {
      (service.*handler)(message);
    };
    return core_.transport.subscribe(channel, core_.config.subscription_capacity,
                                     guarded(handle, channel));
  };
  return to(core_.channels.plan_request(), plans_, &PlanService::on_request) &&
         to(core_.channels.cancel(), plans_, &PlanService::on_cancel) &&
         to(core_.channels.missing_pages(), plans_, &PlanService::on_missing_pages) &&
         to(core_.channels.watch(), watches_, &Watches::on_message) &&
         to(core_.channels.occupancy_request(), occupancy_, &OccupancyService::on_message) &&
         to(core_.channels.cancel_occupancy(), occupancy_, &OccupancyService::on_cancel) &&
         to(core_.channels.scene_request(), scenes_, &SceneService::on_request) &&
         to(core_.channels.cancel_scene(), scenes_, &SceneService::on_cancel) &&
         to(core_.channels.upload(), scenes_, &SceneService::on_upload) &&
         to(core_.channels.missing_map_pages(), scenes_, &SceneService::on_missing_map_pages);
}

// One round of the loop: sends finished answers and takes messages.
void Service::run_round(Clock::duration longest_wait) {
  core_.mailbox.run_all();
  core_.expire_jobs();
  plans_.tick(Clock::now());
  watches_.tick(Clock::now());
  scenes_.tick(Clock::now());
  core_.outbox.send_burst();
  const Clock::time_point next = std::min({core_.workers.next_expiry(), plans_.next_tick(),
                                           watches_.next_tick(Clock::now()), scenes_.next_tick()});
  if (next != Clock::time_point::max()) longest_wait = std::min(longest_wait, next - Clock::now());
  std::chrono::milliseconds wait = in_milliseconds(longest_wait);
  if (!core_.outbox.empty()) wait = std::min(wait, Outbox::kPause);
  if (!core_.transport.poll(wait)) broken_ = true;
}

RunOutcome Service::drain() {
  if (hooks_.stopping) hooks_.stopping();
  claim_.leave();
  const std::vector<Job> waiting = core_.workers.close();
  core_.log->info("stopping",
                  {{"being_planned", core_.workers.running()}, {"refused", waiting.size()}});
  for (const Job& job : waiting) job.abandon(Refusal::kStopping);
  scenes_.close();
  const Clock::time_point limit = Clock::now() + core_.config.drain_limit;
  const Clock::time_point cancelled_limit = Clock::now() + kDrainCancelled;
  std::size_t left = 0;
  while (!idle()) {
    const Clock::time_point now = Clock::now();
    if (now >= limit || broken_) {
      core_.log->warn("stopped while planning", {{"being_planned", core_.workers.running()},
                                                 {"unfinished_changes", scenes_.unfinished()}});
      scenes_.give_up();
      if (!broken_) run_round(Clock::duration::zero());
      return RunOutcome::kAbandoned;
    }
    if (now >= cancelled_limit) left += scenes_.leave_cancelled();
    run_round(std::min<Clock::duration>(limit - now, kDrainLook));
  }
  core_.limited_log.report_suppressed(Clock::now());
  core_.log->info("stopped", {{"answers", core_.counters.answered},
                              {"repeated", core_.counters.repeated},
                              {"malformed", core_.counters.malformed},
                              {"cancelled_changes_left", left}});
  return left > 0 ? RunOutcome::kAbandoned : RunOutcome::kDrained;
}

bool Service::idle() const {
  // In this order: a worker leaves its answer in the mailbox before it counts as idle.
  return core_.workers.running() == 0 && scenes_.unfinished() == 0 && core_.mailbox.empty() &&
         core_.outbox.empty();
}

void Service::heartbeat(Clock::time_point now) {
  status_t status = make_status(core_, now - started_);
  if (hooks_.status) hooks_.status(status);
  fit_message(status);
  if (!core_.transport.publish(core_.channels.status(), wire::encode(status))) {
    core_.limited_log.trouble.write("the status could not be published");
  }
  core_.limited_log.report_suppressed(now);
  next_heartbeat_ = now + core_.config.heartbeat_period;
}

void Service::tell_alive(Clock::time_point now) {
  next_alive_ = now + hooks_.alive_period;
  const std::chrono::duration<double> stuck_after =
      std::chrono::duration<double>(longest_deadline_s_) + hooks_.stuck_after;
  const std::chrono::duration<double> longest = core_.workers.longest_run(now);
  if (longest > stuck_after) {
    core_.limited_log.trouble.write("a worker hangs at one request",
                                    {{"seconds", longest.count()}});
  } else if (hooks_.alive) {
    hooks_.alive();
  }
}

std::function<void(std::span<const std::uint8_t>)> Service::guarded(
    std::function<void(std::span<const std::uint8_t>)> handler, std::string channel) {
  return [this, handler = std::move(handler),
          channel = std::move(channel)](std::span<const std::uint8_t> message) {
    try {
      handler(message);
    } catch (const std::exception& exception) {
      core_.note_malformed(channel, message.size(), exception.what());
    } catch (...) {
      core_.note_malformed(channel, message.size(), "unknown exception");
    }
  };
}

}  // namespace camway::service
