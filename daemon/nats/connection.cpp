// SPDX-License-Identifier: MIT
#include "daemon/nats/connection.h"

#include <array>
#include <cassert>
#include <limits>
#include <utility>

#include "daemon/nats/connection_parts.h"

namespace camway::nats {
namespace {

/// Between tries of the first connection, and of one that takes the place of a refused one.
constexpr std::chrono::milliseconds kFirstRetry{100};
constexpr std::chrono::milliseconds kRefusedRetry{1000};
/// Much longer than the library's thread needs from finding a subscription to locking it.
constexpr std::chrono::seconds kRetirement{10};
constexpr std::size_t kMostUrlBytes = 1024;
/// The id of a server has 56.
constexpr std::size_t kMostIdBytes = 256;

using ReceiverClosure = std::shared_ptr<Receiver>;

void on_message(natsConnection*, natsSubscription*, natsMsg* message, void* closure) {
  const NatsOwned<natsMsg> owned(message);
  (*static_cast<ReceiverClosure*>(closure))->take(message);
}

/// The library calls this last.
void on_complete(void* closure) { delete static_cast<ReceiverClosure*>(closure); }

class NatsSubscription final : public Subscription {
 public:
  NatsSubscription(Connection::Parts& parts, std::string subject, Bus::Handler handler)
      : parts_(parts),
        subscribed_{std::move(subject), std::make_shared<Receiver>(std::move(handler)), nullptr} {}
  ~NatsSubscription() override {
    {
      const std::lock_guard lock(parts_.mutex);
      parts_.subscribed.erase(&subscribed_);
      parts_.retire(std::move(subscribed_.subscription));
    }
    subscribed_.receiver->end();
  }
  NatsSubscription(const NatsSubscription&) = delete;
  NatsSubscription& operator=(const NatsSubscription&) = delete;

  bool begin() {
    const std::lock_guard lock(parts_.mutex);
    if (!parts_.subscribe(subscribed_)) return false;
    parts_.subscribed.insert(&subscribed_);
    return true;
  }

