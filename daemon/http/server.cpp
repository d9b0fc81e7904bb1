// SPDX-License-Identifier: MIT
#include "daemon/http/server.h"

#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <functional>
#include <optional>
#include <thread>
#include <vector>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/post.hpp>

#include "daemon/base/file_descriptor.h"
#include "daemon/http/connection.h"

namespace camway::http {
namespace {

constexpr int kBacklog = 128;

/// Listens; returns false with `errno` set if that is not possible. Takes a port whose last user
/// ended a moment ago, but not one on which somebody listens.
bool listen_on(int socket, const SocketAddress& address) {
  const int yes = 1;
  return socket >= 0 && setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) == 0 &&
         bind(socket, reinterpret_cast<const sockaddr*>(&address.storage), address.size) == 0 &&
         listen(socket, kBacklog) == 0;
}

class BeastServer final : public Server {
 public:
  BeastServer(Handlers handlers, const Limits& limits)
      : core_(std::make_shared<Core>(std::move(handlers), limits)),
        acceptor_(core_->context),
        work_(core_->context.get_executor()) {}
  ~BeastServer() override {
    if (!thread_.joinable()) return;
    asio::post(core_->context, [this] { stop(); });
    thread_.join();
  }
  BeastServer(const BeastServer&) = delete;
  BeastServer& operator=(const BeastServer&) = delete;

  /// Takes over `socket`, which has to be listening. Returns why it cannot be served.
  std::string start(base::FileDescriptor socket, bool is_v6,
                    const std::function<void(int)>& before_start) {
    is_v6_ = is_v6;
    beast::error_code error;
    acceptor_.assign(is_v6 ? tcp::v6() : tcp::v4(), socket.release(), error);
    if (!error) acceptor_.non_blocking(true, error);
    if (!error) port_ = acceptor_.local_endpoint(error).port();
    if (error) return error.message();
    if (before_start) before_start(port_);
    core_->left = [this] { wait(); };
    wait();
    thread_ = std::thread([core = core_] { core->context.run(); });
    return "";
  }

  [[nodiscard]] int port() const override { return port_; }

 private:
  /// Waits for the next connection, if there is a place for it.
  void wait() {
    if (is_waiting_ || is_full()) return;
    is_waiting_ = true;
    acceptor_.async_wait(tcp::acceptor::wait_read, [this](beast::error_code error) {
      is_waiting_ = false;
      if (error) return;
      accept();
      wait();
    });
  }

  void accept() {
    // The library's own accept would leave the connection to programs that this process starts.
    base::FileDescriptor accepted(
        ::accept4(acceptor_.native_handle(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (!accepted.is_open()) return;
    // An answer is written in two parts; the second must not wait for the receipt of the first.
    const int yes = 1;
    setsockopt(accepted.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    beast::error_code error;
    tcp::socket socket(core_->context);
    socket.assign(is_v6_ ? tcp::v6() : tcp::v4(), accepted.release(), error);
    if (error) return;
    std::make_shared<Connection>(std::move(socket), core_)->read();
    if (is_full() && core_->handlers.on_full) core_->handlers.on_full();
  }

  /// Lets the thread end once all connections have.
  void stop() {
    core_->left = nullptr;
    work_.reset();
    beast::error_code ignored;
    acceptor_.close(ignored);
    const std::vector<Place*> open(core_->places.begin(), core_->places.end());
    for (Place* const place : open) place->abort();
  }

  [[nodiscard]] bool is_full() const {
    return core_->places.size() >= static_cast<std::size_t>(core_->limits.connections);
  }

  const std::shared_ptr<Core> core_;
  tcp::acceptor acceptor_;
  /// All connections may wait for replies at a time, and no place be free.
  asio::executor_work_guard<asio::io_context::executor_type> work_;
  bool is_v6_ = false;
  bool is_waiting_ = false;
  int port_ = 0;
  std::thread thread_;
};

}  // namespace

base::Result<std::unique_ptr<Server>> Server::open(const Address& address, Handlers handlers,
                                                   const Limits& limits,
                                                   const std::function<void(int)>& before_start) {
  const std::optional<SocketAddress> parsed = socket_address(address);
  if (!parsed) {
    return base::Failure{fmt::format("'{}' is no IPv4 or IPv6 address", address.ip)};
  }
  const std::string where = fmt::format("cannot listen on {} port {}", address.ip, address.port);
  base::FileDescriptor socket(::socket(parsed->storage.ss_family, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (!listen_on(socket.get(), *parsed)) {
    return base::Failure{fmt::format("{}: {}", where, std::strerror(errno))};
  }
  auto server = std::make_unique<BeastServer>(std::move(handlers), limits);
  const std::string fault =
      server->start(std::move(socket), parsed->storage.ss_family == AF_INET6, before_start);
  if (!fault.empty()) return base::Failure{where + ": " + fault};
  return std::unique_ptr<Server>(std::move(server));
}

}  // namespace camway::http
