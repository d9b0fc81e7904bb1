// SPDX-License-Identifier: MIT
#include <atomic>
#include <chrono>
#include <deque>
#include <mutex>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "daemon/http/connection.h"

namespace camway::http {
namespace {

namespace websocket = beast::websocket;

/// Messages that wait to be sent. Thread-safe.
class Outbox {
 public:
  explicit Outbox(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  /// Returns false if the message is not taken. `is_first`: whether nothing waited before.
  bool put(std::string text, bool& is_first) {
    const std::lock_guard lock(mutex_);
    if (has_ended_ || bytes_ + text.size() > most_bytes_) return false;
    is_first = texts_.empty();
    bytes_ += text.size();
    texts_.push_back(std::move(text));
    return true;
  }
  /// Returns the next message, which stays where it is; null if there is none.
  const std::string* front() {
    const std::lock_guard lock(mutex_);
    return texts_.empty() ? nullptr : &texts_.front();
  }
  void pop() {
    const std::lock_guard lock(mutex_);
    bytes_ -= texts_.front().size();
    texts_.pop_front();
  }
  void end() {
    const std::lock_guard lock(mutex_);
    has_ended_ = true;
  }

 private:
  const std::size_t most_bytes_;
  std::mutex mutex_;
  std::deque<std::string> texts_;
  std::size_t bytes_ = 0;
  bool has_ended_ = false;
};

class WebSocket final : public Place, public std::enable_shared_from_this<WebSocket> {
 public:
  WebSocket(beast::tcp_stream&& stream, Core& core, std::shared_ptr<Outbox> outbox,
            std::unique_ptr<SocketEvents> events)
      : stream_(std::move(stream)),
        core_(core),
        outbox_(std::move(outbox)),
        events_(std::move(events)) {
    core_.take_place(this);
  }
  ~WebSocket() override {
    outbox_->end();
    events_.reset();
    core_.leave_place(this);
  }
  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;

  void accept(const BeastRequest& upgrade) {
    // The stream's own clock must not run beside that of the protocol.
    beast::get_lowest_layer(stream_).expires_never();
    stream_.set_option(websocket::stream_base::timeout{core_.limits.patience, core_.limits.silence,
                                                       /*pings=*/true});
    stream_.set_option(
        websocket::stream_base::decorator([this](websocket::response_type& response) {
          for (const auto& [name, value] : core_.handlers.headers) response.set(name, value);
        }));
    // One frame for a message, which simple clients and the kernel take better than many.
    stream_.auto_fragment(false);
    stream_.read_message_max(core_.limits.message_bytes);
    stream_.async_accept(upgrade, [self = shared_from_this()](beast::error_code error) {
      if (error) return;
      self->is_open_ = true;
      self->write();
      self->read();
    });
  }

  /// Sends what waits, one message after the other.
  void write() {
    if (!is_open_ || is_writing_ || is_closing_) return;
    const std::string* const text = outbox_->front();
    if (text == nullptr) {
      if (closes_) close(websocket::close_code::normal);
      return;
    }
    is_writing_ = true;
    stream_.text(true);
    stream_.async_write(asio::buffer(*text),
                        [self = shared_from_this()](beast::error_code error, std::size_t) {
                          self->is_writing_ = false;
                          if (error) return self->abort();
                          self->outbox_->pop();
                          self->write();
                        });
  }

  void close_when_sent() {
    outbox_->end();
    closes_ = true;
    write();
  }

  void abort() override {
    outbox_->end();
    beast::get_lowest_layer(stream_).close();
  }

 private:
  void read() {
    stream_.async_read(buffer_, [self = shared_from_this()](beast::error_code error, std::size_t) {
      self->on_read(error);
    });
  }

  void on_read(beast::error_code error) {
    // The stream has told the other side why, if that is possible.
    if (error) return abort();
    if (!stream_.got_text()) return close(websocket::close_code::unknown_data);
    std::string text = beast::buffers_to_string(buffer_.data());
    buffer_.consume(buffer_.size());
    events_->received(std::move(text));
    read();
  }

  /// Begins to close, unless that has begun: a message that is refused and a handler may both ask
  /// for it, and the stream takes one close at a time.
  void close(websocket::close_code code) {
    if (std::exchange(is_closing_, true)) return;
    outbox_->end();
    stream_.async_close(code, [self = shared_from_this()](beast::error_code) { self->abort(); });
  }

  websocket::stream<beast::tcp_stream> stream_;
  Core& core_;
  const std::shared_ptr<Outbox> outbox_;
  std::unique_ptr<SocketEvents> events_;
  beast::flat_buffer buffer_;
  bool is_open_ = false;
  bool is_writing_ = false;
  bool closes_ = false;      ///< to be closed once all waiting messages are sent
  bool is_closing_ = false;  ///< the close frame is on its way, and nothing is sent after it
};

/// The end of a connection that the handlers keep.
class SocketHandle final : public Socket {
 public:
  SocketHandle(std::shared_ptr<Core> core, std::shared_ptr<Outbox> outbox)
      : core_(std::move(core)), outbox_(std::move(outbox)) {}

  bool send(std::string text) override {
    bool is_first = false;
    if (!outbox_->put(std::move(text), is_first)) return false;
    if (is_first) post([](WebSocket& socket) { socket.write(); });
    return true;
  }
  void close() override {
    post([](WebSocket& socket) { socket.close_when_sent(); });
  }

  /// Called once, before the handle is given away or on the server's thread.
  void connect(const std::shared_ptr<WebSocket>& socket) {
    const std::lock_guard lock(mutex_);
    socket_ = socket;
  }

 private:
  void post(void (*act)(WebSocket&)) {
    const std::lock_guard lock(mutex_);
    asio::post(core_->context, [socket = socket_, act] {
      if (const std::shared_ptr<WebSocket> open = socket.lock()) act(*open);
    });
  }

  const std::shared_ptr<Core> core_;
  const std::shared_ptr<Outbox> outbox_;
  std::mutex mutex_;
  std::weak_ptr<WebSocket> socket_;
};

}  // namespace

bool serve_socket(beast::tcp_stream& stream, const BeastRequest& upgrade, const Request& request,
                  const std::shared_ptr<Core>& core) {
  auto outbox = std::make_shared<Outbox>(core->limits.queued_bytes);
  auto handle = std::make_shared<SocketHandle>(core, outbox);
  std::unique_ptr<SocketEvents> events = core->handlers.on_socket(request, handle);
  if (!events) return false;
  const auto socket =
      std::make_shared<WebSocket>(std::move(stream), *core, std::move(outbox), std::move(events));
  handle->connect(socket);
  socket->accept(upgrade);
  return true;
}

}  // namespace camway::http
