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
#include "daemon/service/scenes/scene_operation.h"

namespace camway::service {

/// Lets clients query and change scenes. Queries are answered at once. Changes run on threads of
/// their own, so that planning does not wait for the import of a large file. Changes of different
/// scenes run in parallel. Changes of one scene run one after the other, in the order of their
/// arrival for each client. Clients take turns as for planning (`FairQueue`). If there are several
/// threads, no client uses all of them, so that a long import of one client does not delay the
/// changes of others.
///
/// The deadline of a change counts from its receipt. A client can cancel a change. A change that is
/// cancelled, or whose deadline passes, is answered at once, even if a worker is still at it, and
/// changes nothing. A change that is committed cannot be cancelled any more: its answer is on the
/// way.
///
/// A change that is sent again, with equal ids and content, is not made again: it gets the same
/// answer.
///
/// Not thread-safe: for the loop thread.
class SceneService {
 public:
  using Clock = Job::Clock;

  /// Requires that `core` and `scenes` outlive the service.
  SceneService(Core& core, scene::SceneStore& scenes, const SceneConfig& config);

  /// Handles a message on the scene request channel. Throws only if memory runs out.
  void on_request(std::span<const std::uint8_t> message);

  /// Handles a message on the channel that cancels changes. Throws only if memory runs out.
  void on_cancel(std::span<const std::uint8_t> message);

  /// Handles a message on the upload channel. Throws only if memory runs out.
  void on_upload(std::span<const std::uint8_t> message);

  /// Handles a message on the channel for missing pages of maps. Throws only if memory runs out.
  void on_missing_map_pages(std::span<const std::uint8_t> message);

  /// Answers the changes whose deadline has passed by `now`.
  void tick(Clock::time_point now);
  /// Returns the time at which `tick` is due next; `time_point::max()` if there is none.
  [[nodiscard]] Clock::time_point next_tick() const;

  /// Accepts no more changes, and refuses all that are not committed yet.
  void close();
  /// Leaves the cancelled changes that a worker is still at, which `unfinished` no longer counts.
  /// Returns their number.
  std::size_t leave_cancelled();
  /// Answers the changes that are committed but not kept yet, of which nobody knows whether the
  /// next daemon has them. Call it after `close`, at the end of the daemon.
  void give_up();
  /// Returns the number of changes that wait, are being made (cancelled ones included), or are made
  /// and not answered yet.
  [[nodiscard]] std::size_t unfinished() const { return unanswered_.size() + left_behind_.size(); }
  /// Cancels all changes that are not committed, and waits for the workers. The owner must call it
  /// before it destroys `core`.
  void stop();

 private:
  using Request = std::shared_ptr<const scene_request_t>;
  /// A change that is not answered yet.
  struct Pending {
    Request request;
    scene::ChangeTicket ticket;
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
  /// Handles the result of a worker.
  void take_done(const Request& request, SceneReply done, const Pages& map);
  /// Cancels a change, wherever it is. Returns false if it is committed already.
  bool cancel_pending(const Pending& pending);
  void finish(const scene_request_t& request, scene_response_t answer);
  void refuse(const scene_request_t& request, Refusal why);
  /// Forgets a change that is answered.
  void forget(const RequestKey& key);
  Pages send(scene_response_t answer);
  [[nodiscard]] OperationContext context(const scene::ChangeTicket& ticket);

  Core& core_;
  scene::SceneStore& scenes_;
  const SceneConfig config_;
  Uploads uploads_;
  MapExports exports_;
  AnswerCache cache_;
  std::map<RequestKey, Pending> unanswered_;
  std::set<std::pair<Clock::time_point, RequestKey>> deadlines_;  ///< unanswered changes by time
  /// Changes that were cancelled and answered while a worker is still at them.
  std::set<Request> left_behind_;
  std::mutex writing_;  ///< see `OperationContext`
  WorkerPool workers_;
};

}  // namespace camway::service
