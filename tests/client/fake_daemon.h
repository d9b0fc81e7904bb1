// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <camway/cancel_t.hpp>
#include <camway/missing_pages_t.hpp>
#include <camway/occupancy_request_t.hpp>
#include <camway/occupancy_response_t.hpp>
#include <camway/plan_request_t.hpp>
#include <camway/plan_response_t.hpp>
#include <camway/scene_request_t.hpp>
#include <camway/status_t.hpp>
#include <lcm/lcm-cpp.hpp>

#include "lcmtypes/wire/channels.h"
#include "lcmtypes/wire/check.h"

namespace camway::testing_support {

using Bytes = std::vector<std::uint8_t>;

/// A stand-in for a daemon that answers by the scripts of a test. It calls the scripts on a thread
/// of its own until it is destroyed, so declare it after everything that the scripts use.
class FakeDaemon {
 public:
  using PlanScript = std::function<std::vector<Bytes>(const plan_request_t&)>;
  using CancelScript = std::function<std::vector<Bytes>(const cancel_t&)>;
  using MissingScript = std::function<std::vector<Bytes>(const missing_pages_t&)>;
  using SceneScript = std::function<std::vector<Bytes>(const scene_request_t&)>;
  using OccupancyScript = std::function<std::vector<Bytes>(const occupancy_request_t&)>;

  PlanScript on_plan;
  CancelScript on_cancel;    ///< answers on the channel for plan responses
  MissingScript on_missing;  ///< answers on the channel for plan responses
  OccupancyScript on_occupancy;
  CancelScript on_cancel_occupancy;
  SceneScript on_scene;
  CancelScript on_cancel_scene;
  MissingScript on_missing_map;  ///< answers on the channel for pages of exports
  /// Period of heartbeats; 0: none.
  std::chrono::milliseconds heartbeat_every{0};
  double uptime_s = 1000.0;
  /// Bytes to send in place of a heartbeat, if not empty.
  Bytes raw_heartbeat;

  ~FakeDaemon() { stop(); }

  /// Subscribes and starts the thread.
  void start() {
    lcm_.subscribeFunction(channels_.plan_request(), &FakeDaemon::take_plan, this);
    lcm_.subscribeFunction(channels_.cancel(), &FakeDaemon::take_cancel, this);
    lcm_.subscribeFunction(channels_.missing_pages(), &FakeDaemon::take_missing, this);
    lcm_.subscribeFunction(channels_.occupancy_request(), &FakeDaemon::take_occupancy, this);
    lcm_.subscribeFunction(channels_.cancel_occupancy(), &FakeDaemon::take_cancel_occupancy, this);
    lcm_.subscribeFunction(channels_.scene_request(), &FakeDaemon::take_scene, this);
    lcm_.subscribeFunction(channels_.cancel_scene(), &FakeDaemon::take_cancel_scene, this);
    lcm_.subscribeFunction(channels_.missing_map_pages(), &FakeDaemon::take_missing_map, this);
    running_ = true;
    thread_ = std::thread([this] { run(); });
  }

  void stop() {
    running_ = false;
    if (thread_.joinable()) thread_.join();
  }

