// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "daemon/service/core.h"
#include "daemon/service/map_exports.h"
#include "daemon/service/scene_work.h"

namespace camway::service {

/// Lets clients look at scenes and change them. One thread of its own does the changes, in the
/// order in which they came, so that neither planning waits for the import of a large file nor two
/// moves of one client overtake each other. The loop thread calls everything here.
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

  /// Takes no more changes, and refuses those that nobody has begun.
  void close();
  /// Whether nothing is being done.
  [[nodiscard]] bool idle() const { return thread_.running() == 0; }
  /// Waits for what is being done. Before `Core` goes.
  void stop() { thread_.stop(); }

 private:
  void begin(const std::shared_ptr<const scene_request_t>& request);
  void finish(const scene_request_t& request, scene_response_t answer);
  void refuse(const scene_request_t& request, Refusal why);
  void refuse_malformed(std::span<const std::uint8_t> message, std::string_view reason);
  Pages send(scene_response_t answer);

  Core& core_;
  scene::SceneStore& scenes_;
  const SceneRules rules_;
  Uploads uploads_;
  MapExports exports_;
  AnswerCache cache_;
  WorkerPool thread_;
};

}  // namespace camway::service
