// SPDX-License-Identifier: MIT
#include "daemon/fleet/front_link.h"

#include <array>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <mutex>
#include <random>
#include <utility>

namespace camway::fleet {
namespace {

/// Numbers of two starts of a front must not meet: an answer to the earlier start is none to the
/// later one. 31 random bits above 32 bits that count do that but for one in two thousand million.
std::int64_t first_job_number() {
  constexpr std::uint32_t kPositive = 0x7fffffff;
  std::random_device random;
  return static_cast<std::int64_t>(random() & kPositive) << 32;
}

/// Planners say something four times a second. If all of them became silent at once, none was heard
/// for longer when the first one counts as lost.
constexpr std::chrono::milliseconds kLatelyHeard{500};

/// More than two words of a front that is alive, which come every tenth of a second.
constexpr std::chrono::milliseconds kFrontWait{350};

/// The message by which a front says that it is alive: its start number, little-endian, and whether
/// its claim of the id is settled.
struct LifeSign {
  std::uint64_t start = 0;
  bool is_settled = true;
};
constexpr std::size_t kStartBytes = 8;

std::array<std::uint8_t, kStartBytes + 1> bytes_of(const LifeSign& sign) {
  std::array<std::uint8_t, kStartBytes + 1> bytes{};
  for (std::size_t i = 0; i < kStartBytes; ++i) {
    bytes[i] = static_cast<std::uint8_t>(sign.start >> (8 * i));
  }
  bytes[kStartBytes] = sign.is_settled ? 1 : 0;
  return bytes;
}

/// Whatever cannot be read is from a front that is settled.
LifeSign life_sign_from(std::span<const std::uint8_t> bytes) {
  LifeSign sign;
  if (bytes.size() != kStartBytes + 1) return sign;
  for (std::size_t i = 0; i < kStartBytes; ++i) sign.start |= std::uint64_t{bytes[i]} << (8 * i);
  sign.is_settled = bytes[kStartBytes] != 0;
  return sign;
}

std::uint64_t random_number() {
  std::random_device device;
  return (std::uint64_t{device()} << 32U) | device();
}

}  // namespace

void JobInbox::put(JobEvent event) {
  {
    const std::lock_guard lock(mutex_);
    // Only the newest progress counts.
    if (event.kind == fleet_answer_t::PROGRESS) {
      std::erase_if(events_, [&](const JobEvent& other) {
        return other.kind == event.kind && other.planner == event.planner;
      });
    }
    if (events_.size() >= kMostEvents) return;
    events_.push_back(std::move(event));
  }
  changed_.notify_all();
}

std::optional<JobEvent> JobInbox::take() {
  const std::lock_guard lock(mutex_);
  if (events_.empty()) return std::nullopt;
  JobEvent event = std::move(events_.front());
  events_.pop_front();
  return event;
}

void JobInbox::wait(std::chrono::milliseconds longest) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, longest, [this] { return !events_.empty(); });
}

FrontLink::FrontLink(nats::Bus& bus, PlannerBoard& board, Subjects subjects, std::string front_id,
                     const std::shared_ptr<service::Log>& log)
    : bus_(bus),
      board_(board),
      subjects_(std::move(subjects)),
      front_id_(std::move(front_id)),
      start_number_(random_number()),
      next_job_(first_job_number()),
      trouble_(log, service::LogLevel::kWarn, "planners", {}),
      alarms_(log, service::LogLevel::kError, "differing answers", {}),
      news_(log) {}

bool FrontLink::open() {
  answers_ = bus_.subscribe(
      subjects_.answer(front_id_),
      [this](const std::string&, std::span<const std::uint8_t> bytes) { on_answer(bytes); });
  statuses_ = bus_.subscribe(
      subjects_.planner(),
      [this](const std::string&, std::span<const std::uint8_t> bytes) { on_status(bytes); });
  return answers_ && statuses_;
}

FrontLink::Job FrontLink::begin() {
  const std::lock_guard lock(mutex_);
  Job job{++next_job_, std::make_shared<JobInbox>()};
  inboxes_.emplace(job.number, job.inbox);
  return job;
}

void FrontLink::end(const Job& job, std::optional<AnswerMark> mark) {
  {
    const std::lock_guard lock(mutex_);
    inboxes_.erase(job.number);
    if (mark) memory_.keep(job.number, *mark, AnswerMemory::Clock::now());
  }
  if (!mark) return;
  // An answer may have come in just before.
  while (const std::optional<JobEvent> event = job.inbox->take()) {
    if (event->kind == fleet_answer_t::ANSWER)
      take_late(job.number, event->planner, event->payload);
  }
}

bool FrontLink::send(const std::string& planner, const fleet_job_t& head,
                     std::span<const std::uint8_t> payload) {
  fleet_job_t message = head;
  message.front_id = front_id_;
  return publish_parts(bus_, subjects_.plan(planner), std::move(message), payload);
}

bool FrontLink::is_id_taken() {
  std::mutex mutex;  // guards is_taken
  std::condition_variable heard;
  bool is_taken = false;
  const auto subscription = bus_.subscribe(
      subjects_.front(front_id_), [&](const std::string&, std::span<const std::uint8_t> bytes) {
        const LifeSign sign = life_sign_from(bytes);
        if (sign.start == start_number_) return;
        if (!sign.is_settled && sign.start < start_number_) return;
        const std::lock_guard lock(mutex);
        is_taken = true;
        heard.notify_all();
      });
  if (subscription == nullptr) return false;
  std::unique_lock lock(mutex);
  return heard.wait_for(lock, kFrontWait, [&] { return is_taken; });
}

