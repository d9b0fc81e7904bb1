// SPDX-License-Identifier: MIT
#include <limits>
#include <string_view>
#include <utility>

#include "daemon/scene/log/nats/nats_log_parts.h"

namespace camway::scene {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

/// The server says when there is something new. Its message may be lost.
constexpr milliseconds kPollPause{250};
constexpr milliseconds kFaultPause{50};
/// How often the log is asked whether it has lost its end without a loss of the connection, as a
/// cluster may.
constexpr milliseconds kLookPause{1000};
/// How often it is tried to put back what is missing.
constexpr milliseconds kCarePause{2000};
/// For one request: a follower that waits does not know what is new.
constexpr milliseconds kFollowWait{1000};
constexpr std::uint64_t kEndOfNews = std::numeric_limits<std::uint64_t>::max();

LogUpdate::Kind kind_of(LogMessage::Kind kind) {
  switch (kind) {
    case LogMessage::Kind::kSummary:
      return LogUpdate::Kind::kSummary;
    case LogMessage::Kind::kRemoval:
      return LogUpdate::Kind::kRemoval;
    case LogMessage::Kind::kEntry:
      break;
  }
  return LogUpdate::Kind::kEntry;
}

}  // namespace

void NatsLog::Parts::follow(SharedLog::Take take) {
  take_ = std::move(take);
  {
    const std::lock_guard lock(news_mutex_);
    is_following_ = true;
  }
  next_sequence_ = followed_ + 1;
  // The tail may have been checked between `scenes` and now; then what is known is right, and the
  // position is that of `scenes` on the same connection.
  subscription_ = connection_.subscribe(
      options_.fleet + ".news.scene.>",
      [this](const std::string&, std::span<const std::uint8_t>) { wake_follower(); });
  follower_ = std::thread([this] { run_follower(); });
}

void NatsLog::Parts::stop_following() {
  subscription_.reset();
  {
    const std::lock_guard lock(news_mutex_);
    is_stopped_ = true;
    news_.notify_all();
  }
  if (follower_.joinable()) follower_.join();
}

bool NatsLog::Parts::is_in_touch() const {
  const std::lock_guard lock(mutex_);
  return has_read_all_ && is_tail_checked() && connection_.is_connected() && lost_.empty();
}

// A pass that begins now sees all that is in the log now.
bool NatsLog::Parts::catch_up(milliseconds patience) {
  std::unique_lock lock(news_mutex_);
  const auto is_hopeless = [this] {
    return !is_following_ || is_stopped_ || !connection_.is_connected();
  };
  if (is_hopeless()) return false;
  const std::uint64_t wanted = passes_begun_ + 1;
  has_news_ = true;
  news_.notify_all();
  const auto is_done = [&] { return last_whole_pass_ >= wanted; };
  news_.wait_for(lock, patience, [&] { return is_done() || is_hopeless(); });
  return is_done();
}

std::uint64_t NatsLog::Parts::begin_pass() {
  const std::lock_guard lock(news_mutex_);
  return ++passes_begun_;
}

void NatsLog::Parts::end_pass(std::uint64_t pass, bool has_read_all) {
  const std::lock_guard lock(news_mutex_);
  if (has_read_all) last_whole_pass_ = pass;
  news_.notify_all();
}

void NatsLog::Parts::wake_follower() {
  const std::lock_guard lock(news_mutex_);
  has_news_ = true;
  news_.notify_all();
}

bool NatsLog::Parts::is_stopped() {
  const std::lock_guard lock(news_mutex_);
  return is_stopped_;
}

bool NatsLog::Parts::wait_for_news(milliseconds most) {
  std::unique_lock lock(news_mutex_);
  news_.wait_for(lock, most, [this] { return has_news_ || is_stopped_; });
  has_news_ = false;
  return !is_stopped_;
}

void NatsLog::Parts::run_follower() {
  bool is_up_to_date = false;
  do {
    is_up_to_date = false;
    const std::uint64_t pass = begin_pass();
    if (is_not_stalled() && connection_.is_connected() &&
        check_tail(Clock::now() + kFollowWait).empty()) {
      is_up_to_date = follow_once();
    }
    has_read_all_ = is_up_to_date;
    end_pass(pass, is_up_to_date);
    if (is_up_to_date) {
      {
        const std::lock_guard lock(mutex_);
        read_all_at_ = Clock::now();
      }
      look_for_losses();
      keep_house();
    }
  } while (wait_for_news(is_up_to_date ? kPollPause : kFaultPause));
}

