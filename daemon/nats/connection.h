// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/nats/bus.h"

namespace camway::nats {

/// How to reach the servers of NATS, as its own clients name it.
struct ConnectOptions {
  std::vector<std::string> servers;  ///< "nats://host:4222", "tls://host:4222" [Limit: not empty]
  std::string name;                  ///< of this client, for the server's own lists
  std::string credentials_file;      ///< of a user (`.creds`); empty: none
  std::string ca_file;               ///< PEM of who signs the servers; empty: those of the system
  std::string certificate_file;      ///< PEM of this client, for servers that verify; empty: none
  std::string key_file;              ///< PEM of its key; empty exactly if `certificate_file` is
  std::chrono::milliseconds patience{5'000};  ///< for the first connection, over all servers
};

/// A connection to NATS, which is made again whenever it is lost, for ever.
/// Thread-safe.
class Connection final : public Bus {
 public:
  /// Fails if no server can be reached within the patience, or refuses, with server and reason.
  static base::Result<std::unique_ptr<Connection>> open(const ConnectOptions& options);
  /// Ends all that is under way. Requires that no subscription and no stream of it is left.
  ~Connection() override;

  bool publish(const std::string& subject, std::span<const std::uint8_t> payload) override;
  std::unique_ptr<Subscription> subscribe(const std::string& subject, Handler handler) override;
  [[nodiscard]] bool is_connected() const override;
  [[nodiscard]] std::size_t most_bytes() const override;

  /// Calls `changed(true)` when the connection was made again and `changed(false)` when it was
  /// lost, on a thread of the connection. At most one listener; an empty one ends it.
  void on_change(std::function<void(bool is_connected)> changed);

  /// The server that it is connected to, without user or password; empty if none.
  [[nodiscard]] std::string server() const;
  /// Why no stream of JetStream can be asked although the server answers, for the user; empty if
  /// they can, or if it is not known yet. Requests to streams then fail at once.
  [[nodiscard]] std::string stall() const;
  /// Differs from an earlier value if the connection was made again since then. A message that is
  /// sent after the call may still go over a later connection.
  [[nodiscard]] std::uint64_t generation() const;

  /// The parts that the other files of this room share.
  struct Parts;
  [[nodiscard]] Parts& parts() { return *parts_; }

 private:
  explicit Connection(std::unique_ptr<Parts> parts);

  const std::unique_ptr<Parts> parts_;
};

}  // namespace camway::nats
