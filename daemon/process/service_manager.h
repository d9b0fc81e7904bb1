// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

namespace camway::service {

/// Tells the service manager how the daemon is. The protocol is that of sd_notify(3): a datagram to
/// a Unix socket for each state, which needs no library; systemd is one that listens. Without a
/// socket nothing is said. Safe from any thread. Where the manager does not read, `alive` is left
/// out at once, and the others are after a second.
class ServiceManager {
 public:
  /// As the environment says: NOTIFY_SOCKET, WATCHDOG_USEC, WATCHDOG_PID.
  static ServiceManager from_environment();

  /// `socket`: a path, or "@name" for an abstract one; empty for none.
  ServiceManager(std::string socket, std::optional<std::chrono::microseconds> watchdog)
      : socket_(std::move(socket)), watchdog_(watchdog) {}

  [[nodiscard]] bool present() const { return !socket_.empty(); }

  /// The daemon serves. `status` is a line for people.
  void ready(std::string_view status) const;
  /// The configuration is being read again; `ready` ends it.
  void reloading() const;
  void stopping() const;
  /// The daemon is alive. Only where the manager watches for it.
  void alive() const;
  /// How often `alive` is to be called: a third of what the manager waits for, 1 s at most.
  [[nodiscard]] std::chrono::milliseconds alive_period() const;

 private:
  void send(const std::string& state, std::chrono::milliseconds patience) const;

  std::string socket_;
  std::optional<std::chrono::microseconds> watchdog_;
};

}  // namespace camway::service
