// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

namespace camway::process {

/// Reports the state of the daemon to the service manager, by the protocol of sd_notify(3): one
/// datagram to a Unix socket for each state, which needs no library; systemd is one manager that
/// listens. Without a socket does nothing. If the manager does not read, drops `alive` at once and
/// the other states after a second.
/// Thread-safe.
class ServiceManager {
 public:
  /// Reads the environment: NOTIFY_SOCKET, WATCHDOG_USEC, WATCHDOG_PID.
  static ServiceManager from_environment();

  /// `socket`: a path, or "@name" for an abstract socket; empty for none.
  ServiceManager(std::string socket, std::optional<std::chrono::microseconds> watchdog)
      : socket_(std::move(socket)), watchdog_(watchdog) {}

  [[nodiscard]] bool present() const { return !socket_.empty(); }

  /// Reports that the daemon serves. `status` is one line for people.
  void ready(std::string_view status) const;
  /// Reports that the configuration is being read again. Requires a call of `ready` at the end.
  void reloading() const;
  void stopping() const;
  /// Reports that the daemon is alive. Sends nothing if the manager has no watchdog.
  void alive() const;
  /// Returns how often `alive` has to be called: a third of the watchdog's time, at most 1 s.
  [[nodiscard]] std::chrono::milliseconds alive_period() const;

 private:
  void send(const std::string& state, std::chrono::milliseconds patience) const;

  std::string socket_;
  std::optional<std::chrono::microseconds> watchdog_;
};

}  // namespace camway::process
