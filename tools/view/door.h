// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "daemon/base/result.h"
#include "tools/view/backend.h"
#include "tools/view/page_files.h"

namespace camway::view {

/// Limits of the door, which keep a client from using up memory or the time of others.
struct DoorLimits {
  int connections = 64;                              ///< at a time, sockets included
  std::size_t body_bytes = std::size_t{16} << 20;    ///< of a POST or PATCH
  std::size_t message_bytes = std::size_t{4} << 20;  ///< of a message of a socket
  /// Messages that wait for a slow receiver. Beyond that its connection is closed.
  std::size_t queued_bytes = std::size_t{32} << 20;
  int plans = 8;                ///< under way for one socket, checks included
  int all_plans = 64;           ///< under way for all sockets together
  int requests = 32;            ///< under way over HTTP, all connections together
  int open = 64;                ///< messages of one socket without an answer, watches included
  double changes_per_s = 50.0;  ///< changes of scenes, of all clients together
  double change_burst = 100.0;  ///< changes that may come at once
};

struct DoorOptions {
  int port = 0;  ///< 0: any free port
  std::string token = {};
  bool is_read_only = false;  ///< whether changes of scenes are refused
  /// The request that is planned at first, as JSON, until there is a last plan; empty: none.
  std::string first_request = {};
  DoorLimits limits = {};
  PageFiles page = {};  ///< what `/` shows
};

/// The door: HTTP and WebSocket on 127.0.0.1, in JSON (docs/http.md). Requests are answered by a
/// backend, whose threads plan; the door's own threads read and write only. The destructor closes
/// all connections and cancels what is under way.
class Door {
 public:
  /// Opens the door. Keeps a reference to `backend`. Returns why that is not possible.
  static base::Result<std::unique_ptr<Door>> open(const DoorOptions& options, Backend& backend);
  virtual ~Door() = default;
  [[nodiscard]] virtual int port() const = 0;
  /// Returns the address for a browser, the token included.
  [[nodiscard]] virtual std::string url() const = 0;
};

}  // namespace camway::view
