// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <stop_token>
#include <string_view>

#include "daemon/service/core.h"
#include "daemon/service/map_exports.h"
#include "daemon/service/scene_work.h"

namespace camway::service {

/// Lets clients look at scenes and change them. Threads of its own do the changes, so that planning
/// waits for no import of a large file: those of different scenes side by side, those of one scene
/// one after the other, so that two moves of one client do not overtake each other. Clients take
/// turns as for planning (`FairQueue`), and no client has all threads at a time, so that the
/// imports of one leave room for the moves of others. Who only looks is answered at once. The loop
/// thread calls everything here.
///
/// A change that is asked for again, by its ids and content, is not made again: it gets the same
/// answer.
class SceneService {
 public:
  /// Both must outlive the service.
  SceneService(Core& core, scene::SceneStore& scenes);

  /// A message on the scene request channel. Throws only for want of memory.
  void on_request(std::span<const std::uint8_t> message);

  /// A message on the upload channel. Throws only for want of memory.
  void on_upload(std::span<const std::uint8_t> message);

  /// A message on the channel for missing pages of maps. Throws only for want of memory.
  void on_missing_map_pages(std::span<const std::uint8_t> message);

  /// Takes no more changes, and refuses those that nobody has begun, and those that read a file or
  /// make an occupancy mirror, which is called off.
  void close();
  /// Refuses what is still being done, which nobody will hear of any more.
  void give_up();
  /// How many changes wait, are being made, or were just made and are not answered yet.
  [[nodiscard]] std::size_t unanswered() const { return unanswered_.size(); }
  /// Calls off what can be, and waits for what is being done. Before `Core` goes.
  void stop();

 private:
  void begin(const std::shared_ptr<const scene_request_t>& request);
  void finish(const scene_request_t& request, scene_response_t answer);
  void refuse(const scene_request_t& request, Refusal why);
  void refuse_malformed(std::span<const std::uint8_t> message, std::string_view reason);
  Pages send(scene_response_t answer);
  [[nodiscard]] SceneContext context();

  Core& core_;
  scene::SceneStore& scenes_;
  const SceneRules rules_;
  Uploads uploads_;
  MapExports exports_;
  AnswerCache cache_;
  std::map<RequestKey, std::shared_ptr<const scene_request_t>> unanswered_;
  std::mutex writing_;  ///< see `SceneContext`
  std::stop_source stop_;
  WorkerPool workers_;
};

}  // namespace camway::service
