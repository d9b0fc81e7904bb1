// SPDX-License-Identifier: MIT
#include "daemon/fleet/planner_server.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <exception>
#include <random>

#include <camway/plan_progress_t.hpp>

#include "daemon/messages/plan.h"
#include "daemon/messages/progress.h"
#include "daemon/messages/text.h"
#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/utime.h"

namespace camway::fleet {
namespace {

/// How often a job that waits for its scene looks for it.
constexpr std::chrono::milliseconds kSceneLook{2};
/// Least time between two statuses.
constexpr std::chrono::milliseconds kLeastPause{10};
/// For a status that is late.
constexpr std::chrono::milliseconds kLateness{100};

std::string name_of_host() {
  std::array<char, wire::kMaxHostBytes + 1> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return {};
  return name.data();
}

std::int64_t random_start_id() {
  std::random_device random;
  return static_cast<std::int64_t>((std::uint64_t{random()} << 32U) | random());
}

JobTable::Key key_of(const RunningJob& job) { return {job.front, job.number}; }

}  // namespace

bool is_planner_alive(nats::Bus& bus, const PlannerOptions& options) {
  std::mutex mutex;  // guards is_heard
  std::condition_variable heard;
  bool is_heard = false;
  const auto subscription = bus.subscribe(
      Subjects{options.fleet}.planner(),
      [&](const std::string&, std::span<const std::uint8_t> bytes) {
        const base::Result<planner_status_t> status = read_status(bytes);
        if (!status || status->planner_id != options.planner_id || status->workers == 0) return;
        const std::lock_guard lock(mutex);
        is_heard = true;
        heard.notify_all();
      });
  if (subscription == nullptr) return false;
  std::unique_lock lock(mutex);
  return heard.wait_for(lock, 2 * options.status_period + kLateness, [&] { return is_heard; });
}

base::Result<std::unique_ptr<PlannerServer>> PlannerServer::open(
    const Parts& parts, const PlannerOptions& options, Position position,
    const std::shared_ptr<service::Log>& log) {
  if (!is_id(options.fleet)) return base::Failure{"the fleet's name is not of [A-Za-z0-9_-]{1,32}"};
  if (!is_id(options.planner_id)) {
    return base::Failure{"the planner's id is not of [A-Za-z0-9_-]{1,32}"};
  }
  std::unique_ptr<PlannerServer> server(
      new PlannerServer(parts, options, std::move(position), log));
  if (!server->subscribe()) return base::Failure{"NATS takes no subscription"};
  server->begin_threads();
  return server;
}

PlannerServer::PlannerServer(const Parts& parts, const PlannerOptions& options, Position position,
                             const std::shared_ptr<service::Log>& log)
    : parts_(parts),
      options_(options),
      subjects_{options.fleet},
      position_(std::move(position)),
      host_(name_of_host()),
      start_id_(random_start_id()),
      trouble_(log, service::LogLevel::kWarn, "fronts", {}) {}

PlannerServer::~PlannerServer() { stop(std::chrono::milliseconds(0)); }

bool PlannerServer::subscribe() {
  subscription_ = parts_.bus.subscribe(
      subjects_.plan(options_.planner_id),
      [this](const std::string&, std::span<const std::uint8_t> bytes) { on_job(bytes); });
  return subscription_ != nullptr;
}

void PlannerServer::begin_threads() {
  for (int i = 0; i < options_.workers; ++i) workers_.emplace_back([this] { work(); });
  teller_ = std::jthread([this](const std::stop_token& stop) { tell_fronts(stop); });
}

void PlannerServer::position_changed() {
  {
    const std::lock_guard lock(mutex_);
    is_changed_ = true;
  }
  to_tell_.notify_all();
}

bool PlannerServer::stop(std::chrono::milliseconds limit) {
  bool is_drained = false;
  {
    std::unique_lock lock(mutex_);
    if (has_ended_) return jobs_.num_running() == 0;
    is_leaving_ = true;
    is_changed_ = true;
    to_tell_.notify_all();
    is_drained = changed_.wait_for(lock, limit, [this] { return jobs_.num_running() == 0; });
    for (const auto& job : jobs_.all_running()) job->stop.request_stop();
    has_ended_ = true;
  }
  changed_.notify_all();
  workers_.clear();  // the last answers are sent
  teller_ = {};
  {
    const std::lock_guard lock(mutex_);
    has_sent_all_ = true;
  }
  publish_status();
  subscription_.reset();
  return is_drained;
}

int PlannerServer::running() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(jobs_.num_running());
}

std::int64_t PlannerServer::answered() const {
  const std::lock_guard lock(mutex_);
  return answered_;
}

// Exceptions, which only a lack of memory causes, must not reach the bus.
void PlannerServer::on_job(std::span<const std::uint8_t> bytes) try {
  base::Result<fleet_job_t> job = read_job(bytes);
  if (!job) {
    warn("a message of a front cannot be read", {{"reason", job.error}});
  } else if (job->kind == fleet_job_t::CANCEL) {
    cancel(*job);
  } else {
    plan(*std::move(job));
  }
} catch (const std::exception& exception) {
  warn("a message of a front was not taken", {{"reason", exception.what()}});
}

