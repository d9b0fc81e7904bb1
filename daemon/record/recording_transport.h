// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/record/recorder.h"
#include "daemon/service/transport/transport.h"

namespace camway::record {

/// A transport that records the messages of another one as they are on the network.
/// Not thread-safe, except for `wake`: for the thread that owns the transport.
class RecordingTransport final : public service::Transport {
 public:
  /// Both must outlive this.
  RecordingTransport(service::Transport& inner, Recorder& recorder)
      : inner_(inner), recorder_(recorder) {}

  [[nodiscard]] bool subscribe(const std::string& channel, int queue_capacity,
                               Handler handler) override;
  [[nodiscard]] bool publish(const std::string& channel,
                             std::span<const std::uint8_t> message) override;
  [[nodiscard]] bool poll(std::chrono::milliseconds timeout) override {
    return inner_.poll(timeout);
  }
  void wake() noexcept override { inner_.wake(); }

 private:
  service::Transport& inner_;
  Recorder& recorder_;
};

}  // namespace camway::record
