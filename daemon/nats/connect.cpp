// SPDX-License-Identifier: MIT
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <optional>
#include <vector>

#include "daemon/base/file_descriptor.h"
#include "daemon/nats/connection_parts.h"
#include "daemon/nats/security_files.h"

namespace camway::nats {
namespace {

// A stopped server is noticed after the third of these, so within about three seconds.
constexpr std::int64_t kPingInterval_ms = 1000;
constexpr int kMostUnansweredPings = 2;
constexpr std::int64_t kReconnectWait_ms = 150;
constexpr std::int64_t kReconnectJitter_ms = 100;
/// For one server: TCP, TLS and the server's greeting.
constexpr std::int64_t kConnectTimeout_ms = 2000;
/// A message that cannot be written for so long is lost: a stopped server must not stop the sender.
constexpr std::int64_t kWriteDeadline_ms = 1000;
/// The library would keep messages for the next connection, which `Bus::publish` must not. It has
/// no zero; with one byte, it keeps at most the message at which it notices the loss.
constexpr int kLeastReconnectBuffer_bytes = 1;
constexpr const char* kDefaultPort = "4222";

void on_disconnected(natsConnection*, void* closure) {
  (*static_cast<std::shared_ptr<ConnectionEvents>*>(closure))->lost();
}

void on_reconnected(natsConnection* connection, void* closure) {
  (*static_cast<std::shared_ptr<ConnectionEvents>*>(closure))->made(connection);
}

/// The library calls this last.
void on_closed(natsConnection*, void* closure) {
  const std::unique_ptr<std::shared_ptr<ConnectionEvents>> events(
      static_cast<std::shared_ptr<ConnectionEvents>*>(closure));
  (*events)->tell_closed();
}

/// Without a handler the library prints errors.
void on_error(natsConnection*, natsSubscription*, natsStatus, void*) {}

bool begins_with_tls(const std::string& url) { return url.starts_with("tls://"); }

natsStatus set_security(natsOptions* set, const ConnectOptions& options) {
  natsStatus status = NATS_OK;
  const auto also = [&](natsStatus next) { status = status == NATS_OK ? next : status; };
  if (!options.credentials_file.empty()) {
    also(natsOptions_SetUserCredentialsFromFiles(set, options.credentials_file.c_str(), nullptr));
  }
  if (!options.ca_file.empty() || !options.certificate_file.empty() ||
      std::ranges::any_of(options.servers, begins_with_tls)) {
    also(natsOptions_SetSecure(set, true));
  }
  if (status == NATS_OK && !options.ca_file.empty()) {
    also(natsOptions_LoadCATrustedCertificates(set, options.ca_file.c_str()));
  }
  if (status == NATS_OK && !options.certificate_file.empty()) {
    also(natsOptions_LoadCertificatesChain(set, options.certificate_file.c_str(),
                                           options.key_file.c_str()));
  }
  return status;
}

natsStatus set_all(natsOptions* set, const ConnectOptions& options, void* closure) {
  std::vector<const char*> urls;
  for (const std::string& server : options.servers) urls.push_back(server.c_str());
  natsStatus status = set_security(set, options);
  for (const natsStatus next :
       {natsOptions_SetServers(set, urls.data(), static_cast<int>(urls.size())),
        natsOptions_SetName(set, options.name.c_str()), natsOptions_SetAllowReconnect(set, true),
        natsOptions_SetMaxReconnect(set, -1), natsOptions_SetReconnectWait(set, kReconnectWait_ms),
        natsOptions_SetReconnectJitter(set, kReconnectJitter_ms, kReconnectJitter_ms),
        natsOptions_SetReconnectBufSize(set, kLeastReconnectBuffer_bytes),
        natsOptions_SetPingInterval(set, kPingInterval_ms),
        natsOptions_SetMaxPingsOut(set, kMostUnansweredPings),
        natsOptions_SetTimeout(set, kConnectTimeout_ms),
        natsOptions_SetWriteDeadline(set, kWriteDeadline_ms),
        natsOptions_SetFailRequestsOnDisconnect(set, true), natsOptions_SetSendAsap(set, true),
        natsOptions_SetErrorHandler(set, on_error, nullptr),
        natsOptions_SetDisconnectedCB(set, on_disconnected, closure),
        natsOptions_SetReconnectedCB(set, on_reconnected, closure),
        natsOptions_SetClosedCB(set, on_closed, closure)}) {
    if (status == NATS_OK) status = next;
  }
  return status;
}

struct HostAndPort {
  std::string host;
  std::string port = kDefaultPort;
};

HostAndPort host_and_port(const std::string& server) {
  std::string text = shown_server(server);
  if (const std::size_t scheme = text.find("://"); scheme != std::string::npos) {
    text.erase(0, scheme + 3);
  }
  text.erase(std::min(text.find('/'), text.size()));
  HostAndPort place{text};
  const std::size_t colon = text.rfind(':');
  // In an IPv6 address without a port, the last colon stands before a bracket.
  if (colon != std::string::npos && text.find(']', colon) == std::string::npos) {
    place.host = text.substr(0, colon);
    place.port = text.substr(colon + 1);
  }
  if (place.host.starts_with('[')) place.host = place.host.substr(1, place.host.size() - 2);
  return place;
}

std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char letter) {
    return static_cast<char>(std::tolower(letter));
  });
  return text;
}

