// SPDX-License-Identifier: MIT
#pragma once

#include <camway/authentication.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lcmtypes/wire/pages.h"

namespace lcm {
class LCM;
struct ReceiveBuffer;
}  // namespace lcm

namespace camway {

using wire::Bytes;

using Clock = std::chrono::steady_clock;

/// A connection to an LCM network that sends and receives raw bytes. The rest of the client does
/// not use LCM. Not thread-safe, except for `wake`.
class LcmConnection {
 public:
  using Handler = std::function<void(std::span<const std::uint8_t>)>;

  LcmConnection();
  ~LcmConnection();
  LcmConnection(const LcmConnection&) = delete;
  LcmConnection& operator=(const LcmConnection&) = delete;

  /// Connects. Returns the fault and its remedy, or an empty text on success. With ttl 0 only this
  /// host is heard. An empty URL stands for LCM_DEFAULT_URL or, if that is not set, for multicast
  /// with ttl 0.
  std::string open(const std::string& url);

  /// Returns the URL of the network in use.
  const std::string& url() const { return url_; }

  /// Returns why other hosts can be heard although the ttl is 0; empty otherwise.
  const std::string& warning() const { return warning_; }

  /// Returns whether messages are signed and checked.
  bool signs() const { return authentication_ != nullptr; }
  /// Makes the connection sign and check messages. Call it before `listen`; null changes nothing.
  void authenticate(std::unique_ptr<Authentication::Session> session);

  /// Makes `wait` call `handler` with the content of every message on `channel`. Drops messages
  /// that are not to be trusted, and messages that exceed a queue of `capacity`. Exceptions of
  /// `handler` are ignored. Requires an open connection.
  void listen(const std::string& channel, int capacity, Handler handler);

  /// Sends a message. Returns whether LCM accepted it. Requires an open connection.
  bool publish(const std::string& channel, const Bytes& bytes);

  enum class Wait { kSomething, kTimeUp, kBroken };
  /// Waits until a message comes, `wake` is called or `until` passes, at most 1 s. Handles received
  /// messages, a bounded number in a call. Once it has returned kBroken, it always does.
  Wait wait(Clock::time_point until);

  /// Ends the present wait, or the next one. Thread-safe.
  void wake() const;

 private:
  /// The file descriptors of a pipe.
  struct Pipe {
    int read_end = -1;
    int write_end = -1;
  };

  /// A subscription to a channel.
  struct Listener {
    LcmConnection* connection;
    Handler handler;
  };

  static void on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel,
                         Listener* listener);
  void clear_wake() const;

  std::string url_;
  std::string warning_;
  Pipe wake_;
  bool broken_ = false;
  std::unique_ptr<lcm::LCM> lcm_;
  std::unique_ptr<Authentication::Session> authentication_;  ///< null: messages are not signed
  std::list<Listener> listeners_;  ///< a list, because LCM holds pointers to its elements
};

}  // namespace camway
