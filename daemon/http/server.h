// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/http/address.h"

/// A small server of HTTP/1.1 and WebSocket, for the metrics page and `camway view`. The only room
/// that sees Boost.Beast.
namespace camway::http {

struct Request {
  std::string method;                                        ///< "GET"
  std::string target;                                        ///< "/metrics?a=b", as sent
  std::vector<std::pair<std::string, std::string>> headers;  ///< names in lower case
  std::string body;

  /// Returns the value of the first header of that name in lower case; empty if there is none.
  [[nodiscard]] std::string_view header(std::string_view name) const;
};

struct Response {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers = {};  ///< beside type and length
};

/// Sends the response to one request: at most once, from any thread. If nobody calls it and the
/// last copy is gone, the connection is closed. Calls after the end of the connection or of the
/// server do nothing.
using Reply = std::function<void(Response)>;

/// The server's end of a WebSocket connection. Thread-safe.
class Socket {
 public:
  virtual ~Socket() = default;
  /// Queues a text message. Returns false if the connection has ended, or if more than
  /// `Limits::queued_bytes` wait for a slow receiver; then the message is not sent.
  virtual bool send(std::string text) = 0;
  /// Closes the connection once what is queued was sent.
  virtual void close() = 0;
};

/// Receives what happens to a WebSocket connection, on the server's thread. Destroyed when the
/// connection has ended.
class SocketEvents {
 public:
  virtual ~SocketEvents() = default;
  virtual void received(std::string text) = 0;
};

/// The functions are called on the server's thread, one at a time, and must neither throw nor wait.
struct Handlers {
  std::function<void(const Request&, Reply)> on_request;
  /// Takes a WebSocket connection whose upgrade was asked for; null: refuses it with what
  /// `on_request` would be told, so that one place decides who may connect.
  std::function<std::unique_ptr<SocketEvents>(const Request&, std::shared_ptr<Socket>)> on_socket =
      nullptr;
  /// Looks at a request before its body is read: a response refuses it, and the connection is
  /// closed after it. So nobody who may not ask can make the server keep large bodies. May be null.
  std::function<std::optional<Response>(const Request&)> on_head = nullptr;
  /// Headers of every response, of those to requests that cannot be read and to upgrades, too.
  std::vector<std::pair<std::string, std::string>> headers = {};
  /// A connection took the last place; further ones wait until another one ends. May be null.
  std::function<void()> on_full = nullptr;
};

struct Limits {
  int connections = 16;  ///< at a time [Limit: 1 <= value <= 1000]
  /// Time to send a request, or to take a response; also the time that a connection may be silent
  /// between requests.
  std::chrono::milliseconds patience{5000};
  /// Silence after which a WebSocket connection is closed. After half of it the other side is sent
  /// a ping, and anything that it sends, a pong among it, is a sign of life. A browser whose page
  /// is busy may read nothing, pings neither, once a message waits for the page; and programs of
  /// the same machine that end are noticed without it. So it is long.
  std::chrono::milliseconds silence{120'000};
  std::size_t header_bytes = 16'384;
  std::size_t body_bytes = 0;     ///< of a request
  std::size_t message_bytes = 0;  ///< of a WebSocket message
  std::size_t queued_bytes = 0;   ///< of messages for one WebSocket connection
};

/// Serves on a thread of its own. The destructor closes all connections and joins the thread.
class Server {
 public:
  /// Returns the server, not null, or an error, e.g. "cannot listen on 127.0.0.1 port 9464: Address
  /// already in use". `before_start`, which may be null, is told the port before the first
  /// connection is accepted.
  static base::Result<std::unique_ptr<Server>> open(
      const Address& address, Handlers handlers, const Limits& limits,
      const std::function<void(int)>& before_start = nullptr);
  virtual ~Server() = default;
  /// Returns the port on which it listens.
  [[nodiscard]] virtual int port() const = 0;
};

}  // namespace camway::http