  /// Publishes a message. Call it from a script, or while the daemon does not run.
  void publish(const std::string& channel, const Bytes& bytes) {
    lcm_.publish(channel, bytes.data(), static_cast<unsigned>(bytes.size()));
    // A pause like the daemon's: large messages back to back overrun the receiver's socket buffer.
    if (bytes.size() > kLarge) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  const std::vector<plan_request_t>& plan_requests() const { return plan_requests_; }

 private:
  static void take_plan(const lcm::ReceiveBuffer* buffer, const std::string&, FakeDaemon* self) {
    const auto decoded = wire::decode<plan_request_t>(
        {static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
    if (!decoded.message) return;
    self->plan_requests_.push_back(*decoded.message);
    if (!self->on_plan) return;
    for (const Bytes& bytes : self->on_plan(*decoded.message)) {
      self->publish(self->channels_.plan_response(decoded.message->client_id), bytes);
    }
  }

  template <class Message, class Script>
  void answer(const lcm::ReceiveBuffer* buffer, const Script& script) {
    const auto decoded =
        wire::decode<Message>({static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
    if (!decoded.message || !script) return;
    for (const Bytes& bytes : script(*decoded.message)) {
      publish(channels_.plan_response(decoded.message->client_id), bytes);
    }
  }

  static void take_cancel(const lcm::ReceiveBuffer* buffer, const std::string&, FakeDaemon* self) {
    self->answer<cancel_t>(buffer, self->on_cancel);
  }

  static void take_missing(const lcm::ReceiveBuffer* buffer, const std::string&, FakeDaemon* self) {
    self->answer<missing_pages_t>(buffer, self->on_missing);
  }

  static void take_cancel_occupancy(const lcm::ReceiveBuffer* buffer, const std::string&,
                                    FakeDaemon* self) {
    const auto decoded =
        wire::decode<cancel_t>({static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
    if (!decoded.message || !self->on_cancel_occupancy) return;
    for (const Bytes& bytes : self->on_cancel_occupancy(*decoded.message)) {
      self->publish(self->channels_.occupancy_response(decoded.message->client_id), bytes);
    }
  }

  static void take_cancel_scene(const lcm::ReceiveBuffer* buffer, const std::string&,
                                FakeDaemon* self) {
    self->answer_scene<cancel_t>(buffer, self->on_cancel_scene);
  }

  static void take_missing_map(const lcm::ReceiveBuffer* buffer, const std::string&,
                               FakeDaemon* self) {
    const auto decoded = wire::decode<missing_pages_t>(
        {static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
    if (!decoded.message || !self->on_missing_map) return;
    for (const Bytes& bytes : self->on_missing_map(*decoded.message)) {
      self->publish(self->channels_.map_page(decoded.message->client_id), bytes);
    }
  }

  static void take_scene(const lcm::ReceiveBuffer* buffer, const std::string&, FakeDaemon* self) {
    self->answer_scene<scene_request_t>(buffer, self->on_scene);
  }

  template <class Message, class Script>
  void answer_scene(const lcm::ReceiveBuffer* buffer, const Script& script) {
    const auto decoded =
        wire::decode<Message>({static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
    if (!decoded.message || !script) return;
    for (const Bytes& bytes : script(*decoded.message)) {
      publish(channels_.scene_response(decoded.message->client_id), bytes);
    }
  }

  static void take_occupancy(const lcm::ReceiveBuffer* buffer, const std::string&,
                             FakeDaemon* self) {
    const auto decoded = wire::decode<occupancy_request_t>(
        {static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
    if (!decoded.message || !self->on_occupancy) return;
    for (const Bytes& bytes : self->on_occupancy(*decoded.message)) {
      self->publish(self->channels_.occupancy_response(decoded.message->client_id), bytes);
    }
  }

  void run() {
    using Clock = std::chrono::steady_clock;
    Clock::time_point next_heartbeat = Clock::now();
    while (running_) {
      lcm_.handleTimeout(5);
      if (heartbeat_every.count() == 0 || Clock::now() < next_heartbeat) continue;
      next_heartbeat = Clock::now() + heartbeat_every;
      status_t status{};
      status.version = "fake";
      status.uptime_s = uptime_s;
      publish(channels_.status(), raw_heartbeat.empty() ? wire::encode(status) : raw_heartbeat);
    }
  }

  static constexpr std::size_t kLarge = 20'000;

  wire::Channels channels_;
  lcm::LCM lcm_;
  std::atomic<bool> running_ = false;
  std::thread thread_;
  std::vector<plan_request_t> plan_requests_;
};

/// Returns the pages of an answer to `request`, whose path has `segments` segments of one second,
/// `per_page` on each page.
std::vector<plan_response_t> answer_pages(const plan_request_t& request, int segments,
                                          int per_page);

std::vector<Bytes> encode_all(const std::vector<plan_response_t>& pages);

}  // namespace camway::testing_support
