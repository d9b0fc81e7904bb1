// SPDX-License-Identifier: MIT
#include "daemon/record/record_writer.h"

#include <algorithm>
#include <utility>

#include "daemon/record/event_log.h"
#include "lcmtypes/wire/utime.h"

namespace camway::record {
namespace {

using scene::AppendFault;
using scene::AppendResult;
using scene::KeepFault;
using scene::Keeping;

/// Events that are written together.
constexpr std::size_t kBatchBytes = std::size_t{1} << 20;
/// Time from a failed write to the next attempt.
constexpr std::chrono::seconds kRetry{1};

}  // namespace

RecordWriter::RecordWriter(const std::string& prefix, RecordFacts facts, std::string recording,
                           LogFiles files, std::shared_ptr<service::Log> log,
                           const TroubleLog::Times& trouble)
    : prefix_(prefix),
      channel_(session_channel(prefix)),
      facts_(std::move(facts)),
      recording_(std::move(recording)),
      trouble_(std::move(log), trouble),
      files_(std::move(files)),
      updates_(files_,
               [this](scene::LogUpdate update) {
                 add(SceneUpdate{std::move(update), digest_});
               }),
      recorded_(updates_) {}

void RecordWriter::write(const RecordedMessage& message) {
  if (!is_ready()) return lose(1, 0, message.utime);
  if (messages_ + changes_ == 0) first_utime_ = message.utime;
  ++messages_;
  add(message.utime, message.channel, message.bytes);
  if (events_.size() >= kBatchBytes) flush();
}

void RecordWriter::write(const ChangedScene& change) {
  // The next file, or what follows an omission, begins with all scenes as they were before this
  // change.
  const bool ready = is_ready();
  if (ready) keep(change);
  take(change, scenes_);
  if (!ready) lose(0, 1, wire::utime_now());
}

void RecordWriter::keep(const ChangedScene& change) {
  const scene::Snapshot& after = *change.after;
  const auto before = scenes_.find(after.name);
  digest_ = after.digest;
  Keeping done;
  if (change.kind == ChangedScene::Kind::kRemove) {
    digest_.clear();
    done = recorded_.keep_removal(after, {});
  } else if (change.kind == ChangedScene::Kind::kChange && before != scenes_.end() &&
             before->second->revision == change.before) {
    done =
        recorded_.keep_changes(*before->second, after, change.changes, change.note, after.revision);
  } else {
    done = recorded_.keep_scene(after, after.revision, change.note);
  }
  const std::int64_t now = wire::utime_now();
  if (done.fault != KeepFault::kNone) {
    fail(updates_.fault());
    return lose(0, 1, now);
  }
  if (messages_ + changes_ == 0) first_utime_ = now;
  ++changes_;
}

void RecordWriter::skip(const Omission& omission, const SceneMap& scenes) {
  flush();
  trouble_.failed(omission.reason);
  trouble_.lost(omission.messages, omission.changes);
  note_omission(omission);
  // The changes that were left out are in the scenes only.
  if (omission.changes > 0) scenes_ = scenes;
}

void RecordWriter::flush() { write_events(); }

void RecordWriter::finish() {
  flush();
  retry_at_ = {};
  if (omission_) is_ready();
  trouble_.finish();
}

RecordCounts RecordWriter::counts() const {
  return {recorded_count_, recorded_bytes_, lost_, file_count_, trouble_.reason()};
}

bool RecordWriter::is_ready() {
  if (omission_ && Steady::now() < retry_at_) return false;
  if (!omission_ && has_begun_ && !files_.is_over(events_.size())) return true;
  if (!write_events()) return false;
  if (files_.is_over()) {
    if (const AppendResult done = files_.begin_next(); done.fault != AppendFault::kNone) {
      fail(done);
      return false;
    }
    ++file_count_;
    has_begun_ = false;
    number_ = 0;
  }
  if (!begin_events() || !write_events()) return false;
  has_begun_ = true;
  omission_.reset();
  return true;
}

bool RecordWriter::begin_events() {
  if (!has_begun_) add(FileBegin{recording_, files_.part(), facts_.version, facts_.settings});
  if (omission_) add(*omission_);
  if (has_begun_ && !(omission_ && omission_->changes > 0)) return true;
  if (!has_begun_) updates_.begin_file();
  for (const auto& [name, scene] : scenes_) {
    digest_ = scene->digest;
    const Keeping done = recorded_.keep_scene(*scene, scene->revision, {});
    if (done.fault == KeepFault::kNone) continue;
    events_.clear();
    fail(updates_.fault());
    return false;
  }
  if (!has_begun_) updates_.end_begin();
  return true;
}

void RecordWriter::add(const SessionEvent& event) {
  add(wire::utime_now(), channel_, bytes_of(event));
}

void RecordWriter::add(std::int64_t utime, std::string_view channel,
                       std::span<const std::uint8_t> bytes) {
  append_event(number_++, utime, channel, bytes, events_);
}

bool RecordWriter::write_events() {
  if (events_.empty()) return true;
  const AppendResult done = files_.append(events_);
  const std::uint64_t bytes = events_.size();
  const std::uint64_t messages = std::exchange(messages_, 0);
  const std::uint64_t changes = std::exchange(changes_, 0);
  events_.clear();
  if (done.fault == AppendFault::kNone) {
    recorded_count_ += messages + changes;
    recorded_bytes_ += bytes;
    trouble_.succeeded();
    return true;
  }
  fail(done);
  if (messages + changes > 0) lose(messages, changes, first_utime_);
  return false;
}

void RecordWriter::note_omission(const Omission& omission) {
  if (!omission_) {
    omission_ = omission;
    return;
  }
  omission_->from_utime = std::min(omission_->from_utime, omission.from_utime);
  omission_->to_utime = std::max(omission_->to_utime, omission.to_utime);
  omission_->messages += omission.messages;
  omission_->changes += omission.changes;
}

void RecordWriter::lose(std::uint64_t messages, std::uint64_t changes, std::int64_t utime) {
  lost_ += messages + changes;
  trouble_.lost(messages, changes);
  note_omission({utime, std::max(utime, wire::utime_now()), messages, changes, fault_});
}

void RecordWriter::fail(const AppendResult& why) {
  retry_at_ = Steady::now() + kRetry;
  fault_ = why.error;
  trouble_.failed(why.error);
  note_omission({wire::utime_now(), wire::utime_now(), 0, 0, why.error});
}

}  // namespace camway::record
