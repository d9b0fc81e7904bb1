// SPDX-License-Identifier: MIT
#include "daemon/http/connection.h"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <chrono>
#include <cstdint>
#include <string>

#include <boost/asio/post.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

namespace camway::http {
namespace {

/// A refused client may take so long to send what nobody reads; its connection keeps a place.
constexpr std::chrono::milliseconds kLongestDrain{2000};

/// The way back to a connection that waits for its response. The connection is kept by it alone.
class PendingReply {
 public:
  PendingReply(std::shared_ptr<Core> core, std::shared_ptr<Connection> connection)
      : core_(std::move(core)), connection_(std::move(connection)) {}
  ~PendingReply() { send(std::nullopt); }
  PendingReply(const PendingReply&) = delete;
  PendingReply& operator=(const PendingReply&) = delete;

  void send(std::optional<Response> response) {
    if (has_sent_.exchange(true)) return;
    asio::post(core_->context,
               [connection = std::move(connection_), response = std::move(response)]() mutable {
                 connection->answer(std::move(response));
               });
  }

 private:
  // Destroyed last: the connection may be destroyed with what was posted to it.
  const std::shared_ptr<Core> core_;
  std::shared_ptr<Connection> connection_;
  std::atomic<bool> has_sent_ = false;
};

Request to_request(BeastRequest&& parsed) {
  Request request{std::string(parsed.method_string()), std::string(parsed.target()), {}, {}};
  for (const auto& field : parsed) {
    std::string name(field.name_string());
    for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    request.headers.emplace_back(std::move(name), std::string(field.value()));
  }
  request.body = std::move(parsed.body());
  return request;
}

/// Returns the status for a request that cannot be read; 0 if there is nobody to tell.
int status_of(beast::error_code error) {
  using Error = beast::http::error;
  if (error == Error::end_of_stream || error == Error::partial_message) return 0;
  if (error == Error::header_limit) return 431;
  if (error == Error::body_limit) return 413;
  return error.category() == beast::http::make_error_code(Error::bad_method).category() ? 400 : 0;
}

}  // namespace

std::string_view Request::header(std::string_view name) const {
  for (const auto& [each, value] : headers) {
    if (each == name) return value;
  }
  return {};
}

Connection::Connection(tcp::socket socket, const std::shared_ptr<Core>& core)
    : stream_(std::move(socket)), core_(core), shared_(*core) {
  shared_.take_place(this);
}

Connection::~Connection() { shared_.leave_place(this); }

void Connection::read() {
  parser_.emplace();
  parser_->header_limit(static_cast<std::uint32_t>(shared_.limits.header_bytes));
  parser_->body_limit(shared_.limits.body_bytes);
  stream_.expires_after(shared_.limits.patience);
  beast::http::async_read_header(
      stream_, buffer_, *parser_,
      [self = shared_from_this()](beast::error_code error, std::size_t) { self->on_head(error); });
}

void Connection::on_head(beast::error_code fault) {
  if (fault) return refuse(fault);
  if (shared_.handlers.on_head) {
    std::optional<Response> refusal =
        shared_.handlers.on_head(to_request(BeastRequest(parser_->get())));
    if (refusal) {
      version_ = parser_->get().version();
      is_head_ = parser_->get().method() == beast::http::verb::head;
      keeps_alive_ = false;
      has_unread_ = true;
      return answer(std::move(refusal));
    }
  }
  beast::http::async_read(
      stream_, buffer_, *parser_,
      [self = shared_from_this()](beast::error_code error, std::size_t) { self->on_read(error); });
}

void Connection::on_read(beast::error_code error) {
  if (error) return refuse(error);
  BeastRequest parsed = parser_->release();
  version_ = parsed.version();
  keeps_alive_ = parsed.keep_alive();
  is_head_ = parsed.method() == beast::http::verb::head;
  const bool is_upgrade = beast::websocket::is_upgrade(parsed);
  BeastRequest head(parsed.base());
  const Request request = to_request(std::move(parsed));
  if (is_upgrade && upgrade(head, request)) return;
  const std::shared_ptr<Core> core = core_.lock();
  if (!core) return;
  keeps_alive_ = keeps_alive_ && !is_upgrade;
  // The time for the answer is the handler's own.
  stream_.expires_never();
  const auto pending = std::make_shared<PendingReply>(core, shared_from_this());
  shared_.handlers.on_request(request,
                              [pending](Response response) { pending->send(std::move(response)); });
}

bool Connection::upgrade(const BeastRequest& parsed, const Request& request) {
  const std::shared_ptr<Core> core = core_.lock();
  return core && shared_.handlers.on_socket && serve_socket(stream_, parsed, request, core);
}

void Connection::refuse(beast::error_code error) {
  const int status = status_of(error);
  if (status == 0) return abort();
  keeps_alive_ = false;
  is_head_ = false;
  has_unread_ = true;
  answer(Response{status, "text/plain; charset=utf-8", error.message() + "\n"});
}

void Connection::answer(std::optional<Response> response) {
  if (!response) return abort();
  auto message = std::make_shared<BeastResponse>();
  message->version(version_);
  message->result(static_cast<unsigned>(response->status));
  message->set(beast::http::field::content_type, response->type);
  for (const auto& [name, value] : shared_.handlers.headers) message->set(name, value);
  for (const auto& [name, value] : response->headers) message->set(name, value);
  message->body() = std::move(response->body);
  message->keep_alive(keeps_alive_);
  message->prepare_payload();
  if (is_head_) message->body().clear();
  stream_.expires_after(shared_.limits.patience);
  beast::http::async_write(
      stream_, *message,
      [self = shared_from_this(), message](beast::error_code error, std::size_t) {
        if (error) return self->abort();
        if (self->keeps_alive_) return self->read();
        self->has_unread_ ? self->end() : self->abort();
      });
}

void Connection::end() {
  beast::error_code ignored;
  stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
  stream_.expires_after(std::min(shared_.limits.patience, kLongestDrain));
  drain();
}

void Connection::drain() {
  constexpr std::size_t kPart = 65'536;
  buffer_.clear();
  stream_.async_read_some(buffer_.prepare(kPart),
                          [self = shared_from_this()](beast::error_code error, std::size_t) {
                            error ? self->abort() : self->drain();
                          });
}

void Connection::abort() {
  beast::error_code ignored;
  // The other side gets what was written, unless unread bytes make the kernel reset the connection.
  stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
  stream_.close();
}

}  // namespace camway::http