 private:
  Connection::Parts& parts_;
  Subscribed subscribed_;
};

}  // namespace

std::string server_of(natsConnection* connection) {
  std::array<char, kMostUrlBytes> url{};
  const natsStatus status = natsConnection_GetConnectedUrl(connection, url.data(), url.size());
  return status == NATS_OK ? shown_server(url.data()) : "";
}

std::string server_id_of(natsConnection* connection) {
  std::array<char, kMostIdBytes> id{};
  const natsStatus status = natsConnection_GetConnectedServerId(connection, id.data(), id.size());
  return status == NATS_OK ? id.data() : "";
}

void ConnectionEvents::made(natsConnection* connection) {
  const std::int64_t bytes = natsConnection_GetMaxPayload(connection);
  most_bytes_ = bytes > 0 ? static_cast<std::size_t>(bytes) : 0;
  std::string server = server_of(connection);
  std::string id = server_id_of(connection);
  {
    const std::lock_guard lock(mutex_);
    server_ = std::move(server);
    server_id_ = std::move(id);
  }
  ++generation_;
  is_connected_ = true;
  tell(true);
}

void ConnectionEvents::lost() {
  is_connected_ = false;
  {
    const std::lock_guard lock(mutex_);
    server_.clear();
    server_id_.clear();
  }
  tell(false);
}

std::string ConnectionEvents::server() {
  const std::lock_guard lock(mutex_);
  return server_;
}

std::string ConnectionEvents::server_id() {
  const std::lock_guard lock(mutex_);
  return server_id_;
}

void ConnectionEvents::listen(std::function<void(bool)> changed) {
  const std::lock_guard lock(listener_mutex_);
  changed_ = std::move(changed);
}

void ConnectionEvents::tell(bool is_connected) {
  const std::lock_guard lock(listener_mutex_);
  // A copy, because the listener may replace itself.
  const auto changed = changed_;
  if (changed) changed(is_connected);
}

void ConnectionEvents::tell_closed() {
  is_connected_ = false;
  const std::lock_guard lock(mutex_);
  is_closed_ = true;
  changed_state_.notify_all();
}

void ConnectionEvents::stop() {
  const std::lock_guard lock(mutex_);
  is_stopped_ = true;
  changed_state_.notify_all();
}

bool ConnectionEvents::wait_until_closed() {
  std::unique_lock lock(mutex_);
  changed_state_.wait(lock, [this] { return is_closed_ || is_stopped_; });
  is_closed_ = false;
  return !is_stopped_;
}

bool ConnectionEvents::pause(std::chrono::milliseconds time) {
  std::unique_lock lock(mutex_);
  return !changed_state_.wait_for(lock, time, [this] { return is_stopped_; });
}

void Receiver::take(natsMsg* message) {
  const std::lock_guard lock(turn_);
  if (has_ended_) return;
  const auto* const data = reinterpret_cast<const std::uint8_t*>(natsMsg_GetData(message));
  const auto size = static_cast<std::size_t>(natsMsg_GetDataLength(message));
  handler_(natsMsg_GetSubject(message), {data, size});
}

void Receiver::end() {
  const std::lock_guard lock(turn_);
  has_ended_ = true;
}

NatsHandle Connection::Parts::connection() {
  const std::lock_guard lock(mutex);
  return handle;
}

void Connection::Parts::retire(NatsOwned<natsSubscription> subscription) {
  const auto now = std::chrono::steady_clock::now();
  while (!retired.empty() && retired.front().when + kRetirement < now) retired.pop_front();
  if (subscription == nullptr) return;
  natsSubscription_Unsubscribe(subscription.get());
  retired.push_back({std::move(subscription), now});
}

bool Connection::Parts::subscribe(Subscribed& wanted) {
  auto closure = std::make_unique<ReceiverClosure>(wanted.receiver);
  natsSubscription* made = nullptr;
  if (natsConnection_Subscribe(&made, handle.get(), wanted.subject.c_str(), on_message,
                               closure.get()) != NATS_OK) {
    return false;
  }
  // Messages may come before this, but the subscription is not complete before it has ended.
  natsSubscription_SetOnCompleteCB(made, on_complete, closure.release());
  natsSubscription_SetPendingLimits(made, -1, std::numeric_limits<int>::max());
  retire(std::exchange(wanted.subscription, NatsOwned<natsSubscription>(made)));
  return true;
}

void Connection::Parts::revive_until_stopped() {
  // The library gives up a connection that one server has refused twice in a row.
  while (events->wait_until_closed()) {
    FirstConnection next;
    while (next.handle == nullptr && events->pause(kRefusedRetry)) {
      next = connect_once(options, events);
    }
    if (next.handle == nullptr) return;
    {
      const std::lock_guard lock(mutex);
      handle.swap(next.handle);
      for (Subscribed* const each : subscribed) subscribe(*each);
    }
    events->made(connection().get());
  }
}

base::Result<std::unique_ptr<Connection>> Connection::open(const ConnectOptions& options) {
  assert(!options.servers.empty());
  assert(options.certificate_file.empty() == options.key_file.empty());
  auto parts = std::make_unique<Parts>();
  parts->options = options;
  const auto end = std::chrono::steady_clock::now() + options.patience;
  for (;;) {
    FirstConnection first = connect_once(options, parts->events);
    if (first.handle != nullptr) {
      parts->events->made(first.handle.get());
      parts->handle = std::move(first.handle);
      break;
    }
    const bool is_over = std::chrono::steady_clock::now() + kFirstRetry >= end;
    if (first.is_refused || is_over) return base::Failure{std::move(first.error)};
    std::this_thread::sleep_for(kFirstRetry);
  }
  parts->stalls = std::make_unique<StallWatch>(options);
  Parts& shared = *parts;
  shared.reviver = std::thread([&shared] { shared.revive_until_stopped(); });
  return std::unique_ptr<Connection>(new Connection(std::move(parts)));
}

Connection::Connection(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

Connection::~Connection() {
  parts_->events->listen({});
  parts_->events->stop();
  parts_->reviver.join();
  parts_->stalls.reset();
  // The reading thread has ended when the connection is closed.
  natsConnection_Close(parts_->handle.get());
  assert(parts_->subscribed.empty());
}

bool Connection::publish(const std::string& subject, std::span<const std::uint8_t> payload) {
  if (!is_connected()) return false;
  const NatsHandle handle = parts_->connection();
  return natsConnection_Publish(handle.get(), subject.c_str(), payload.data(),
                                static_cast<int>(payload.size())) == NATS_OK;
}

std::unique_ptr<Subscription> Connection::subscribe(const std::string& subject, Handler handler) {
  auto made = std::make_unique<NatsSubscription>(*parts_, subject, std::move(handler));
  if (!made->begin()) return nullptr;
  return made;
}

bool Connection::is_connected() const { return parts_->events->is_connected(); }

std::size_t Connection::most_bytes() const { return parts_->events->most_bytes(); }

void Connection::on_change(std::function<void(bool is_connected)> changed) {
  parts_->events->listen(std::move(changed));
}

std::string Connection::server() const { return parts_->events->server(); }

std::string Connection::stall() const { return parts_->stalls->stall(parts_->events->server_id()); }

std::uint64_t Connection::generation() const { return parts_->events->generation(); }

}  // namespace camway::nats