bool FrontLink::claim_id() {
  if (is_id_taken()) return false;
  claim_.store(Claim::kTrying);
  const bool is_own = !is_id_taken();
  claim_.store(is_own ? Claim::kSettled : Claim::kNone);
  return is_own;
}

void FrontLink::say_alive() {
  const Claim claim = claim_.load();
  if (claim == Claim::kNone) return;
  bus_.publish(subjects_.front(front_id_), bytes_of({start_number_, claim == Claim::kSettled}));
}

// Exceptions, which only a lack of memory causes, must not reach the bus.
void FrontLink::on_answer(std::span<const std::uint8_t> bytes) try {
  base::Result<fleet_answer_t> read = read_answer(bytes);
  if (!read) {
    warn("a message of a planner cannot be read", {{"reason", read.error}});
    return;
  }
  std::shared_ptr<JobInbox> inbox;
  std::optional<Bytes> payload;
  {
    const std::lock_guard lock(mutex_);
    const auto found = inboxes_.find(read->job);
    if (found != inboxes_.end()) inbox = found->second;
    const bool is_wanted = inbox || memory_.find(read->job, AnswerMemory::Clock::now()) != nullptr;
    if (!is_wanted) return;
    if (read->kind == fleet_answer_t::ANSWER) {
      payload = joiner_.add({read->planner_id, read->job}, read->part, read->num_parts,
                            std::move(read->payload));
    } else if (read->num_parts == 1) {
      payload = std::move(read->payload);
    }
  }
  if (!payload) return;
  if (inbox) {
    inbox->put({read->planner_id, read->kind, *std::move(payload)});
  } else if (read->kind == fleet_answer_t::ANSWER) {
    take_late(read->job, read->planner_id, *payload);
  }
} catch (const std::exception& exception) {
  warn("a message of a planner was not taken", {{"reason", exception.what()}});
}

void FrontLink::on_status(std::span<const std::uint8_t> bytes) try {
  const base::Result<planner_status_t> status = read_status(bytes);
  if (status) {
    board_.note(*status);
    if (status->is_leaving == 0 || status->workers > 0) {
      const std::lock_guard lock(log_mutex_);
      news_.planner_heard(status->planner_id);
    }
    if (!board_.takes_version(status->version)) warn_of_version(*status);
  } else {
    warn("a status of a planner cannot be read", {{"reason", status.error}});
  }
} catch (const std::exception& exception) {
  warn("a status of a planner was not taken", {{"reason", exception.what()}});
}

void FrontLink::warn_of_version(const planner_status_t& status) {
  {
    const std::lock_guard lock(mutex_);
    if (warned_of_version_.size() >= PlannerBoard::kMostPlanners) warned_of_version_.clear();
    if (!warned_of_version_.insert({status.planner_id, status.start_id}).second) return;
  }
  warn("a planner of another version gets no jobs",
       {{"planner", status.planner_id}, {"host", status.host}, {"version", status.version}});
}

void FrontLink::take_late(std::int64_t job, const std::string& planner,
                          std::span<const std::uint8_t> payload) {
  std::optional<AnswerMark> given;
  {
    const std::lock_guard lock(mutex_);
    const AnswerMark* const kept = memory_.find(job, AnswerMemory::Clock::now());
    if (kept != nullptr) given = *kept;
  }
  // A planner that was asked twice sends its own answer twice.
  if (!given || given->planner == planner) return;
  const base::Result<plan_response_t> answer = read_response(payload);
  if (!answer) {
    warn("an answer of a planner cannot be read", {{"planner", planner}, {"reason", answer.error}});
    return;
  }
  const AnswerMark other = mark_of(*answer, planner);
  if (!differ(*given, other)) return;
  {
    // One alarm for a request, though an answer may come twice.
    const std::lock_guard lock(mutex_);
    if (!memory_.forget(job)) return;
  }
  raise_alarm(*given, other);
}

void FrontLink::raise_alarm(const AnswerMark& given, const AnswerMark& other) {
  const std::lock_guard lock(log_mutex_);
  ++counts_.differing_answers;
  alarms_.write("two planners answered a request differently",
                {{"client", given.client_id},
                 {"request", given.request_id},
                 {"planner", given.planner},
                 {"other_planner", other.planner},
                 {"scene_revision", given.scene_revision},
                 {"scene_digest", given.scene_digest}});
}

void FrontLink::count_sent_again() {
  const std::lock_guard lock(log_mutex_);
  ++counts_.jobs_sent_again;
}

void FrontLink::count_planned_here() {
  const std::lock_guard lock(log_mutex_);
  ++counts_.planned_here;
}

FrontCounts FrontLink::counts() const {
  const std::lock_guard lock(log_mutex_);
  return counts_;
}

void FrontLink::warn(std::string_view event, service::LogFields fields) {
  const std::lock_guard lock(log_mutex_);
  trouble_.write(event, fields);
}

void FrontLink::planner_lost(PlannerLoss::Reason reason, const std::string& planner,
                             const plan_request_t& request) {
  if (!bus_.is_connected()) return;
  const bool is_bus_heard = board_.is_any_heard_within(kLatelyHeard);
  const std::lock_guard lock(log_mutex_);
  news_.planner_lost({reason, planner, request.client_id, request.request_id, is_bus_heard},
                     FleetNews::Clock::now());
}

void FrontLink::connection_changed(bool is_connected) {
  const auto now = FleetNews::Clock::now();
  const std::lock_guard lock(log_mutex_);
  if (is_connected) {
    news_.connection_made(now);
  } else {
    news_.connection_lost(now);
  }
}

void FrontLink::tick() {
  const int planners = board_.alive();
  const std::lock_guard lock(log_mutex_);
  news_.tick(planners, FleetNews::Clock::now());
  trouble_.report_suppressed();
  alarms_.report_suppressed();
}

}  // namespace camway::fleet
