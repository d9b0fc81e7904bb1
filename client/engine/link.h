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

#include "client/messages/bytes.h"

namespace lcm {
class LCM;
struct ReceiveBuffer;
}  // namespace lcm

namespace camway {

using Clock = std::chrono::steady_clock;

/// A connection to an LCM network: raw bytes in and out. The only place of the client that sees
/// LCM. For one thread, `wake` apart.
class Link {
 public:
  using Handler = std::function<void(std::span<const std::uint8_t>)>;

  Link();
  ~Link();
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  /// Connects; returns what is wrong and what mends it, nothing if all is well. With ttl 0 only
  /// this host is heard. An empty url means LCM_DEFAULT_URL, or multicast with ttl 0 where that is
  /// not set.
  std::string open(const std::string& url);

  /// The network in use.
  const std::string& url() const { return url_; }

  /// Why other hosts can be heard though they should not; empty if all is well.
  const std::string& warning() const { return warning_; }

  /// Whether messages are signed and checked.
  bool signs() const { return authentication_ != nullptr; }
  /// From now on they are. Before `listen`.
  void authenticate(std::unique_ptr<Authentication::Session> session);

  /// Calls `handler` in `wait` for every message on `channel`, of which up to `capacity` wait for
  /// their turn: with what stands in it, where it is signed; those that are not to be trusted are
  /// dropped. What `handler` throws is swallowed. Precondition: open.
  void listen(const std::string& channel, int capacity, Handler handler);

  /// Whether the network took the bytes. Precondition: open.
  bool publish(const std::string& channel, const Bytes& bytes);

  enum class Wait { kSomething, kTimeUp, kBroken };
  /// Waits until a message comes, `wake` is called or `until` passes; handles the messages that are
  /// here, a bounded number of them. A network that broke stays broken.
  Wait wait(Clock::time_point until);

  /// Ends a wait, or the next one. From any thread.
  void wake() const;

 private:
  /// Two ends of a pipe.
  struct Pipe {
    int read_end = -1;
    int write_end = -1;
  };

  /// A channel that is listened to.
  struct Listener {
    Link* link;
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
  std::unique_ptr<Authentication::Session> authentication_;  ///< null: nothing is signed
  std::list<Listener> listeners_;                            ///< LCM keeps their addresses
};

}  // namespace camway
