// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "lcmtypes/wire/check.h"
#include "tests/service/running_service.h"
#include "tests/support/temporary_folder.h"

/// Requests for tests of the scene service, and a sender of many.
namespace camway::service::testing_scenes {

inline scene_request_t request_for(std::int64_t id, std::int8_t operation, const std::string& scene,
                                   const std::string& object = "") {
  scene_request_t request{};
  request.client_id = "tester";
  request.request_id = id;
  request.operation = operation;
  request.scene = scene;
  request.object = object;
  return request;
}

inline scene_request_t put_box(std::int64_t id, const std::string& scene, const std::string& object,
                               double side_m = 1.0) {
  scene_request_t request = request_for(id, scene_request_t::PUT, scene, object);
  request.kind = scene_request_t::BOX;
  for (double& side : request.size_m) side = side_m;
  return request;
}

inline ServiceConfig with_root(const testing::TemporaryFolder& folder, int scene_workers) {
  ServiceConfig config;
  config.scene_rules.roots = *SceneRoots::make({folder.path()});
  config.scene_workers = scene_workers;
  return config;
}

/// Sends changes without waiting for their answers.
class Sender {
 public:
  explicit Sender(testing::RunningService& running) : running_(running) {}

  void send(const scene_request_t& request) {
    running_.send_on(running_.channels.scene_request(), wire::encode(request));
  }
  /// Returns the answer to a request, skipping others before it; nothing if none comes.
  std::optional<scene_response_t> answer_to(const scene_request_t& request) {
    const std::string channel = running_.channels.scene_response(request.client_id);
    for (std::size_t seen = 0;; ++seen) {
      const auto bytes = running_.transport.message_on(channel, seen);
      if (!bytes) return std::nullopt;
      const auto decoded = wire::decode<scene_response_t>(*bytes);
      if (decoded.message && decoded.message->request_id == request.request_id) {
        return decoded.message;
      }
    }
  }
  [[nodiscard]] std::size_t answers(const std::string& client) const {
    return running_.transport.published_on(running_.channels.scene_response(client)).size();
  }

 private:
  testing::RunningService& running_;
};

}  // namespace camway::service::testing_scenes
