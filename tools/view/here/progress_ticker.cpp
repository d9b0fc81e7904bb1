// SPDX-License-Identifier: MIT
#include "tools/view/here/progress_ticker.h"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <string_view>
#include <utility>

namespace camway::view {
namespace {

constexpr std::chrono::milliseconds kTickPeriod{100};
constexpr double kMillisecondsPerSecond = 1e3;

constexpr std::array<std::string_view, 5> kStageNames{"waiting", "preparing", "detecting",
                                                      "correcting", "certifying"};

}  // namespace

ProgressTicker::ProgressTicker() : thread_([this] { run(); }) {}

ProgressTicker::~ProgressTicker() {
  {
    const std::lock_guard lock(mutex_);
    has_ended_ = true;
  }
  changed_.notify_all();
}

ProgressTicker::Entry::~Entry() {
  if (ticker_ == nullptr) return;
  const std::lock_guard lock(ticker_->mutex_);
  ticker_->plans_.erase(key_);
}

ProgressTicker::Entry ProgressTicker::enter(const Tell& tell,
                                            const std::shared_ptr<const base::Progress>& state,
                                            const base::Deadline& deadline, double deadline_s) {
  if (!tell) return {nullptr, 0};
  std::uint64_t key = 0;
  {
    const std::lock_guard lock(mutex_);
    key = ++last_key_;
    Told& told = plans_.emplace(key, Told{tell, state, deadline, deadline_s, -1}).first->second;
    tell_if_changed(told);
  }
  changed_.notify_all();
  return {this, key};
}

void ProgressTicker::tell_if_changed(Told& told) {
  const auto stage = static_cast<int>(told.state->stage.load());
  const int collisions = told.state->collisions;
  const int corrected = told.state->corrected;
  constexpr int kStages = static_cast<int>(kStageNames.size());
  const int now = stage + kStages * (collisions + corrected);  // each of them only increases
  if (now == told.last) return;
  told.last = now;
  told.tell(fmt::format(
      "{{\"stage\": \"{}\", \"collisions\": {}, \"corrected\": {}, \"elapsed_s\": {:.3f}, "
      "\"deadline_s\": {}}}",
      kStageNames.at(static_cast<std::size_t>(stage)), collisions, corrected,
      told.deadline.elapsed_ms() / kMillisecondsPerSecond, told.deadline_s));
}

void ProgressTicker::run() {
  std::unique_lock lock(mutex_);
  while (!has_ended_) {
    if (plans_.empty()) {
      changed_.wait(lock, [this] { return has_ended_ || !plans_.empty(); });
    } else {
      changed_.wait_for(lock, kTickPeriod, [this] { return has_ended_; });
      for (auto& [key, told] : plans_) tell_if_changed(told);
    }
  }
}

}  // namespace camway::view
