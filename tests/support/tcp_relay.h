// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <list>
#include <mutex>
#include <thread>

namespace camway::testing {

/// A port of the loopback that leads to another one, and that a test may cut: then nothing passes
/// in either direction, and nobody is told. Thread-safe.
class TcpRelay {
 public:
  /// Throws if the port cannot be opened.
  explicit TcpRelay(int to_port);
  ~TcpRelay();
  TcpRelay(const TcpRelay&) = delete;
  TcpRelay& operator=(const TcpRelay&) = delete;

  [[nodiscard]] int port() const { return port_; }
  void cut() { is_cut_.store(true); }
  void mend() { is_cut_.store(false); }

 private:
  void accept_all();
  void pass(int from, int to);

  const int to_port_;
  int port_ = 0;
  int listener_ = -1;
  std::atomic<bool> is_cut_ = false;
  std::atomic<bool> ends_ = false;
  std::mutex mutex_;  ///< guards the next two
  std::list<int> sockets_;
  std::list<std::jthread> passers_;
  std::jthread acceptor_;
};

}  // namespace camway::testing
