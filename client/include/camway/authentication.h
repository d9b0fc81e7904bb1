// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace camway {

/// How a client and its daemon know each other's messages: each is signed with a key that both
/// have, and what is not is dropped. See `authentication_from` for the usual one. It keeps nothing
/// secret.
class Authentication {
 public:
  using Bytes = std::vector<std::uint8_t>;

  /// What one client needs of it. For one thread at a time.
  class Session {
   public:
    virtual ~Session() = default;
    /// The message to send in the place of `message`.
    virtual Bytes seal(const std::string& channel, const Bytes& message) = 0;
    /// The message in one that came in, or nothing if that is not to be trusted.
    virtual std::optional<Bytes> open(const std::string& channel, const std::uint8_t* message,
                                      std::size_t size) = 0;
  };

  virtual ~Authentication() = default;
  /// From any thread.
  virtual std::unique_ptr<Session> begin() const = 0;
};

/// An authentication, or why there is none.
struct LoadedAuthentication {
  std::shared_ptr<const Authentication> authentication;
  std::string error;  ///< empty exactly when `authentication` is set
};

/// By the keys of a file, as those of the daemon's `auth.key_file`: a line for each, with its id
/// and 64 hexadecimal digits; the first signs, all are accepted. The file must belong to who runs
/// this program, and nobody else may read it. Messages may be `window_s` old, or from as far in the
/// future. [Limit: 0 < window_s <= 86400]
///
/// In a library of its own, which needs libsodium: `find_package(camway COMPONENTS authentication)`
/// and link `camway::authentication`.
LoadedAuthentication authentication_from(const std::string& key_file, double window_s = 30.0);

}  // namespace camway
