// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <mutex>
#include <set>
#include <string>
#include <thread>

#include "daemon/nats/connection.h"

namespace camway::nats {

/// Finds out whether a server answers, but one of its streams does not.
///
/// The server 2.9 locks a stream for ever if its disk has room for a part of a message only: the
/// stream does not answer any more until the server is restarted, and a connection that asks it
/// gets no other answer either. So no stream is asked while one of them is stalled; whether it
/// still is, is asked over connections of their own. Thread-safe.
class StallWatch {
 public:
  explicit StallWatch(ConnectOptions options);
  ~StallWatch();
  StallWatch(const StallWatch&) = delete;
  StallWatch& operator=(const StallWatch&) = delete;

  /// Lets a stream be watched that one server keeps alone. One with replicas does not answer
  /// either while its servers choose a leader.
  void watch(const std::string& stream);
  /// Tells that a stream did not answer in time. Returns at once.
  void suspect(const std::string& stream);
  /// Why no stream can be asked now, for the user; empty if they can, or if it is not known yet.
  /// `server_id`: of the server that is connected now, empty if none is. Another one than the
  /// stalled one is not stalled.
  [[nodiscard]] std::string stall(const std::string& server_id);

 private:
  struct Finding {
    bool is_stalled = false;
    std::string server;
    std::string server_id;
  };
  void run();
  /// Asks a stream over a connection of its own; takes some seconds if there is no answer.
  Finding probe(const std::string& stream);
  bool is_stopped();

  const ConnectOptions options_;
  std::mutex mutex_;  ///< guards what follows
  std::condition_variable changed_;
  std::set<std::string> watched_;
  std::string suspect_;    ///< stream that is to be asked; empty: none
  std::string stall_;      ///< words of the stall; empty: none
  std::string server_id_;  ///< of the stalled server
  bool is_stopped_ = false;
  std::thread thread_;
};

}  // namespace camway::nats
