// SPDX-License-Identifier: MIT
#include "tests/service/fake_transport.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace camway::testing {
namespace {

/// Longest wait; only a failing test waits this long.
constexpr std::chrono::seconds kPatience{30};

}  // namespace

bool FakeTransport::subscribe(const std::string& channel, int /*queue_capacity*/, Handler handler) {
  const std::lock_guard lock(mutex_);
  if (subscribe_fails_) return false;
  handlers_[channel] = std::move(handler);
  return true;
}

bool FakeTransport::publish(const std::string& channel, std::span<const std::uint8_t> message) {
  {
    const std::lock_guard lock(mutex_);
    if (publish_fails_) return false;
    published_.push_back({channel, wire::Bytes(message.begin(), message.end())});
  }
  changed_.notify_all();
  return true;
}

bool FakeTransport::poll(std::chrono::milliseconds timeout) {
  std::deque<Message> messages;
  {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, timeout, [this] { return woken_ || broken_ || !incoming_.empty(); });
    woken_ = false;
    if (broken_) return false;
    messages.swap(incoming_);
  }
  for (const Message& message : messages) {
    const auto handler = handlers_.find(message.channel);
    if (handler != handlers_.end()) handler->second(message.bytes);
  }
  return true;
}

void FakeTransport::wake() noexcept {
  {
    const std::lock_guard lock(mutex_);
    woken_ = true;
  }
  changed_.notify_all();
}

void FakeTransport::deliver(std::string channel, wire::Bytes bytes) {
  {
    const std::lock_guard lock(mutex_);
    incoming_.push_back({std::move(channel), std::move(bytes)});
  }
  changed_.notify_all();
}

void FakeTransport::fail_subscribe() {
  const std::lock_guard lock(mutex_);
  subscribe_fails_ = true;
}

void FakeTransport::fail_publish() {
  const std::lock_guard lock(mutex_);
  publish_fails_ = true;
}

void FakeTransport::break_down() {
  {
    const std::lock_guard lock(mutex_);
    broken_ = true;
  }
  changed_.notify_all();
}

std::vector<FakeTransport::Message> FakeTransport::published() const {
  const std::lock_guard lock(mutex_);
  return published_;
}

std::vector<wire::Bytes> FakeTransport::published_on(const std::string& channel) const {
  std::vector<wire::Bytes> found;
  for (Message& message : published()) {
    if (message.channel == channel) found.push_back(std::move(message.bytes));
  }
  return found;
}

std::optional<wire::Bytes> FakeTransport::message_on(const std::string& channel,
                                                     std::size_t index) const {
  if (!wait_for_messages_on(channel, index + 1)) return std::nullopt;
  const std::lock_guard lock(mutex_);
  for (const Message& message : published_) {
    if (message.channel == channel && index-- == 0) return message.bytes;
  }
  return std::nullopt;
}

bool FakeTransport::wait_until(
    const std::function<bool(const std::vector<Message>&)>& enough) const {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, kPatience, [&] { return enough(published_); });
}

bool FakeTransport::wait_for_messages_on(const std::string& channel, std::size_t count) const {
  return wait_until([&](const std::vector<Message>& messages) {
    return std::count_if(messages.begin(), messages.end(), [&](const Message& message) {
             return message.channel == channel;
           }) >= static_cast<std::ptrdiff_t>(count);
  });
}

}  // namespace camway::testing
