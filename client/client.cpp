// SPDX-License-Identifier: MIT
#include "camway/client.h"

#include <atomic>
#include <utility>

#include "client/session.h"

namespace camway {
namespace {

/// Marks a client as in a call, for as long as it lives.
class InCall {
 public:
  explicit InCall(std::atomic<bool>& busy) : busy_(busy), alone_(!busy.exchange(true)) {}
  ~InCall() {
    if (alone_) busy_ = false;
  }
  InCall(const InCall&) = delete;
  InCall& operator=(const InCall&) = delete;
  /// Whether no other call was running.
  bool alone() const { return alone_; }

 private:
  std::atomic<bool>& busy_;
  bool alone_;
};

}  // namespace

class Client::Impl {
 public:
  explicit Impl(ClientOptions options) : session(std::move(options)) {}

  /// Runs `call` unless the client is unusable or in a call.
  template <class Answer, class Call>
  Answer guarded(Call call) {
    const InCall in_call(busy);
    if (!in_call.alone()) {
      return failed<Answer>(
          {Status::kBusy, "this client is in a call on another thread; use one client each"});
    }
    if (!session.error().empty()) {
      return failed<Answer>({session.error_status(), session.error()});
    }
    return call();
  }

  Session session;
  std::atomic<bool> busy = false;
};

Client::Client(ClientOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {}
Client::~Client() = default;

const std::string& Client::error() const { return impl_->session.error(); }

const std::string& Client::client_id() const { return impl_->session.options().client_id; }

PlanResponse Client::plan(const PlanRequest& request) {
  return impl_->guarded<PlanResponse>([&] { return ask_plan(impl_->session, request); });
}

OccupancyAnswer Client::occupancy(const OccupancyBatch& batch) {
  return impl_->guarded<OccupancyAnswer>([&] { return ask_occupancy(impl_->session, batch); });
}

DaemonStatus Client::status(double timeout_s) {
  return impl_->guarded<DaemonStatus>(
      [&] { return impl_->session.next_heartbeat(after(timeout_s)); });
}

}  // namespace camway
