// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>

/// Clients of the door that wait for everything, so that tests wait for events and not for times.
namespace camway::view {

namespace beast = boost::beast;
using Tcp = boost::asio::ip::tcp;

/// A token for tests.
inline constexpr char kSecret[] = "secret";

struct Reached {
  int code = 0;
  std::string type;
  std::string body;
  beast::http::fields headers;

  [[nodiscard]] nlohmann::json json() const { return nlohmann::json::parse(body); }
  [[nodiscard]] std::string header(const char* name) const { return std::string(headers[name]); }
};

/// A connection over HTTP.
class HttpClient {
 public:
  HttpClient(int port, std::string token) : port_(port), token_(std::move(token)) {}

  Reached get(const std::string& target) { return send("GET", target); }
  Reached post(const std::string& target, const std::string& body) {
    return send("POST", target, body);
  }
  /// Sends a request with these headers, which replace those that it has.
  Reached send(const std::string& method, const std::string& target, const std::string& body = {},
               const std::vector<std::pair<std::string, std::string>>& headers = {}) {
    boost::asio::io_context context;
    beast::tcp_stream stream(context);
    stream.connect({boost::asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(port_)});
    beast::http::request<beast::http::string_body> request;
    request.method_string(method);
    request.target(target);
    request.set("Host", "127.0.0.1:" + std::to_string(port_));
    if (!token_.empty()) request.set("Authorization", "Bearer " + token_);
    for (const auto& [name, value] : headers) request.set(name, value);
    request.body() = body;
    request.prepare_payload();
    request.keep_alive(false);
    beast::http::write(stream, request);
    beast::flat_buffer buffer;
    beast::http::response_parser<beast::http::string_body> parser;
    parser.body_limit(std::uint64_t{1} << 30);
    if (method == "HEAD") parser.skip(true);
    beast::http::read(stream, buffer, parser);
    auto& response = parser.get();
    return {static_cast<int>(response.result_int()), std::string(response["Content-Type"]),
            response.body(), response.base()};
  }

 private:
  int port_;
  std::string token_;
};

/// A WebSocket of the door.
class SocketClient {
 public:
  SocketClient(int port, const std::string& token, const std::string& origin = {})
      : stream_(context_) {
    stream_.next_layer().connect(
        {boost::asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(port)});
    stream_.next_layer().set_option(Tcp::no_delay(true));
    stream_.read_message_max(std::size_t{1} << 30);
    if (!origin.empty()) {
      stream_.set_option(beast::websocket::stream_base::decorator(
          [origin](beast::websocket::request_type& request) { request.set("Origin", origin); }));
    }
    stream_.handshake("127.0.0.1:" + std::to_string(port), "/v1/socket?token=" + token);
  }

  void send(const std::string& text) { stream_.write(boost::asio::buffer(text)); }
  /// Returns the next message, or `{"closed": code}`.
  nlohmann::json next() {
    beast::flat_buffer buffer;
    beast::error_code error;
    stream_.read(buffer, error);
    if (error == beast::websocket::error::closed) return {{"closed", stream_.reason().code}};
    if (error) return {{"closed", error.message()}};
    return nlohmann::json::parse(beast::buffers_to_string(buffer.data()));
  }
  /// Returns the next message with this id; keeps the others for later calls.
  nlohmann::json next(std::int64_t id) {
    return next([id](const nlohmann::json& message) { return message.value("id", -1) == id; });
  }
  /// Returns the next message that fits; keeps the others for later calls.
  nlohmann::json next(const std::function<bool(const nlohmann::json&)>& fits) {
    for (auto kept = kept_.begin(); kept != kept_.end(); ++kept) {
      if (!fits(*kept)) continue;
      nlohmann::json found = std::move(*kept);
      kept_.erase(kept);
      return found;
    }
    for (;;) {
      nlohmann::json message = next();
      if (message.contains("closed") || fits(message)) return message;
      kept_.push_back(std::move(message));
    }
  }
  Tcp::socket& lowest() { return stream_.next_layer(); }

 private:
  boost::asio::io_context context_;
  beast::websocket::stream<Tcp::socket> stream_;
  std::deque<nlohmann::json> kept_;
};

}  // namespace camway::view
