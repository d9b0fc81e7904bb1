// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>

#include "daemon/http/server.h"

/// Parts of the server, for its own files. All of it runs on the server's thread.
namespace camway::http {

namespace asio = boost::asio;
namespace beast = boost::beast;
using tcp = asio::ip::tcp;
using BeastRequest = beast::http::request<beast::http::string_body>;
using BeastResponse = beast::http::response<beast::http::string_body>;

/// A connection that takes one of the places.
class Place {
 public:
  virtual ~Place() = default;
  /// Ends the connection at once.
  virtual void abort() = 0;
};

/// The part that connections share. It outlives the server as long as somebody keeps a `Reply` or a
/// `Socket`; what these post then is never run.
struct Core {
  Core(Handlers given_handlers, const Limits& given_limits)
      : handlers(std::move(given_handlers)), limits(given_limits) {}

  void take_place(Place* place) { places.insert(place); }
  void leave_place(Place* place) {
    places.erase(place);
    if (left) left();
  }

  const Handlers handlers;
  const Limits limits;
  std::set<Place*> places;
  std::function<void()> left;   ///< called when a place is free again; null once the server stops
  asio::io_context context{1};  ///< destroyed first, with the connections that are kept in it
};

/// A connection that speaks HTTP. Kept by what waits for it.
class Connection final : public Place, public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, const std::shared_ptr<Core>& core);
  ~Connection() override;
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Reads the next request.
  void read();
  /// Sends a response to the request that was read last; closes the connection without one.
  void answer(std::optional<Response> response);
  void abort() override;

 private:
  void on_head(beast::error_code error);
  void on_read(beast::error_code error);
  void refuse(beast::error_code error);
  /// Closes the connection once the other side has, or the time for that is over: unread bytes
  /// would make the kernel reset it, and the response would be lost.
  void end();
  /// Reads and drops bytes until the other side closes.
  void drain();
  /// Turns the connection into a WebSocket, if the handlers take it. Returns whether they do.
  bool upgrade(const BeastRequest& parsed, const Request& request);

  beast::tcp_stream stream_;
  const std::weak_ptr<Core> core_;  ///< weak, since the core keeps connections
  Core& shared_;                    ///< `*core_`; connections end before it
  beast::flat_buffer buffer_;
  std::optional<beast::http::request_parser<beast::http::string_body>> parser_;
  unsigned version_ = 11;
  bool keeps_alive_ = false;
  bool is_head_ = false;
  bool has_unread_ = false;  ///< whether the request was refused before all of it was read
};

/// Serves the connection as a WebSocket, if the handlers take it; else leaves `stream` alone.
/// Returns whether they do.
bool serve_socket(beast::tcp_stream& stream, const BeastRequest& upgrade, const Request& request,
                  const std::shared_ptr<Core>& core);

}  // namespace camway::http