/// Returns why no TCP connection can be made; empty if one can. The library does not say.
std::string fault_of_tcp(const std::string& server) {
  const HostAndPort place = host_and_port(server);
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int failed = getaddrinfo(place.host.c_str(), place.port.c_str(), &hints, &found)) {
    return lower_case(gai_strerror(failed));
  }
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> addresses(found, freeaddrinfo);
  int error = 0;
  for (const addrinfo* each = found; each != nullptr; each = each->ai_next) {
    const base::FileDescriptor socket(
        ::socket(each->ai_family, each->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (::connect(socket.get(), each->ai_addr, each->ai_addrlen) == 0) return "";
    error = errno;
    if (error != EINPROGRESS) continue;
    pollfd wait{socket.get(), POLLOUT, 0};
    if (poll(&wait, 1, static_cast<int>(kConnectTimeout_ms)) <= 0) {
      error = ETIMEDOUT;
      continue;
    }
    socklen_t size = sizeof error;
    getsockopt(socket.get(), SOL_SOCKET, SO_ERROR, &error, &size);
    if (error == 0) return "";
  }
  return lower_case(std::strerror(error));
}

std::string words_of(natsStatus status) {
  natsStatus last = NATS_OK;
  const char* const text = nats_GetLastError(&last);
  if (last != status || text == nullptr || *text == '\0') {
    return lower_case(natsStatus_GetText(status));
  }
  // The library puts its own file and line before the text: "(conn.c:1905): ".
  const std::string_view all(text);
  const std::size_t end = all.starts_with('(') ? all.find("): ") : std::string_view::npos;
  return lower_case(std::string(end == std::string_view::npos ? all : all.substr(end + 3)));
}

/// Returns the library's words for the reason of a failure, or better ones where they mean little.
std::string reason_of(natsStatus status, const ConnectOptions& options) {
  std::string words = words_of(status);
  const bool has_ended = words.find("expected 'pong', got ''") != std::string::npos;
  if (!has_ended || !options.certificate_file.empty()) return words;
  return "the server ended the connection: it may demand a client certificate "
         "(fleet.certificate_file)";
}

/// Whether it is of no use to try again, since the server or a file says no.
bool is_refusal(natsStatus status) {
  return status == NATS_CONNECTION_AUTH_FAILED || status == NATS_NOT_PERMITTED ||
         status == NATS_SSL_ERROR || status == NATS_SECURE_CONNECTION_REQUIRED ||
         status == NATS_SECURE_CONNECTION_WANTED || status == NATS_INVALID_ARG ||
         status == NATS_ADDRESS_MISSING;
}

FirstConnection try_servers(const ConnectOptions& options,
                            const std::shared_ptr<ConnectionEvents>& events) {
  natsOptions* made = nullptr;
  if (natsOptions_Create(&made) != NATS_OK) return {nullptr, "no memory for NATS", true};
  const NatsOwned<natsOptions> set(made);
  auto closure = std::make_unique<std::shared_ptr<ConnectionEvents>>(events);
  natsConnection* connection = nullptr;
  natsStatus status = set_all(set.get(), options, closure.get());
  const bool is_set = status == NATS_OK;
  if (is_set) status = natsConnection_Connect(&connection, set.get());
  if (status == NATS_OK) {
    // `on_closed` deletes it, for which a connection that was made is always closed.
    static_cast<void>(closure.release());
    return {NatsHandle(connection, natsConnection_Destroy), "", false};
  }
  return {nullptr, reason_of(status, options), !is_set || is_refusal(status)};
}

}  // namespace

std::string shown_server(const std::string& url) {
  const std::size_t scheme = url.find("://");
  const std::size_t begin = scheme == std::string::npos ? 0 : scheme + 3;
  const std::size_t end = std::min(url.find('/', begin), url.size());
  const std::size_t at = url.rfind('@', end);
  if (at == std::string::npos || at < begin) return url;
  return url.substr(0, begin) + url.substr(at + 1);
}

FirstConnection connect_once(const ConnectOptions& options,
                             const std::shared_ptr<ConnectionEvents>& events) {
  const std::vector<SecurityFileFault> faults = faults_of_security_files(options);
  if (!faults.empty()) return {nullptr, faults.front().reason, true};
  FirstConnection tried = try_servers(options, events);
  if (tried.handle != nullptr) return tried;
  // The library says why the last server failed, but not which one that was.
  FirstConnection failed{nullptr, "", tried.is_refused};
  for (const std::string& server : options.servers) {
    std::string fault = fault_of_tcp(server);
    if (fault.empty()) {
      ConnectOptions alone = options;
      alone.servers = {server};
      const FirstConnection again = options.servers.size() > 1 ? try_servers(alone, events) : tried;
      fault = again.handle != nullptr ? "could not be reached for a moment" : again.error;
      failed.is_refused = failed.is_refused || again.is_refused;
    }
    failed.error += (failed.error.empty() ? "" : "; ") + shown_server(server) + ": " + fault;
  }
  return failed;
}

}  // namespace camway::nats
