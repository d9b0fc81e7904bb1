// SPDX-License-Identifier: MIT
#include "daemon/process/metrics/http_page.h"

#include <fmt/format.h>
#include <microhttpd.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include "daemon/base/file_descriptor.h"

namespace camway::process {
namespace {

constexpr std::size_t kConnectionBytes = 16'384;
constexpr int kBacklog = 16;

/// Listens; returns false with `errno` set if that is not possible. Takes a port whose last user
/// ended a moment ago, but not one on which somebody listens.
bool listen_on(int socket, const SocketAddress& address) {
  const int yes = 1;
  return socket >= 0 && setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) == 0 &&
         bind(socket, reinterpret_cast<const sockaddr*>(&address.storage), address.size) == 0 &&
         listen(socket, kBacklog) == 0;
}

int port_of(int socket) {
  SocketAddress address;
  address.size = sizeof address.storage;
  if (getsockname(socket, reinterpret_cast<sockaddr*>(&address.storage), &address.size) != 0) {
    return 0;
  }
  const auto* const v4 = reinterpret_cast<const sockaddr_in*>(&address.storage);
  const auto* const v6 = reinterpret_cast<const sockaddr_in6*>(&address.storage);
  return ntohs(address.storage.ss_family == AF_INET ? v4->sin_port : v6->sin6_port);
}

/// Runs the library on a thread of our own. On one of its own threads, libmicrohttpd 0.9.75 (Debian
/// 12) dereferences null when an invalid request arrives while another thread stops it: it drops
/// the answer to the request because it is stopped, and then writes the head of that answer. This
/// cannot happen if one thread runs and stops it.
class MicroHttpPage final : public HttpPage {
 public:
  MicroHttpPage(HttpContent content, const HttpLimits& limits)
      : content_(std::move(content)), limits_(limits), stop_(eventfd(0, EFD_CLOEXEC)) {}
  ~MicroHttpPage() override {
    if (!thread_.joinable()) return;
    eventfd_write(stop_.get(), 1);
    thread_.join();
  }
  MicroHttpPage(const MicroHttpPage&) = delete;
  MicroHttpPage& operator=(const MicroHttpPage&) = delete;

  /// Takes over `socket`, which has to be listening.
  bool start(base::FileDescriptor& socket) {
    if (stop_.get() < 0) return false;
    port_ = port_of(socket.get());
    daemon_ = MHD_start_daemon(
        MHD_USE_EPOLL, 0, nullptr, nullptr, &on_request, this, MHD_OPTION_LISTEN_SOCKET,
        socket.get(), MHD_OPTION_CONNECTION_LIMIT, static_cast<unsigned int>(limits_.connections),
        MHD_OPTION_CONNECTION_TIMEOUT, static_cast<unsigned int>(limits_.idle_s),
        MHD_OPTION_CONNECTION_MEMORY_LIMIT, kConnectionBytes, MHD_OPTION_NOTIFY_CONNECTION,
        &on_connection, this, MHD_OPTION_END);
    if (daemon_ == nullptr) return false;
    socket.release();
    thread_ = std::thread([this] { run(); });
    return true;
  }

  [[nodiscard]] int port() const override { return port_; }

 private:
  /// Body of the page's thread: serves until `stop_` is readable.
  void run() {
    const int events = MHD_get_daemon_info(daemon_, MHD_DAEMON_INFO_EPOLL_FD)->epoll_fd;
    std::array<pollfd, 2> inputs{{{events, POLLIN, 0}, {stop_.get(), POLLIN, 0}}};
    while (inputs[1].revents == 0) {
      serve();
      poll(inputs.data(), inputs.size(), patience_ms());
    }
    MHD_stop_daemon(daemon_);
  }

  /// Serves what there is, and again after a connection was closed: only then does the library
  /// listen for connections that waited for its place.
  void serve() {
    do {
      one_has_gone_ = false;
      MHD_run(daemon_);
    } while (one_has_gone_);
  }