void PlannerServer::plan(fleet_job_t message) {
  const JobTable::Key key{message.front_id, message.job};
  bool is_known = false;
  bool is_busy = false;
  {
    const std::lock_guard lock(mutex_);
    is_known = jobs_.knows(key);
    if (!is_known) {
      std::optional<Bytes> payload =
          joiner_.add(key, message.part, message.num_parts, std::move(message.payload));
      if (!payload) return;
      is_busy = is_leaving_ || jobs_.num_running() >= static_cast<std::size_t>(options_.workers);
      if (!is_busy) {
        auto job = std::make_shared<RunningJob>();
        job->front = message.front_id;
        job->number = message.job;
        job->deadline_s = message.deadline_s;
        job->least_revision = message.least_revision;
        job->received = job->told = Clock::now();
        jobs_.begin(job);
        tasks_.push_back({std::move(job), *std::move(payload)});
        is_changed_ = true;
      }
    }
  }
  if (is_known) {
    repeat(key, message.part == 0);
  } else if (is_busy) {
    send(key, fleet_answer_t::BUSY, {});
  } else {
    changed_.notify_all();
    to_tell_.notify_all();
  }
}

// The front asks again since it heard nothing: it is answered once for all parts of its question.
void PlannerServer::repeat(const JobTable::Key& key, bool is_first_part) {
  if (!is_first_part) return;
  std::shared_ptr<RunningJob> job;
  JobTable::Answer answer;
  {
    const std::lock_guard lock(mutex_);
    job = jobs_.running(key);
    answer = jobs_.answer(key);
  }
  if (job) publish_progress(*job);
  if (answer) send(key, fleet_answer_t::ANSWER, *answer);
}

void PlannerServer::cancel(const fleet_job_t& message) {
  const std::lock_guard lock(mutex_);
  const JobTable::Key key{message.front_id, message.job};
  joiner_.forget(key);
  if (const std::shared_ptr<RunningJob> job = jobs_.running(key)) job->stop.request_stop();
}

void PlannerServer::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return has_ended_ || !tasks_.empty(); });
    if (tasks_.empty()) return;
    const Task task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    try {
      run(task);
    } catch (const std::exception& exception) {
      warn("a job was not answered", {{"front", task.job->front}, {"reason", exception.what()}});
      refuse(*task.job, fleet_answer_t::BUSY, 0);
    }
    lock.lock();
  }
}

void PlannerServer::run(const Task& task) {
  const RunningJob& job = *task.job;
  const base::Result<plan_request_t> request = read_request(task.payload);
  if (!request) {
    warn("a request of a front cannot be read", {{"front", job.front}, {"reason", request.error}});
    refuse(job, fleet_answer_t::UNREADABLE, 0);
    return;
  }
  const double waited_s = std::chrono::duration<double>(Clock::now() - job.received).count();
  const base::Deadline deadline = base::Deadline::after_s(std::max(0.0, job.deadline_s - waited_s))
                                      .watched(job.stop.get_token(), job.progress);
  const auto snapshot = snapshot_for(request->scene, job);
  const std::int64_t revision = snapshot ? static_cast<std::int64_t>(snapshot->revision) : 0;
  if (revision < job.least_revision) {
    refuse(job, fleet_answer_t::BEHIND, revision);
    return;
  }
  finish(job, answer_to(*request, snapshot, deadline));
}

std::shared_ptr<const scene::Snapshot> PlannerServer::snapshot_for(const std::string& scene,
                                                                   const RunningJob& job) const {
  const Clock::time_point until = Clock::now() + options_.patience_behind;
  while (true) {
    std::shared_ptr<const scene::Snapshot> snapshot = parts_.scenes.find(scene);
    const std::int64_t revision = snapshot ? static_cast<std::int64_t>(snapshot->revision) : 0;
    const bool is_there = revision >= job.least_revision;
    if (is_there || Clock::now() >= until || job.stop.stop_requested()) return snapshot;
    std::this_thread::sleep_for(kSceneLook);
  }
}

Bytes PlannerServer::answer_to(const plan_request_t& request,
                               const std::shared_ptr<const scene::Snapshot>& snapshot,
                               const base::Deadline& deadline) {
  if (!snapshot) {
    return wire::encode(messages::plain_answer(
        plan_response_t::STATUS_UNKNOWN_SCENE,
        fmt::format("scene: '{}' is unknown; {}", request.scene, parts_.scenes.summary()),
        service::header_of(request, nullptr)));
  }
  // The front makes the paths for watching, from the answer.
  plan_request_t unwatched = request;
  unwatched.watch_lease_s = 0.0;
  const service::Answered answered = parts_.answerer.answer(snapshot, unwatched, deadline);
  Bytes bytes = wire::encode(answered.wire);
  if (bytes.size() <= kMaxPayloadBytes) return bytes;
  return wire::encode(messages::plain_answer(
      plan_response_t::STATUS_LIMIT,
      fmt::format("the answer takes {} bytes, more than {}; ask for parts of the path",
                  bytes.size(), kMaxPayloadBytes),
      service::header_of(request, snapshot.get())));
}

