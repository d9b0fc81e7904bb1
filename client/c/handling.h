// SPDX-License-Identifier: MIT
#pragma once

#include <camway/client.h>

#include "client/c/refusal.h"

namespace camway::c {

/// Marks that this thread runs a handler of a client, in which it must not wait for that client.
class Handling {
 public:
  explicit Handling(const void* client) : before_(current()) { current() = client; }
  ~Handling() { current() = before_; }
  Handling(const Handling&) = delete;
  Handling& operator=(const Handling&) = delete;

  /// Throws in a handler of `client`.
  static void refuse_to_wait(const void* client) {
    if (client == nullptr || client != current()) return;
    throw Refusal{CAMWAY_BUSY, "a handler of this client must not wait for it"};
  }
  /// Throws in a handler of any client.
  static void refuse_to_wait_at_all() { refuse_to_wait(current()); }

 private:
  static const void*& current() {
    thread_local const void* client = nullptr;
    return client;
  }

  const void* before_;
};

}  // namespace camway::c
