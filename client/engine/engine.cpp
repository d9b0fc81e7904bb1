// SPDX-License-Identifier: MIT
#include "client/engine/engine.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include <camway/map_page_t.hpp>
#include <camway/missing_pages_t.hpp>
#include <camway/occupancy_response_t.hpp>
#include <camway/plan_progress_t.hpp>
#include <camway/plan_response_t.hpp>
#include <camway/scene_response_t.hpp>
#include <camway/status_t.hpp>
#include <camway/upload_status_t.hpp>

#include "client/messages/status.h"
#include "lcmtypes/wire/check.h"

namespace camway {
namespace {

using std::chrono::milliseconds;

/// Room for two copies of the largest answer, or answers to several requests.
constexpr int kResponseQueue = 2 * wire::kMaxResponsePages;
constexpr int kSmallQueue = 256;

/// Bytes that are sent without a pause: two messages of full size fit the usual receive buffer of
/// 208 KiB, with room for others.
constexpr std::size_t kBurstBytes = 120'000;
constexpr milliseconds kSendPause{1};

template <class Message>
std::optional<std::int64_t> request_of(std::span<const std::uint8_t> bytes) {
  const auto sender = wire::peek_sender(wire::layout_of<Message>(), bytes);
  return sender ? std::optional(sender->request_id) : std::nullopt;
}

}  // namespace

Engine::Engine(LcmConnection& connection, Context& context)
    : connection_(connection),
      channels_(context.channels()),
      watches_(context, {[this](Outgoing message) { outgoing_.push_back(std::move(message)); },
                         [this](std::shared_ptr<Call> call) { start(std::move(call)); }}) {
  listen(context.options().client_id);
  thread_ = std::thread([this] { run_thread(); });
}

Engine::~Engine() {
  if (!thread_.joinable()) return;
  closing_ = true;
  connection_.wake();
  thread_.join();
}

void Engine::close_from_handler(std::function<void()> release) {
  closing_ = true;
  watches_.close();
  run_tasks();
  for (const auto& [key, call] : calls_) kept_.push_back(call);
  end_all(Outcome::kClosed);
  release_ = std::move(release);
  thread_.detach();
}

void Engine::run_thread() {
  run();
  // `release` destroys this object.
  if (const std::function<void()> release = std::move(release_)) release();
}

template <class Response>
void Engine::take_answers(Call::Kind kind, const std::string& channel, int queue) {
  connection_.listen(channel, queue, [this, kind](auto bytes) {
    const auto id = request_of<Response>(bytes);
    // A message that cannot be read goes to every call of this kind, for its text about the
    // failure.
    if (closing_) return;
    for (auto& [key, call] : calls_) {
      if (key.first == kind && (!id || *id == key.second)) call->take_answer(bytes, Clock::now());
    }
    if (kind == Call::Kind::kPlan && id) watches_.take_answer(*id, bytes);
  });
}

void Engine::listen(const std::string& client_id) {
  take_answers<plan_response_t>(Call::Kind::kPlan, channels_.plan_response(client_id),
                                kResponseQueue);
  connection_.listen(channels_.plan_progress(client_id), kSmallQueue, [this](auto bytes) {
    const auto id = request_of<plan_progress_t>(bytes);
    Call* const call = id ? find(Call::Kind::kPlan, *id) : nullptr;
    if (call != nullptr) call->take_progress(bytes);
  });
  connection_.listen(channels_.plan_offer(client_id), kResponseQueue, [this](auto bytes) {
    const auto id = request_of<plan_response_t>(bytes);
    if (id) watches_.take_offer(*id, bytes);
  });
  connection_.listen(channels_.missing_pages(client_id), kSmallQueue,
                     [this](auto bytes) { take_missing_pages(bytes); });
  take_answers<occupancy_response_t>(Call::Kind::kOccupancy,
                                     channels_.occupancy_response(client_id), kSmallQueue);
  take_answers<scene_response_t>(Call::Kind::kScene, channels_.scene_response(client_id),
                                 kSmallQueue);
  take_answers<upload_status_t>(Call::Kind::kUpload, channels_.upload_status(client_id),
                                kSmallQueue);
  connection_.listen(channels_.watch_report(client_id), kSmallQueue,
                     [this](auto bytes) { watches_.take_report(bytes, Clock::now()); });
  take_answers<map_page_t>(Call::Kind::kMap, channels_.map_page(client_id), kSmallQueue);
  connection_.listen(channels_.status(), kSmallQueue,
                     [this](auto bytes) { take_heartbeat(bytes); });
}

void Engine::start(std::shared_ptr<Call> call) {
  post([this, call = std::move(call)] {
    if (broken_) {
      call->finish(Outcome::kBroken);
      return;
    }
    const auto [position, is_new] = calls_.try_emplace({call->kind(), call->request_id()}, call);
    // If the same request is pending, the later call replaces the earlier one.
    if (!is_new) std::exchange(position->second, call)->finish(Outcome::kClosed);
  });
}

void Engine::cancel(Call::Kind kind, std::int64_t request_id) {
  post([this, kind, request_id] {
    if (Call* const call = find(kind, request_id)) call->cancel();
  });
}

void Engine::cancel_all(Call::Kind kind) {
  post([this, kind] {
    for (const auto& [key, call] : calls_) {
      if (key.first == kind) call->cancel();
    }
  });
}

void Engine::watch(const PlanRequest& request, WatchHandler handler) {
  post([this, request, handler = std::move(handler)] { watches_.add(request, handler); });
}

void Engine::unwatch(std::int64_t request_id) {
  post([this, request_id] { watches_.remove(request_id); });
}

void Engine::take_better(std::int64_t request_id) {
  post([this, request_id] { watches_.take_better(request_id); });
}

std::future<bool> Engine::unwatch(std::int64_t request_id, Clock::time_point until) {
  auto promise = std::make_shared<std::promise<bool>>();
  std::future<bool> ended = promise->get_future();
  post([this, request_id, until, promise] {
    watches_.remove(request_id);
    if (Call* const call = find(Call::Kind::kPlan, request_id)) call->cancel();
    pending_unwatches_.push_back({request_id, until, std::move(*promise)});
  });
  return ended;
}

std::future<std::optional<DaemonStatus>> Engine::next_heartbeat(Clock::time_point until) {
  auto promise = std::make_shared<std::promise<std::optional<DaemonStatus>>>();
  std::future<std::optional<DaemonStatus>> heartbeat = promise->get_future();
  post([this, until, promise] { pending_statuses_.push_back({until, std::move(*promise)}); });
  return heartbeat;
}

void Engine::post(std::function<void()> task) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    tasks_.push_back(std::move(task));
  }
  connection_.wake();
}

