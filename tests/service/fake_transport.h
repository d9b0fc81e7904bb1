// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "daemon/service/transport/transport.h"
#include "lcmtypes/wire/pages.h"

namespace camway::testing {

/// A transport in memory. A test delivers messages and reads the published ones. Thread-safe.
class FakeTransport final : public service::Transport {
 public:
  struct Message {
    std::string channel;
    wire::Bytes bytes;
  };

  bool subscribe(const std::string& channel, int queue_capacity, Handler handler) override;
  bool publish(const std::string& channel, std::span<const std::uint8_t> message) override;
  bool poll(std::chrono::milliseconds timeout) override;
  void wake() noexcept override;

  /// Queues a message for the subscriber of `channel`.
  void deliver(std::string channel, wire::Bytes bytes);

  /// Make all later calls of subscribe, publish or poll fail.
  void fail_subscribe();
  void fail_publish();
  void break_down();

  [[nodiscard]] std::vector<Message> published() const;
  [[nodiscard]] std::vector<wire::Bytes> published_on(const std::string& channel) const;
  /// Waits for published message `index` on `channel` and returns it; nothing if it does not come.
  [[nodiscard]] std::optional<wire::Bytes> message_on(const std::string& channel,
                                                      std::size_t index) const;

  /// Waits until `enough` returns true for the messages published so far. Returns false if that
  /// takes longer than a test should.
  [[nodiscard]] bool wait_until(
      const std::function<bool(const std::vector<Message>&)>& enough) const;
  [[nodiscard]] bool wait_for_messages_on(const std::string& channel, std::size_t count) const;

 private:
  mutable std::mutex mutex_;  ///< guards all members below except handlers_, which the poller owns
  mutable std::condition_variable changed_;
  std::deque<Message> incoming_;
  std::vector<Message> published_;
  bool woken_ = false;
  bool subscribe_fails_ = false;
  bool publish_fails_ = false;
  bool broken_ = false;
  std::map<std::string, Handler> handlers_;
};

}  // namespace camway::testing
