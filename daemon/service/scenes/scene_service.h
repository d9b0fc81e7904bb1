// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "daemon/service/core/answer_cache.h"
#include "daemon/service/core/core.h"
#include "daemon/service/scenes/map_exports.h"
#include "daemon/service/scenes/scene_config.h"
#include "daemon/service/scenes/scene_work.h"

namespace camway::service {

/// Lets clients look at scenes and change them. Threads of its own do the changes, so that planning
/// waits for no import of a large file: those of different scenes side by side, those of one scene
/// one after the other, so that two moves of one client do not overtake each other. Clients take
/// turns as for planning (`FairQueue`), and no client has all threads at a time, so that the
/// imports of one leave room for the moves of others. Who only looks is answered at once. The loop
/// thread calls everything here.
///
/// A change has a deadline from its receipt on, and may be called off: it is answered at once then,
/// whatever a worker is at, and changes nothing; unless it is in force already, and its answer on
/// the way.
///
/// A change that is asked for again, by its ids and content, is not made again: it gets the same
/// answer.
class SceneService {
 public:
  using Clock = Job::Clock;

  /// `core` and `scenes` must outlive the service.
  SceneService(Core& core, scene::SceneStore& scenes, const SceneConfig& config);

  /// A message on the scene request channel. Throws only for want of memory.
  void on_request(std::span<const std::uint8_t> message);

  /// A message on the channel that calls changes off. Throws only for want of memory.
  void on_cancel(std::span<const std::uint8_t> message);

  /// A message on the upload channel. Throws only for want of memory.
  void on_upload(std::span<const std::uint8_t> message);

  /// A message on the channel for missing pages of maps. Throws only for want of memory.
  void on_missing_map_pages(std::span<const std::uint8_t> message);

  /// Answers the changes whose deadline has come by `now`.
  void tick(Clock::time_point now);
  /// When there is something to do for that; the end of time if never.
  [[nodiscard]] Clock::time_point next_tick() const;

  /// Takes no more changes, and refuses all that are not in force yet.
  void close();
  /// Refuses what is not answered yet, and waits no longer for what was called off.
  void give_up();
  /// How many changes wait, are being made, though they may have been called off, or were just made
  /// and are not answered yet.
  [[nodiscard]] std::size_t unfinished() const { return unanswered_.size() + left_behind_.size(); }
  /// Calls off what can be, and waits for what is being done. Before `Core` goes.
  void stop();

 private:
  using Request = std::shared_ptr<const scene_request_t>;
  /// A change that is not answered yet.
  struct Pending {
    Request request;
    scene::Undertaking undertaking;
    Clock::time_point deadline;
  };

  void refuse_malformed(const wire::Sender& sender, std::string_view reason);
  /// `refuse_malformed`, for `Core::read`.
  auto refusing() {
    return [this](const wire::Sender& sender, std::string_view reason) {
      refuse_malformed(sender, reason);
    };
  }
  void take_change(const Request& request);
  void begin(const Request& request);
  /// What a worker made of a change.
  void take_done(const Request& request, Performed done, const Pages& map);
  /// Calls a change off, whoever is at it; false if it is in force already.
  bool call_off(const Pending& pending);
  void finish(const scene_request_t& request, scene_response_t answer);
  void refuse(const scene_request_t& request, Refusal why);
  /// Of a change that is answered.
  void forget(const RequestKey& key);
  Pages send(scene_response_t answer);
  [[nodiscard]] SceneContext context(const scene::Undertaking& undertaking);

  Core& core_;
  scene::SceneStore& scenes_;
  const SceneConfig config_;
  Uploads uploads_;
  MapExports exports_;
  AnswerCache cache_;
  std::map<RequestKey, Pending> unanswered_;
  std::set<std::pair<Clock::time_point, RequestKey>> deadlines_;  ///< of those, till they come
  std::set<Request> left_behind_;  ///< called off and answered, but a worker is still at it
  std::mutex writing_;             ///< see `SceneContext`
  WorkerPool workers_;
};

}  // namespace camway::service