void Engine::run() {
  while (!closing_) {
    run_tasks();
    const Clock::time_point now = Clock::now();
    step(now);
    watches_.step(now);
    end_waiters(now);
    end_leavers(now);
    send_some(now);
    if (connection_.wait(next_wake()) == LcmConnection::Wait::kBroken) broken_ = true;
    if (broken_) end_all(Outcome::kBroken);
    // The next heartbeat may be of another daemon.
    if (std::exchange(is_unheard_, false)) end_calls(Outcome::kUnsigned);
  }
  run_tasks();
  end_all(Outcome::kClosed);
}

void Engine::run_tasks() {
  std::unique_lock<std::mutex> lock(mutex_);
  // Tasks that these tasks post run at the next call.
  for (std::size_t left = tasks_.size(); left > 0 && !tasks_.empty(); --left) {
    const std::function<void()> task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    task();
    lock.lock();
  }
}

void Engine::step(Clock::time_point now) {
  for (auto position = calls_.begin(); !closing_ && position != calls_.end();) {
    // Ending a call runs the user's code, so the call is removed first.
    const std::optional<Outcome> outcome = step(*position->second, now);
    if (!outcome) {
      ++position;
      continue;
    }
    const std::shared_ptr<Call> call = position->second;
    position = calls_.erase(position);
    call->finish(*outcome);
  }
}

std::optional<Outcome> Engine::step(Call& call, Clock::time_point now) {
  if (call.answered()) return Outcome::kAnswered;
  const auto send = [this](const std::vector<Outgoing>& messages) {
    outgoing_.insert(outgoing_.end(), messages.begin(), messages.end());
  };
  switch (call.retry().next(now)) {
    case Retry::Action::kSend:
      send(call.request_messages());
      break;
    case Retry::Action::kAskMissing:
      send(call.missing());
      break;
    case Retry::Action::kSilence:
      return Outcome::kSilence;
    case Retry::Action::kDeadline:
      return Outcome::kDeadline;
    case Retry::Action::kWait:
      break;
  }
  return std::nullopt;
}

