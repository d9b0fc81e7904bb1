// SPDX-License-Identifier: MIT
#include "tools/view/daemon/heartbeats.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include "tools/view/daemon/daemon_scenes.h"
#include "tools/view/facts.h"

namespace camway::view {
namespace {

/// How long a daemon may be silent: three heartbeats, as it sends them unless told otherwise.
constexpr std::chrono::seconds kLongestSilence{3};
/// One wait for a heartbeat; the end of the thread waits no longer than that.
constexpr double kOneWait_s = 0.25;

constexpr char kHeard[] = R"({"kind": "daemon", "heard": true})";
constexpr char kSilent[] = R"({"kind": "daemon", "heard": false})";

bool are_same(const std::vector<SceneInfo>& a, const std::vector<SceneInfo>& b) {
  return std::ranges::equal(a, b, [](const SceneInfo& one, const SceneInfo& other) {
    return one.name == other.name && one.revision == other.revision && one.digest == other.digest;
  });
}

}  // namespace

class Heartbeats::Watcher final : public Watch {
 public:
  Watcher(Heartbeats& heartbeats, Key key) : heartbeats_(heartbeats), key_(key) {}
  ~Watcher() override {
    const std::lock_guard lock(heartbeats_.mutex_);
    heartbeats_.watchers_.erase(key_);
  }
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

 private:
  Heartbeats& heartbeats_;
  const Key key_;
};

Heartbeats::Heartbeats(Client& client) : client_(client), thread_([this] { listen(); }) {}

Heartbeats::~Heartbeats() { stop(); }

void Heartbeats::stop() {
  {
    const std::lock_guard lock(mutex_);
    has_stopped_ = true;
  }
  changed_.notify_all();
}

std::string Heartbeats::scenes_event(const std::vector<SceneInfo>& scenes) {
  return fmt::format("{{\"kind\": \"scenes\", \"state\": {}}}", scenes_json(facts_of(scenes)));
}

void Heartbeats::tell(const std::string& event) {
  for (const auto& [key, tell_one] : watchers_) tell_one(event);
}

void Heartbeats::listen() {
  for (;;) {
    DaemonStatus status = client_.status(kOneWait_s);
    const std::lock_guard lock(mutex_);
    if (has_stopped_) return;
    if (status.ok()) {
      heard(std::move(status));
    } else if (std::chrono::steady_clock::now() - heard_at_ > kLongestSilence) {
      silent();
    }
  }
}

void Heartbeats::heard(DaemonStatus status) {
  heard_at_ = std::chrono::steady_clock::now();
  const bool is_new = !last_;
  const bool differs = is_new || !are_same(last_->scenes, status.scenes);
  last_ = std::move(status);
  is_known_ = true;
  changed_.notify_all();
  if (is_new) tell(kHeard);
  if (differs) tell(scenes_event(last_->scenes));
}

void Heartbeats::silent() {
  const bool is_new = last_ || !is_known_;
  last_.reset();
  is_known_ = true;
  changed_.notify_all();
  if (is_new) tell(kSilent);
  if (on_silence_) on_silence_();
}

bool Heartbeats::is_silent() {
  const std::lock_guard lock(mutex_);
  return is_known_ && !last_;
}

void Heartbeats::on_silence(std::function<void()> told) {
  const std::lock_guard lock(mutex_);
  on_silence_ = std::move(told);
}

std::optional<DaemonStatus> Heartbeats::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return is_known_ || has_stopped_; });
  return last_;
}

std::unique_ptr<Watch> Heartbeats::watch(Tell event) {
  const std::lock_guard lock(mutex_);
  if (is_known_) event(last_ ? kHeard : kSilent);
  if (last_) event(scenes_event(last_->scenes));
  const Key key = ++last_key_;
  watchers_.emplace(key, std::move(event));
  return std::make_unique<Watcher>(*this, key);
}

void Heartbeats::scenes_changed(const std::vector<SceneInfo>& scenes) {
  const std::lock_guard lock(mutex_);
  if (!last_ || are_same(last_->scenes, scenes)) return;
  last_->scenes = scenes;
  tell(scenes_event(scenes));
}

}  // namespace camway::view
