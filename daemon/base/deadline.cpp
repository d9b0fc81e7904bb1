// SPDX-License-Identifier: MIT
#include "daemon/base/deadline.h"

#include <algorithm>
#include <utility>

namespace camway::collision {

namespace {

// Longer than any process runs, and short enough that no duration overflows.
constexpr double kLongest_s = 1e8;

std::chrono::steady_clock::duration duration_of(double seconds) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(std::clamp(seconds, 0.0, kLongest_s)));
}

}  // namespace

Deadline::Deadline(Clock::duration budget) : start_(Clock::now()), budget_(budget) {}

Deadline Deadline::after_s(double seconds) { return Deadline(duration_of(seconds)); }

Deadline Deadline::never() { return after_s(kLongest_s); }

Deadline Deadline::after_looks(int looks) {
  Deadline deadline{std::chrono::milliseconds(looks)};
  deadline.looks_ = std::make_shared<std::atomic<std::int64_t>>(0);
  return deadline;
}

Deadline Deadline::watched(std::stop_token stop, std::shared_ptr<Progress> progress) const {
  Deadline watched = *this;
  watched.stop_ = std::move(stop);
  watched.progress_ = std::move(progress);
  return watched;
}

Deadline Deadline::not_before_s(double seconds) const {
  Deadline later = *this;
  later.budget_ = std::max(budget_, now() - start_ + duration_of(seconds));
  return later;
}

Deadline Deadline::sooner_by_s(double seconds) const {
  Deadline sooner = *this;
  sooner.budget_ -= duration_of(seconds);
  return sooner;
}

Deadline Deadline::share_of_rest(double share) const {
  Deadline sooner = *this;
  sooner.budget_ = now() - start_ + duration_of(share * remaining_s());
  return sooner;
}

bool Deadline::passed() const { return told(stopped() || now() - start_ >= budget_); }

bool Deadline::leaves_s(double seconds) const { return !told(remaining_s() < seconds); }

bool Deadline::told(bool is_over) const {
  if (is_over) struck_->store(true, std::memory_order_relaxed);
  return is_over;
}

double Deadline::remaining_s() const {
  if (stopped()) return 0.0;
  const double left_s = std::chrono::duration<double>(budget_ - (now() - start_)).count();
  return std::max(left_s, 0.0);
}

double Deadline::elapsed_ms() const {
  return std::chrono::duration<double, std::milli>(now() - start_).count();
}

Deadline::Clock::time_point Deadline::now() const {
  if (!looks_) return Clock::now();
  return start_ + std::chrono::milliseconds(looks_->fetch_add(1));
}

void Deadline::report(Progress::Stage stage) const {
  if (progress_) progress_->stage = stage;
}

void Deadline::report_collisions(std::size_t found, std::size_t corrected) const {
  if (!progress_) return;
  progress_->collisions = static_cast<int>(found);
  progress_->corrected = static_cast<int>(corrected);
}

}  // namespace camway::collision