void Engine::send_some(Clock::time_point now) {
  if (now < send_at_) return;
  std::size_t room = kBurstBytes;
  while (!outgoing_.empty() && outgoing_.front().bytes.size() <= room) {
    room -= outgoing_.front().bytes.size();
    if (!connection_.publish(outgoing_.front().channel, outgoing_.front().bytes)) broken_ = true;
    outgoing_.pop_front();
  }
  if (!outgoing_.empty()) send_at_ = now + kSendPause;
}

Clock::time_point Engine::next_wake() const {
  Clock::time_point next = std::min(watches_.wake(), Clock::now() + std::chrono::seconds(1));
  if (!outgoing_.empty()) next = std::min(next, send_at_);
  for (const auto& [key, call] : calls_) {
    next = std::min(next, call->answered() ? Clock::time_point{} : call->retry().wake());
  }
  for (const PendingStatus& call : pending_statuses_) next = std::min(next, call.until);
  for (const PendingUnwatch& pending : pending_unwatches_) next = std::min(next, pending.until);
  return next;
}

void Engine::end_waiters(Clock::time_point now) {
  const auto over = std::partition(pending_statuses_.begin(), pending_statuses_.end(),
                                   [now](const PendingStatus& call) { return now < call.until; });
  for (auto call = over; call != pending_statuses_.end(); ++call) {
    call->promise.set_value(std::nullopt);
  }
  pending_statuses_.erase(over, pending_statuses_.end());
}

void Engine::end_leavers(Clock::time_point now) {
  std::erase_if(pending_unwatches_, [&](PendingUnwatch& pending) {
    // A request that is still being planned would be watched once it is answered.
    const bool is_over = find(Call::Kind::kPlan, pending.request_id) == nullptr &&
                         !watches_.is_ending(pending.request_id);
    if (!is_over && now < pending.until) return false;
    pending.promise.set_value(is_over);
    return true;
  });
}

void Engine::end_all(Outcome outcome) {
  end_calls(outcome);
  end_waiters(Clock::time_point::max());
  end_leavers(Clock::time_point::max());
}

void Engine::end_calls(Outcome outcome) {
  for (const auto& [key, call] : calls_) ending_.push_back(call);
  calls_.clear();
  while (!ending_.empty()) {
    // A handler may call this function again by closing the client.
    const std::shared_ptr<Call> call = std::move(ending_.front());
    ending_.pop_front();
    call->finish(outcome);
  }
}

Call* Engine::find(Call::Kind kind, std::int64_t request_id) {
  const auto position = calls_.find({kind, request_id});
  return position == calls_.end() ? nullptr : position->second.get();
}

/// Sends the pages of a request that the daemon is missing.
void Engine::take_missing_pages(std::span<const std::uint8_t> bytes) {
  const auto decoded = wire::decode<missing_pages_t>(bytes);
  if (!decoded.message) return;
  Call* const call = find(Call::Kind::kPlan, decoded.message->request_id);
  if (call == nullptr) return;
  call->retry().note_life();
  const std::vector<Outgoing>& pages = call->request_messages();
  std::set<std::int32_t> which(decoded.message->missing.begin(), decoded.message->missing.end());
  for (const std::int32_t page : which) {
    if (page >= 0 && static_cast<std::size_t>(page) < pages.size()) {
      outgoing_.push_back(pages[static_cast<std::size_t>(page)]);
    }
  }
}

void Engine::take_heartbeat(std::span<const std::uint8_t> bytes) {
  const std::optional<DaemonStatus> status = read_status(bytes);
  if (!status) return;
  const Clock::time_point now = Clock::now();
  for (auto& [key, call] : calls_) call->retry().note_heartbeat(status->uptime_s, now);
  is_unheard_ = status->signed_only && !connection_.signs();
  watches_.take_heartbeat(*status, now);
  std::vector<PendingStatus> pending;
  pending.swap(pending_statuses_);
  for (PendingStatus& call : pending) call.promise.set_value(status);
}

}  // namespace camway
