// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "daemon/nats/bus.h"
#include "tests/support/random.h"

namespace camway::testing {

class MemoryBus;

/// What joins several `MemoryBus`, each the connection of one process. Loses, doubles and delays
/// messages as it is told, but keeps the order between one sender and one receiver. Must outlive
/// its connections. Thread-safe.
class MemoryNetwork {
 public:
  struct Faults {
    double lost = 0.0;     ///< share of the messages
    double doubled = 0.0;  ///< share of the messages that arrive twice
    std::chrono::microseconds longest_delay{0};
  };

  explicit MemoryNetwork(std::uint64_t seed = 1, std::size_t most_bytes = std::size_t{1} << 20)
      : most_bytes_(most_bytes), random_(seed) {}

  void set_faults(const Faults& faults);
  [[nodiscard]] std::size_t most_bytes() const { return most_bytes_; }
  /// Returns the number of messages that were sent on a subject, lost ones included.
  [[nodiscard]] int sent_on(const std::string& subject) const;

 private:
  friend class MemoryBus;
  class Inbox;

  void add(const std::shared_ptr<Inbox>& inbox);
  void remove(const Inbox* inbox);
  void send(const MemoryBus* sender, const std::string& subject, std::vector<std::uint8_t> bytes);

  const std::size_t most_bytes_;
  mutable std::mutex mutex_;  ///< guards all below
  Faults faults_;
  Random random_;
  std::vector<std::shared_ptr<Inbox>> inboxes_;
  std::vector<std::string> sent_;
};

/// A connection to a `MemoryNetwork`. Thread-safe.
class MemoryBus final : public nats::Bus {
 public:
  using Bytes = std::vector<std::uint8_t>;

  /// `network` must outlive it.
  explicit MemoryBus(MemoryNetwork& network) : network_(network) {}

  bool publish(const std::string& subject, std::span<const std::uint8_t> payload) override;
  std::unique_ptr<nats::Subscription> subscribe(const std::string& subject,
                                                Handler handler) override;
  [[nodiscard]] bool is_connected() const override { return !is_cut_; }
  [[nodiscard]] std::size_t most_bytes() const override { return network_.most_bytes(); }

  /// Loses all that this process sends and receives, as when it dies.
  void cut() { is_cut_ = true; }
  void mend() { is_cut_ = false; }
  /// Holds all that this process sends and receives, as when it is stopped, until `go_on`.
  void stall();
  void go_on();
  /// Calls `change` with each message before it is sent.
  void falsify(std::function<void(const std::string& subject, Bytes& bytes)> change);

 private:
  friend class MemoryNetwork;
  class Ticket;

  MemoryNetwork& network_;
  std::atomic<bool> is_cut_ = false;
  std::atomic<bool> is_stalled_ = false;
  std::mutex mutex_;  ///< guards all below
  std::function<void(const std::string&, Bytes&)> change_;
  std::vector<std::pair<std::string, Bytes>> held_;
};

}  // namespace camway::testing