void PlannerServer::refuse(const RunningJob& job, std::int8_t why, std::int64_t revision) {
  {
    const std::lock_guard lock(mutex_);
    jobs_.forget(key_of(job));
    is_changed_ = true;
  }
  changed_.notify_all();
  to_tell_.notify_all();
  send(key_of(job), why, {}, revision);
}

// The slot is free before the front has the answer: the front may send the next job at once.
void PlannerServer::finish(const RunningJob& job, Bytes bytes) {
  const bool is_wanted = !job.stop.stop_requested();
  const auto answer = is_wanted ? std::make_shared<const Bytes>(std::move(bytes)) : nullptr;
  {
    const std::lock_guard lock(mutex_);
    jobs_.end(key_of(job), answer, Clock::now());
    if (is_wanted) ++answered_;
    is_changed_ = true;
  }
  changed_.notify_all();
  to_tell_.notify_all();
  if (answer) send(key_of(job), fleet_answer_t::ANSWER, *answer);
}

void PlannerServer::send(const JobTable::Key& key, std::int8_t kind,
                         std::span<const std::uint8_t> payload, std::int64_t revision) {
  fleet_answer_t head{};
  head.planner_id = options_.planner_id;
  head.job = key.second;
  head.kind = kind;
  head.scene_revision = revision;
  if (!publish_parts(parts_.bus, subjects_.answer(key.first), std::move(head), payload)) {
    warn("NATS did not take a message to a front", {{"front", key.first}});
  }
}

// The position is read in each round, since it may change before `position_changed` is called.
void PlannerServer::tell_fronts(const std::stop_token& stop) {
  Clock::time_point status_at = Clock::now();
  std::int64_t told_position = -1;
  while (!stop.stop_requested()) {
    const Clock::time_point now = Clock::now();
    const bool has_moved = position_() != told_position;
    bool is_due = now >= status_at || has_moved;
    {
      const std::lock_guard lock(mutex_);
      is_due = is_due || is_changed_;
      if (is_due) is_changed_ = false;
    }
    if (is_due) {
      told_position = position_();
      publish_status();
      status_at = now + options_.status_period;
    }
    for (const auto& job : due_progress(now)) publish_progress(*job);
    std::unique_lock lock(mutex_);
    // At first not even a change ends the wait, so that statuses keep their distance.
    to_tell_.wait_for(lock, stop, kLeastPause, [] { return false; });
    to_tell_.wait_until(lock, stop, std::min(status_at, next_progress()),
                        [this] { return is_changed_; });
  }
}

PlannerServer::Clock::time_point PlannerServer::next_progress() const {
  Clock::time_point next = Clock::time_point::max();
  for (const auto& job : jobs_.all_running()) {
    next = std::min(next, job->told + options_.progress_period);
  }
  return next;
}

void PlannerServer::publish_status() {
  const std::lock_guard status_lock(status_mutex_);
  planner_status_t status{};
  status.planner_id = options_.planner_id;
  status.start_id = start_id_;
  status.utime = wire::utime_now();
  status.serial = ++serial_;
  status.host = host_;
  status.pid = static_cast<std::int32_t>(getpid());
  status.version = messages::clipped(options_.version, wire::kMaxVersionBytes);
  status.log_position = position_();
  {
    const std::lock_guard lock(mutex_);
    status.workers = has_sent_all_ ? 0 : options_.workers;
    status.running = static_cast<std::int32_t>(jobs_.num_running());
    status.is_leaving = is_leaving_ ? 1 : 0;
    status.answered = answered_;
  }
  parts_.bus.publish(subjects_.planner(), wire::encode(status));
}

std::vector<std::shared_ptr<RunningJob>> PlannerServer::due_progress(Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  std::vector<std::shared_ptr<RunningJob>> due = jobs_.all_running();
  std::erase_if(due, [&](const auto& job) { return now - job->told < options_.progress_period; });
  for (const auto& job : due) job->told = now;
  return due;
}

void PlannerServer::publish_progress(const RunningJob& job) {
  plan_progress_t progress{};
  progress.utime = wire::utime_now();
  progress.stage = messages::wire_stage(job.progress->stage);
  progress.num_collisions = job.progress->collisions;
  progress.num_corrected = job.progress->corrected;
  progress.since_receipt_s = std::chrono::duration<double>(Clock::now() - job.received).count();
  progress.deadline_s = job.deadline_s;
  send(key_of(job), fleet_answer_t::PROGRESS, wire::encode(progress));
}

void PlannerServer::warn(std::string_view event, service::LogFields fields) {
  const std::lock_guard lock(log_mutex_);
  trouble_.write(event, fields);
}

}  // namespace camway::fleet
