// SPDX-License-Identifier: MIT
#include "daemon/nats/stall_watch.h"

#include <array>
#include <chrono>
#include <memory>
#include <utility>

#include "daemon/nats/connection_parts.h"

namespace camway::nats {
namespace {

using std::chrono::milliseconds;

/// A stream that does not answer within this time is stalled, if its server answers after it.
constexpr milliseconds kProbeWait{2000};
/// How long the end of a probe may be waited for.
constexpr milliseconds kProbeStep{50};
/// A restart of the server is noticed by the loss of the connection. Each probe costs the server a
/// connection that it cannot close, so probes, which only find out that the stream was slow, are
/// rare.
constexpr std::chrono::seconds kProbeAgain{30};

/// A server that was asked over a connection of its own.
struct Probed {
  NatsHandle handle;
  std::string id;
};

Probed connect_to_probe(const ConnectOptions& options) {
  Probed probed{connect_once(options, std::make_shared<ConnectionEvents>()).handle, ""};
  if (probed.handle != nullptr) probed.id = server_id_of(probed.handle.get());
  return probed;
}

}  // namespace

StallWatch::StallWatch(ConnectOptions options)
    : options_(std::move(options)), thread_([this] { run(); }) {}

StallWatch::~StallWatch() {
  {
    const std::lock_guard lock(mutex_);
    is_stopped_ = true;
    changed_.notify_all();
  }
  thread_.join();
}

void StallWatch::watch(const std::string& stream) {
  const std::lock_guard lock(mutex_);
  watched_.insert(stream);
}

void StallWatch::suspect(const std::string& stream) {
  const std::lock_guard lock(mutex_);
  if (!suspect_.empty() || !watched_.contains(stream)) return;
  suspect_ = stream;
  changed_.notify_all();
}

std::string StallWatch::stall(const std::string& server_id) {
  const std::lock_guard lock(mutex_);
  if (!stall_.empty() && !server_id.empty() && server_id != server_id_) {
    stall_.clear();
    suspect_.clear();
    changed_.notify_all();
  }
  return stall_;
}

bool StallWatch::is_stopped() {
  const std::lock_guard lock(mutex_);
  return is_stopped_;
}

void StallWatch::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    if (stall_.empty()) {
      changed_.wait(lock, [this] { return is_stopped_ || !suspect_.empty(); });
    } else {
      changed_.wait_for(lock, kProbeAgain, [this] { return is_stopped_ || stall_.empty(); });
    }
    if (is_stopped_) return;
    const std::string stream = suspect_;
    if (stream.empty()) continue;
    lock.unlock();
    const Finding found = probe(stream);
    lock.lock();
    stall_.clear();
    if (found.is_stalled) {
      server_id_ = found.server_id;
      stall_ = found.server + " answers, but stream " + stream +
               " of its JetStream does not: it could not write to its disk, which is or was full. "
               "Make room there, then restart that server of NATS (SIGKILL if it does not end)";
    } else {
      suspect_.clear();
    }
  }
}

StallWatch::Finding StallWatch::probe(const std::string& stream) {
  const Probed asked = connect_to_probe(options_);
  if (asked.handle == nullptr) return {};
  natsInbox* made = nullptr;
  if (natsInbox_Create(&made) != NATS_OK) return {};
  const NatsOwned<char> inbox(made);
  natsSubscription* subscribed = nullptr;
  natsStatus status = natsConnection_SubscribeSync(&subscribed, asked.handle.get(), inbox.get());
  const NatsOwned<natsSubscription> subscription(subscribed);
  if (status == NATS_OK) {
    status = natsConnection_PublishRequestString(
        asked.handle.get(), ("$JS.API.STREAM.INFO." + stream).c_str(), inbox.get(), "");
  }
  const auto end = std::chrono::steady_clock::now() + kProbeWait;
  natsMsg* answer = nullptr;
  while (status == NATS_OK && answer == nullptr) {
    const bool is_over = std::chrono::steady_clock::now() >= end;
    status = natsSubscription_NextMsg(&answer, subscription.get(), kProbeStep.count());
    if (status == NATS_TIMEOUT && !is_over && !is_stopped()) status = NATS_OK;
  }
  const NatsOwned<natsMsg> owned(answer);
  if (status != NATS_TIMEOUT || is_stopped()) return {};
  // A server that hangs as a whole, or was started anew, does not have the stream stalled.
  const Probed again = connect_to_probe(options_);
  if (again.handle == nullptr || again.id.empty() || again.id != asked.id) return {};
  return {true, server_of(again.handle.get()), again.id};
}

}  // namespace camway::nats
