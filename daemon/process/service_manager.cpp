// SPDX-License-Identifier: MIT
#include "daemon/process/service_manager.h"

#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <ctime>

namespace camway::process {
namespace {

/// Timeout of states that the manager has to know.
constexpr std::chrono::milliseconds kPatience{1000};

std::string from_environment_or_empty(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? std::string() : std::string(value);
}

std::optional<std::int64_t> positive_number(const std::string& text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  return whole && value > 0 ? std::optional(value) : std::nullopt;
}

/// Returns the time of the clock that the manager uses, too.
std::int64_t monotonic_us() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000 + now.tv_nsec / 1'000;
}

}  // namespace

ServiceManager ServiceManager::from_environment() {
  std::optional<std::chrono::microseconds> watchdog;
  const std::optional<std::int64_t> period =
      positive_number(from_environment_or_empty("WATCHDOG_USEC"));
  const std::string pid = from_environment_or_empty("WATCHDOG_PID");
  // Inherited variables may be meant for the parent.
  if (period && (pid.empty() || pid == std::to_string(getpid()))) {
    watchdog = std::chrono::microseconds(*period);
  }
  return {from_environment_or_empty("NOTIFY_SOCKET"), watchdog};
}

void ServiceManager::ready(std::string_view status) const {
  send("READY=1\nSTATUS=" + std::string(status), kPatience);
}

void ServiceManager::reloading() const {
  send("RELOADING=1\nMONOTONIC_USEC=" + std::to_string(monotonic_us()), kPatience);
}

void ServiceManager::stopping() const { send("STOPPING=1", kPatience); }

void ServiceManager::alive() const {
  if (watchdog_) send("WATCHDOG=1", std::chrono::milliseconds::zero());
}

std::chrono::milliseconds ServiceManager::alive_period() const {
  constexpr std::chrono::milliseconds kLongest{1000};
  if (!watchdog_) return kLongest;
  const auto third = std::chrono::duration_cast<std::chrono::milliseconds>(*watchdog_ / 3);
  return std::clamp(third, std::chrono::milliseconds{1}, kLongest);
}

void ServiceManager::send(const std::string& state, std::chrono::milliseconds patience) const {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (socket_.empty() || socket_.size() >= sizeof address.sun_path) return;
  std::memcpy(address.sun_path, socket_.data(), socket_.size());
  if (socket_.front() == '@') address.sun_path[0] = '\0';  // an abstract name
  const int fd = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return;
  const timeval limit{patience.count() / 1000, patience.count() % 1000 * 1000};
  ::setsockopt(fd, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
  // A timeout of 0 would mean no timeout.
  const int flags = MSG_NOSIGNAL | (patience.count() == 0 ? MSG_DONTWAIT : 0);
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + socket_.size());
  ::sendto(fd, state.data(), state.size(), flags, reinterpret_cast<const sockaddr*>(&address),
           length);
  ::close(fd);
}

}  // namespace camway::process
