// SPDX-License-Identifier: MIT
#include "daemon/record/recorder.h"

#include <fmt/format.h>

#include <csignal>
#include <random>
#include <utility>

#include "daemon/record/record_writer.h"
#include "lcmtypes/wire/utime.h"

namespace camway::record {
namespace {

/// Memory that a waiting change of a scene counts as, without meshes, which the store holds too.
/// [Units: bytes]
constexpr std::uint64_t kBytesOfAChange = 1024;

/// Returns the snapshot without mesh and trees, which are made of its objects for planning.
std::shared_ptr<const scene::Snapshot> light(const scene::Snapshot& snapshot) {
  auto copy = std::make_shared<scene::Snapshot>();
  copy->name = snapshot.name;
  copy->revision = snapshot.revision;
  copy->digest = snapshot.digest;
  copy->objects = snapshot.objects;
  copy->options = snapshot.options;
  return copy;
}

std::string new_recording_id() { return fmt::format("{:08x}", std::random_device()()); }

std::uint64_t bytes_of_item(const RecordedMessage& message) {
  return sizeof message + message.channel.size() + message.bytes.size();
}
std::uint64_t bytes_of_item(const ChangedScene& change) {
  return kBytesOfAChange + change.after->objects.size() * sizeof change.after->objects[0];
}

}  // namespace

void take(const ChangedScene& change, SceneMap& newest) {
  const auto known = newest.find(change.after->name);
  if (known != newest.end() && known->second->revision > change.after->revision) return;
  if (change.kind != ChangedScene::Kind::kRemove) {
    newest[change.after->name] = change.after;
  } else if (known != newest.end()) {
    newest.erase(known);
  }
}

base::Result<std::unique_ptr<Recorder>> Recorder::open(const RecordOptions& options,
                                                       RecordFacts facts,
                                                       std::shared_ptr<service::Log> log) {
  const std::string recording = new_recording_id();
  base::Result<LogFiles> files = LogFiles::open(options.folder, recording, options.limits);
  if (!files) return base::Failure{std::move(files.error)};
  auto writer = std::make_unique<RecordWriter>(options.prefix, std::move(facts), recording,
                                               *std::move(files), std::move(log), options.trouble);
  return std::unique_ptr<Recorder>(new Recorder(options, std::move(writer)));
}

Recorder::Recorder(const RecordOptions& options, std::unique_ptr<RecordWriter> writer)
    : options_(options), writer_(std::move(writer)) {
  // Signals are for the threads of the process.
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([this] { run(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

Recorder::~Recorder() { finish(); }

void Recorder::finish() {
  {
    const std::lock_guard lock(mutex_);
    is_finishing_ = true;
  }
  arrived_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void Recorder::message(std::string_view channel, std::span<const std::uint8_t> bytes) {
  const std::int64_t now = wire::utime_now();
  RecordedMessage message{now, std::string(channel), {bytes.begin(), bytes.end()}};
  bool wakes = false;
  {
    const std::lock_guard lock(mutex_);
    if (is_finishing_) return;
    const std::uint64_t size = bytes_of_item(message);
    if (waiting_bytes_ + size > options_.waiting_bytes) return drop(1, 0);
    const bool was_crowded = is_crowded();
    wakes = waiting_.empty();
    waiting_bytes_ += size;
    waiting_.emplace_back(std::move(message));
    wakes = wakes || (!was_crowded && is_crowded());
  }
  if (wakes) arrived_.notify_one();
}

void Recorder::scene_put(const scene::Snapshot& scene, const scene::ChangeNote& note) {
  add({ChangedScene::Kind::kPut, light(scene), 0, {}, note});
}

void Recorder::scene_changed(std::uint64_t before, const scene::Snapshot& next,
                             const scene::SceneChanges& changes, const scene::ChangeNote& note) {
  add({ChangedScene::Kind::kChange, light(next), before, changes, note});
}

void Recorder::scene_removed(const scene::Snapshot& last) {
  add({ChangedScene::Kind::kRemove, light(last), 0, {}, {}});
}

void Recorder::add(ChangedScene change) {
  {
    const std::lock_guard lock(mutex_);
    if (is_finishing_) return;
    take(change, scenes_);
    if (waiting_changes_ >= options_.waiting_changes) return drop(0, 1);
    ++waiting_changes_;
    waiting_bytes_ += bytes_of_item(change);
    waiting_.emplace_back(std::move(change));
  }
  arrived_.notify_one();
}

void Recorder::drop(std::uint64_t messages, std::uint64_t changes) {
  const std::int64_t now = wire::utime_now();
  if (dropped_.messages + dropped_.changes == 0) dropped_.from_utime = now;
  dropped_.to_utime = now;
  dropped_.messages += messages;
  dropped_.changes += changes;
  all_dropped_ += messages + changes;
}

bool Recorder::is_crowded() const {
  return waiting_bytes_ >= options_.waiting_bytes / 2 ||
         waiting_changes_ >= options_.waiting_changes / 2;
}

void Recorder::run() {
  std::deque<Item> batch;
  bool is_last = false;
  while (!is_last) {
    Omission dropped;
    SceneMap scenes;
    batch.clear();
    {
      std::unique_lock lock(mutex_);
      arrived_.wait(lock, [this] { return !waiting_.empty() || is_finishing_; });
      arrived_.wait_for(lock, options_.pause, [this] { return is_crowded() || is_finishing_; });
      batch.swap(waiting_);
      waiting_bytes_ = 0;
      waiting_changes_ = 0;
      dropped = std::exchange(dropped_, {});
      if (dropped.changes > 0) scenes = scenes_;
      is_last = is_finishing_;
    }
    for (const Item& item : batch) {
      std::visit([this](const auto& each) { writer_->write(each); }, item);
    }
    if (dropped.messages + dropped.changes > 0) {
      dropped.reason = "the disk is too slow";
      writer_->skip(dropped, scenes);
    }
    writer_->flush();
  }
  writer_->finish();
}

RecordCounts Recorder::counts() const {
  RecordCounts counts = writer_->counts();
  const std::lock_guard lock(mutex_);
  counts.dropped += all_dropped_;
  return counts;
}

}  // namespace camway::record
