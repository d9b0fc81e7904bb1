// SPDX-License-Identifier: MIT
#include "daemon/fleet/planner_board.h"

#include <algorithm>

namespace camway::fleet {

void PlannerBoard::note(const planner_status_t& status) {
  {
    const std::lock_guard lock(mutex_);
    if (!keep(status)) return;
    ++changes_;
  }
  changed_.notify_all();
  tell();
}

bool PlannerBoard::keep(const planner_status_t& status) {
  const Clock::time_point now = now_();
  const auto known = planners_.find(status.planner_id);
  if (known != planners_.end() && !is_newer(known->second, status, now)) return false;
  const bool has_ended = status.is_leaving != 0 && status.workers == 0;
  if (has_ended) {
    if (known != planners_.end()) planners_.erase(known);
    return true;
  }
  if (known == planners_.end()) make_room(now);
  Known& planner = planners_[status.planner_id];
  if (planner.status.start_id != status.start_id) planner.own = 0;
  planner.status = status;
  planner.heard = now;
  planner.others = std::max(0, status.running - planner.own);
  planner.refuses = false;
  return true;
}

// Two starts of one planner are compared by their clocks, which may be of two machines: a start
// that was not heard lately has lost its claim.
bool PlannerBoard::is_newer(const Known& known, const planner_status_t& status,
                            Clock::time_point now) const {
  if (status.start_id == known.status.start_id) return status.serial > known.status.serial;
  return status.utime > known.status.utime || !is_alive(known, now);
}

void PlannerBoard::make_room(Clock::time_point now) {
  std::erase_if(planners_, [&](const auto& entry) {
    return entry.second.own == 0 && now - entry.second.heard >= kForgotten;
  });
  if (planners_.size() < kMostPlanners) return;
  planners_.erase(std::ranges::min_element(planners_, {},
                                           [](const auto& entry) { return entry.second.heard; }));
}

int PlannerBoard::free_of(const Known& known) const {
  return std::max(0, known.status.workers - known.others - known.own);
}

PlannerBoard::Choice PlannerBoard::take(std::int64_t least_position,
                                        const std::set<Planner>& avoided) {
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = now_();
  Choice choice;
  KnownMap::iterator best = planners_.end();
  for (auto position = planners_.begin(); position != planners_.end(); ++position) {
    const Known& known = position->second;
    if (!takes_jobs(known, now)) continue;
    if (choice.outlook == Outlook::kNone) choice.outlook = Outlook::kBehind;
    const bool is_avoided = avoided.contains({position->first, known.status.start_id});
    if (is_avoided || known.status.log_position < least_position) continue;
    choice.outlook = Outlook::kBusy;
    if (known.refuses || free_of(known) == 0) continue;
    if (best == planners_.end() || free_of(known) > free_of(best->second)) best = position;
  }
  if (best == planners_.end()) return choice;
  ++best->second.own;
  return {Outlook::kTaken, {best->first, best->second.status.start_id}};
}

void PlannerBoard::give_back(const Planner& planner, Return why) {
  {
    const std::lock_guard lock(mutex_);
    const auto known = planners_.find(planner.id);
    if (known == planners_.end() || known->second.status.start_id != planner.start_id) return;
    known->second.own = std::max(0, known->second.own - 1);
    if (why == Return::kRefused) known->second.refuses = true;
    ++changes_;
  }
  changed_.notify_all();
}

bool PlannerBoard::is_lost(const Planner& planner) const {
  const std::lock_guard lock(mutex_);
  const auto known = planners_.find(planner.id);
  return known == planners_.end() || known->second.status.start_id != planner.start_id ||
         !is_alive(known->second, now_());
}

bool PlannerBoard::has_ended(const Planner& planner) const {
  const std::lock_guard lock(mutex_);
  const auto known = planners_.find(planner.id);
  return known == planners_.end() || known->second.status.start_id != planner.start_id;
}

int PlannerBoard::free_slots() const {
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = now_();
  int slots = 0;
  for (const auto& [id, known] : planners_) {
    if (takes_jobs(known, now) && !known.refuses) slots += free_of(known);
  }
  return slots;
}

int PlannerBoard::capacity() const {
  const std::lock_guard lock(mutex_);
  return capacity_locked();
}

int PlannerBoard::capacity_locked() const {
  const Clock::time_point now = now_();
  int slots = 0;
  bool is_any_alive = false;
  for (const auto& [id, known] : planners_) {
    if (!takes_jobs(known, now)) continue;
    is_any_alive = true;
    slots += std::max(0, known.status.workers - known.others);
  }
  return is_any_alive ? std::max(slots, 1) : 0;
}

int PlannerBoard::alive() const {
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = now_();
  return static_cast<int>(std::ranges::count_if(
      planners_, [&](const auto& entry) { return is_alive(entry.second, now); }));
}

bool PlannerBoard::is_any_heard_within(std::chrono::milliseconds time) const {
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = now_();
  return std::ranges::any_of(planners_,
                             [&](const auto& entry) { return now - entry.second.heard <= time; });
}

std::vector<fleet_planner_t> PlannerBoard::planners(std::int64_t newest) const {
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = now_();
  std::vector<fleet_planner_t> list;
  for (const auto& [id, known] : planners_) {
    if (now - known.heard >= kForgotten) continue;
    fleet_planner_t planner{};
    planner.id = id;
    planner.host = known.status.host;
    planner.pid = known.status.pid;
    planner.version = known.status.version;
    planner.workers = known.status.workers;
    planner.running = std::max(known.status.running, known.own);
    planner.is_behind = known.status.log_position < newest ? 1 : 0;
    planner.is_other_version = takes_version(known.status.version) ? 0 : 1;
    planner.silent_s = std::chrono::duration<double>(now - known.heard).count();
    list.push_back(std::move(planner));
  }
  return list;
}

void PlannerBoard::wait(std::chrono::milliseconds longest) {
  std::unique_lock lock(mutex_);
  const std::uint64_t seen = changes_;
  changed_.wait_for(lock, longest, [&] { return changes_ != seen; });
}

void PlannerBoard::on_change(std::function<void(int)> listener) {
  {
    const std::lock_guard lock(telling_);
    listener_ = std::move(listener);
    told_.reset();
  }
  tell();
}

void PlannerBoard::tick() { tell(); }

void PlannerBoard::tell() {
  const std::lock_guard telling(telling_);
  if (!listener_) return;
  const int now = capacity();
  if (told_ == now) return;
  told_ = now;
  listener_(now);
}

}  // namespace camway::fleet
