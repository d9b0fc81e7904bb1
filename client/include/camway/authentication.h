// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace camway {

/// Signs the messages of a client and checks those of its daemon. Client and daemon share a key;
/// messages that are not signed with it are dropped. Messages are signed, not encrypted.
/// `authentication_from` makes the usual implementation.
class Authentication {
 public:
  using Bytes = std::vector<std::uint8_t>;

  /// The signing state of one client. Not thread-safe.
  class Session {
   public:
    virtual ~Session() = default;
    /// Returns the signed message to send on `channel` in place of `message`.
    virtual Bytes seal(const std::string& channel, const Bytes& message) = 0;
    /// Returns the content of a signed message that came on `channel`, or nothing if the message is
    /// not to be trusted.
    virtual std::optional<Bytes> open(const std::string& channel, const std::uint8_t* message,
                                      std::size_t size) = 0;
  };

  virtual ~Authentication() = default;
  /// Returns a new session. Thread-safe.
  virtual std::unique_ptr<Session> begin() const = 0;
};

/// An authentication, or the reason why it could not be loaded.
struct LoadedAuthentication {
  std::shared_ptr<const Authentication> authentication;
  std::string error;  ///< empty exactly when `authentication` is set
};

/// Loads the keys of a file in the format of the daemon's `auth.key_file`: each line holds a key id
/// and 64 hexadecimal digits. The first key signs; every key is accepted.
///
/// Requires a file that belongs to the user of this process and that nobody else can read, or one
/// of root's that at most its group can read. Messages are accepted if their time is at most
/// `window_s` from the local clock, past or future. [Limit: 0 < window_s <= 86400]
///
/// This function is in a library of its own, which needs libsodium: `find_package(camway COMPONENTS
/// authentication)`, then link `camway::authentication`.
LoadedAuthentication authentication_from(const std::string& key_file, double window_s = 30.0);

}  // namespace camway