  /// Returns the time until the next connection has been idle for too long; -1 if there is none.
  [[nodiscard]] int patience_ms() const {
    MHD_UNSIGNED_LONG_LONG timeout_ms = 0;
    if (MHD_get_timeout(daemon_, &timeout_ms) != MHD_YES) return -1;
    return static_cast<int>(
        std::min<MHD_UNSIGNED_LONG_LONG>(timeout_ms, std::numeric_limits<int>::max()));
  }

  static MHD_Result answer(MHD_Connection* connection, unsigned int code, const std::string& type,
                           const std::string& body) {
    MHD_Response* const response = MHD_create_response_from_buffer(
        body.size(), const_cast<char*>(body.data()), MHD_RESPMEM_MUST_COPY);
    if (response == nullptr) return MHD_NO;
    MHD_add_response_header(response, "Content-Type", type.c_str());
    if (code == MHD_HTTP_METHOD_NOT_ALLOWED)
      MHD_add_response_header(response, "Allow", "GET, HEAD");
    const MHD_Result queued = MHD_queue_response(connection, code, response);
    MHD_destroy_response(response);
    return queued;
  }

  static void on_connection(void* self, MHD_Connection* /*connection*/, void** /*state*/,
                            MHD_ConnectionNotificationCode what) {
    auto& page = *static_cast<MicroHttpPage*>(self);
    const bool started = what == MHD_CONNECTION_NOTIFY_STARTED;
    page.connections_ += started ? 1 : -1;
    page.one_has_gone_ |= !started;
    if (started && page.connections_ >= page.limits_.connections && page.content_.on_full) {
      page.content_.on_full();
    }
  }

  static MHD_Result on_request(void* self, MHD_Connection* connection, const char* url,
                               const char* method, const char* /*version*/,
                               const char* /*upload_data*/, std::size_t* /*upload_size*/,
                               void** /*state*/) {
    const auto& page = *static_cast<const MicroHttpPage*>(self);
    const std::string_view verb(method);
    if (verb != "GET" && verb != "HEAD") {
      return answer(connection, MHD_HTTP_METHOD_NOT_ALLOWED, "text/plain", "only GET and HEAD\n");
    }
    if (url != page.content_.path) {
      return answer(connection, MHD_HTTP_NOT_FOUND, "text/plain",
                    "see " + page.content_.path + "\n");
    }
    return answer(connection, MHD_HTTP_OK, page.content_.type, page.content_.text());
  }

  const HttpContent content_;
  const HttpLimits limits_;
  const base::FileDescriptor stop_;  ///< readable when the thread has to end
  MHD_Daemon* daemon_ = nullptr;
  int port_ = 0;
  int connections_ = 0;        ///< used by the page's thread only
  bool one_has_gone_ = false;  ///< a connection closed since `MHD_run` was last called
  std::thread thread_;
};

}  // namespace

base::Result<std::unique_ptr<HttpPage>> open_http_page(const HttpAddress& address,
                                                       HttpContent content,
                                                       const HttpLimits& limits) {
  const std::optional<SocketAddress> parsed = socket_address(address);
  if (!parsed) {
    return base::Failure{fmt::format("'{}' is no IPv4 or IPv6 address", address.ip)};
  }
  const std::string where = fmt::format("cannot listen on {} port {}", address.ip, address.port);
  base::FileDescriptor socket(::socket(parsed->storage.ss_family, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (!listen_on(socket.get(), *parsed)) {
    return base::Failure{fmt::format("{}: {}", where, std::strerror(errno))};
  }
  auto page = std::make_unique<MicroHttpPage>(std::move(content), limits);
  if (!page->start(socket)) {
    return base::Failure{fmt::format("{}: the HTTP server does not start", where)};
  }
  return std::unique_ptr<HttpPage>(std::move(page));
}

}  // namespace camway::process