bool NatsLog::Parts::is_not_stalled() {
  const std::string stall = connection_.stall();
  if (stall.empty() == was_stalled_) {
    was_stalled_ = !stall.empty();
    warn(was_stalled_ ? "changes of scenes are refused: " + stall
                      : "JetStream of the server answers again");
  }
  return stall.empty();
}

bool NatsLog::Parts::follow_once() {
  if (must_read_again_.exchange(false)) {
    has_read_all_ = false;
    next_sequence_ = 1;
    followed_ = 0;
    gaps_.clear();
  }
  is_interrupted_ = false;
  const auto read = stream_->read(
      next_sequence_, kEndOfNews, scene_filter(),
      [this](nats::StoredMessage message) {
        if (!is_interrupted_) take_message(message);
      },
      kFollowWait);
  return read && !is_interrupted_ && !must_read_again_;
}

void NatsLog::Parts::take_message(const nats::StoredMessage& stored) {
  if (is_stopped()) {
    is_interrupted_ = true;
    return;
  }
  const std::size_t dot = stored.subject.rfind('.');
  const auto scene = text_from_token(std::string_view(stored.subject).substr(dot + 1));
  auto message = log_message_from(std::as_bytes(std::span(stored.payload)));
  if (!scene || !message) {
    warn_of_damage(stored.subject, "message " + std::to_string(stored.sequence) + ": " +
                                       (scene ? message.error : "it has no scene"));
  } else if (!pass_on(*scene, *std::move(message), stored.sequence)) {
    is_interrupted_ = true;
    return;
  }
  next_sequence_ = stored.sequence + 1;
  followed_ = stored.sequence;
}

bool NatsLog::Parts::pass_on(const std::string& scene, LogMessage message, std::uint64_t sequence) {
  {
    const std::lock_guard lock(mutex_);
    SceneChain& chain = chains_[scene];
    if (sequence > chain.last_sequence()) {
      if (chain.fit_of(message) == ChainFit::kGap) {
        // A summary or removal follows, which has replaced the change that is missing; else the
        // server has lost something, or the log is damaged.
        gaps_.insert(scene);
        return true;
      }
      chain.take(message, sequence);
    }
    // A message that does not count is not there; one that a summary or removal has replaced comes
    // with that.
    const ChainLink* const link = chain.find(message.id);
    if (link == nullptr || link->is_taken || !chain.is_whole()) return true;
    // A purge removes the oldest messages first, one by one. This process knows what it has
    // appended itself, so it may meet a message here whose predecessors are gone from the log
    // already. The summary or removal that purges follows.
    if (!chain.is_next(*link)) {
      gaps_.insert(scene);
      return true;
    }
    if (message.kind != LogMessage::Kind::kEntry) gaps_.erase(scene);
  }
  LogUpdate update{kind_of(message.kind), scene, {}, sequence};
  base::Result<Bytes> record = record_of(message, patience_end());
  if (!record) {
    warn_of_damage(scene, "message " + std::to_string(sequence) + ": " + record.error);
    return false;
  }
  update.entry.revision = message.revision;
  update.entry.record = *std::move(record);
  if (message.kind == LogMessage::Kind::kEntry) {
    update.entry.before = message.before;
    update.entry.needs = std::move(message.needs);
  }
  take_(update);
  const std::lock_guard lock(mutex_);
  if (ChainLink* const link = chains_[scene].find(message.id)) link->is_taken = true;
  return true;
}

void NatsLog::Parts::warn_of_damage(const std::string& scene, const std::string& what) {
  if (damaged_.insert(scene).second) warn(damaged("scene '" + scene + "', " + what).error);
}

void NatsLog::Parts::keep_house() {
  bool must_drop = false;
  bool has_lost = false;
  {
    const std::lock_guard lock(mutex_);
    must_drop = must_drop_;
    has_lost = !lost_.empty();
  }
  if (must_drop || blobs_.has_marks()) static_cast<void>(drop_unused_blobs(false));
  if (Clock::now() < last_care_ + kCarePause) return;
  last_care_ = Clock::now();
  if (reserve_.is_incomplete()) reserve_.fill(Clock::now() + kFollowWait);
  // The user may have put the object again, or unloaded the scene.
  if (has_lost) static_cast<void>(repair_contents(patience_end()));
}

void NatsLog::Parts::look_for_losses() {
  if (Clock::now() < last_look_ + kLookPause) return;
  last_look_ = Clock::now();
  const auto state = stream_->state(kFollowWait);
  if (state && state->last_sequence < followed_) must_check_ = true;
  if (!gaps_.empty()) must_check_ = true;
}

}  // namespace camway::scene
