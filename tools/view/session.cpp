// SPDX-License-Identifier: MIT
#include "tools/view/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

namespace camway::view {
namespace {

using Id = std::int64_t;

/// A conversation. Kept by the socket and by what is under way. Thread-safe: messages come on the
/// server's thread, answers on threads of the backend.
class Session : public std::enable_shared_from_this<Session> {
 public:
  Session(std::shared_ptr<Desk> desk, std::shared_ptr<http::Socket> socket)
      : desk_(std::move(desk)), socket_(std::move(socket)) {}

  void received(const std::string& text);
  /// Cancels what is under way. Nothing is sent from now on.
  void end();

 private:
  /// Something under way. It has no job yet while the backend is being asked.
  struct Open {
    Desk::Place place = nullptr;  ///< set for a plan or a check
    std::string drag = {};
    std::shared_ptr<Job> job = nullptr;
    std::unique_ptr<Watch> watch = nullptr;
    bool may_finish = false;
    bool is_cancelled = false;
    bool is_superseded = false;
  };
  /// The requests of a drag: one is under way, and the latest one may wait.
  struct Waiting {
    Id id = 0;
    Message::Plan plan;
    Desk::Place place;
  };
  struct Drag {
    Id current = 0;
    std::optional<Waiting> next = std::nullopt;
  };

  void take(Id id, Message::Plan plan);
  void take(Id id, CheckOrder order);
  void take(Id id, SceneOrder order);
  void take(Id id, Message::Watch watch);
  void take(Id id, Message::Unwatch);
  void take(Id id, Message::Cancel);
  void take(Id id, Message::Status);
  void take(Id id, Message::Version);
  void take(Id id, Message::Fields);
  void take(Id id, Message::Last);
  void take(Id id, Message::Interpolate interpolate);
  void take(Id id, TrianglesOrder order);

  /// Has the backend plan. Requires that the id was entered.
  void ask(Id id, Message::Plan plan);
  /// Enters the id of a message without a drag, or sends why that is not possible.
  bool open(Id id, bool is_plan = false);
  void set_job(Id id, std::shared_ptr<Job> job);
  /// Sends the answer of a plan, and begins the next one of its drag.
  void end_plan(Id id, const Answer& answer);
  /// Returns a function that sends the answer to a message other than a plan.
  Done answer_to(Id id);

  // These require the lock.

  /// Answers a plan that waits for one of its drag, and drops it. Returns whether the id is one.
  bool drop_waiting(Id id);
  [[nodiscard]] bool is_taken(Id id) const;
  /// Returns why no message with this id can be answered; nothing if one can.
  [[nodiscard]] std::optional<Answer> why_not(Id id) const;
  /// Takes a place for a plan or a check, or returns why there is none.
  [[nodiscard]] base::Result<Desk::Place> take_place();
  /// Enters an id that is free, as the one under way of its drag if it has one.
  void enter(Id id, Desk::Place place, const Message::Plan& plan);
  void send(std::string text);
  void send_field(Id id, std::string_view name, std::string_view json);
  void send_answer(Id id, const Answer& answer);
  void send_error(Id id, int code, std::string_view error);
  [[nodiscard]] int plans() const;

  const std::shared_ptr<Desk> desk_;
  const std::shared_ptr<http::Socket> socket_;
  mutable std::mutex mutex_;  ///< guards what is below; not held while the backend is asked
  bool has_ended_ = false;
  std::map<Id, Open> open_;
  std::map<std::string, Drag, std::less<>> drags_;
};

void Session::received(const std::string& text) {
  std::variant<Message, BadMessage> read = read_message(text);
  if (const auto* const bad = std::get_if<BadMessage>(&read)) {
    const std::optional<Answer> refusal = bad->is_change ? desk_->refuse_change() : std::nullopt;
    const Answer fault = refusal.value_or(failure(code::kInvalid, bad->error));
    const std::lock_guard lock(mutex_);
    send(fmt::format("{{\"id\": {}, {}, \"code\": {}}}",
                     bad->id ? std::to_string(*bad->id) : "null",
                     error_members(fault.code, fault.error), fault.code));
    return;
  }
  Message& message = std::get<Message>(read);
  std::visit([&](auto& what) { take(message.id, std::move(what)); }, message.what);
}

void Session::end() {
  std::map<Id, Open> open;
  {
    const std::lock_guard lock(mutex_);
    has_ended_ = true;
    open.swap(open_);
    drags_.clear();
  }
  for (const auto& [id, each] : open) {
    if (each.job) each.job->cancel();
  }
}

bool Session::is_taken(Id id) const {
  return open_.contains(id) || std::ranges::any_of(drags_, [id](const auto& drag) {
           return drag.second.next && drag.second.next->id == id;
         });
}

int Session::plans() const {
  const auto running =
      std::ranges::count_if(open_, [](const auto& each) { return each.second.place != nullptr; });
  const auto waiting =
      std::ranges::count_if(drags_, [](const auto& each) { return each.second.next.has_value(); });
  return static_cast<int>(running + waiting);
}

std::optional<Answer> Session::why_not(Id id) const {
  if (has_ended_) return failure(code::kCancelled, "the conversation has ended");
  if (is_taken(id)) {
    return failure(code::kInvalid, "the id is one of a message that has no answer yet");
  }
  if (open_.size() < static_cast<std::size_t>(desk_->limits().open)) return std::nullopt;
  return failure(code::kTooMany,
                 fmt::format("too many at a time: at most {} messages without an answer",
                             desk_->limits().open));
}

bool Session::open(Id id, bool is_plan) {
  const std::lock_guard lock(mutex_);
  if (const auto fault = why_not(id)) {
    send_error(id, fault->code, fault->error);
    return false;
  }
  Desk::Place place;
  if (is_plan) {
    base::Result<Desk::Place> taken = take_place();
    if (!taken) {
      send_error(id, code::kTooMany, taken.error);
      return false;
    }
    place = *std::move(taken);
  }
  enter(id, std::move(place), {});
  return true;
}

base::Result<Desk::Place> Session::take_place() {
  if (plans() >= desk_->limits().plans) {
    return base::Failure{
        fmt::format("too many at a time: at most {} plans", desk_->limits().plans)};
  }
  Desk::Place place = desk_->take_place();
  if (place) return place;
  return base::Failure{fmt::format("too many at a time: at most {} plans of all clients together",
                                   desk_->limits().all_plans)};
}

void Session::enter(Id id, Desk::Place place, const Message::Plan& plan) {
  open_[id] = Open{.place = std::move(place), .drag = plan.drag, .may_finish = plan.may_finish};
  if (!plan.drag.empty()) drags_[plan.drag].current = id;
}

void Session::take(Id id, Message::Plan plan) {
  std::shared_ptr<Job> older;
  {
    const std::lock_guard lock(mutex_);
    if (const auto fault = why_not(id)) return send_error(id, fault->code, fault->error);
    const auto drag = drags_.find(plan.drag);
    const bool waits = !plan.drag.empty() && drag != drags_.end();
    const bool replaces = waits && drag->second.next;
    base::Result<Desk::Place> place = replaces ? std::move(drag->second.next->place) : take_place();
    if (!place) return send_error(id, code::kTooMany, place.error);
    if (!waits) {
      enter(id, *std::move(place), plan);
    } else {
      if (replaces) send_field(drag->second.next->id, "superseded", "true");
      drag->second.next = Waiting{id, std::move(plan), *std::move(place)};
      Open& current = open_.at(drag->second.current);
      if (current.may_finish) return;
      current.is_superseded = true;
      current.is_cancelled = true;
      older = current.job;
      if (!older) return;
    }
  }
  if (older) return older->cancel();
  ask(id, std::move(plan));
}

void Session::ask(Id id, Message::Plan plan) {
  const std::shared_ptr<Session> self = shared_from_this();
  Tell progress;
  if (plan.wants_progress) {
    progress = [self, id](const std::string& json) {
      const std::lock_guard lock(self->mutex_);
      const auto found = self->open_.find(id);
      if (found == self->open_.end() || found->second.is_superseded) return;
      self->send_field(id, "progress", json);
    };
  }
  set_job(id,
          desk_->backend().plan(desk_->in_scene(std::move(plan.order)), std::move(progress),
                                [self, id](const Answer& answer) { self->end_plan(id, answer); }));
}

void Session::set_job(Id id, std::shared_ptr<Job> job) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = open_.find(id);
    // Without an entry, it has ended already, or the conversation has.
    if (found != open_.end()) found->second.job = job;
    if (found != open_.end() ? !found->second.is_cancelled : !has_ended_) return;
  }
  if (job) job->cancel();
}

void Session::end_plan(Id id, const Answer& answer) {
  std::optional<Waiting> next;
  {
    const std::lock_guard lock(mutex_);
    const auto found = open_.find(id);
    if (found == open_.end()) return;
    const Open ended = std::move(found->second);
    open_.erase(found);
    if (ended.is_superseded) {
      send_field(id, "superseded", "true");
    } else {
      send_answer(id, answer);
    }
    const auto drag = drags_.find(ended.drag);
    if (!ended.drag.empty() && drag != drags_.end()) {
      next = std::move(drag->second.next);
      drags_.erase(drag);
      // Entered at once, so that no other one of the drag can begin beside it.
      if (next) enter(next->id, std::move(next->place), next->plan);
    }
  }
  if (next) ask(next->id, std::move(next->plan));
}

Done Session::answer_to(Id id) {
  return [self = shared_from_this(), id](const Answer& answer) {
    const std::lock_guard lock(self->mutex_);
    if (self->open_.erase(id) > 0) self->send_answer(id, answer);
  };
}

void Session::take(Id id, CheckOrder order) {
  if (!open(id, /*is_plan=*/true)) return;
  set_job(id, desk_->backend().check(desk_->in_scene(std::move(order)), answer_to(id)));
}

void Session::take(Id id, SceneOrder order) {
  if (open(id)) desk_->ask_scene(std::move(order), answer_to(id));
}

void Session::take(Id id, Message::Status) {
  if (open(id)) desk_->status(answer_to(id));
}

void Session::take(Id id, Message::Version) {
  const std::lock_guard lock(mutex_);
  send_answer(id, Desk::version());
}

void Session::take(Id id, Message::Fields) {
  const std::lock_guard lock(mutex_);
  send_answer(id, Desk::fields());
}

void Session::take(Id id, Message::Last) {
  const std::lock_guard lock(mutex_);
  send_answer(id, desk_->last());
}

void Session::take(Id id, Message::Interpolate interpolate) {
  if (!open(id, /*is_plan=*/true)) return;
  desk_->interpolate(std::move(interpolate.order), answer_to(id));
}

void Session::take(Id id, TrianglesOrder order) {
  if (open(id)) desk_->triangles(std::move(order), answer_to(id));
}

void Session::take(Id id, Message::Watch watch) {
  if (!open(id)) return;
  const auto tell = [self = shared_from_this(), id](const std::string& json) {
    const std::lock_guard lock(self->mutex_);
    if (self->open_.contains(id)) self->send_field(id, "event", json);
  };
  std::unique_ptr<Watch> begun =
      watch.order ? desk_->backend().watch_path(desk_->in_scene(*std::move(watch.order)), tell)
                  : desk_->backend().watch_scenes(tell);
  const std::lock_guard lock(mutex_);
  const auto found = open_.find(id);
  if (found == open_.end()) return;
  if (begun) {
    found->second.watch = std::move(begun);
    return;
  }
  open_.erase(found);
  send_error(id, code::kNotOffered, "paths are watched by a daemon only: camway view SCENE");
}

void Session::take(Id id, Message::Unwatch) {
  std::unique_ptr<Watch> ended;  // destroyed without the lock, since it may wait for an event
  const std::lock_guard lock(mutex_);
  const auto found = open_.find(id);
  if (found == open_.end() || !found->second.watch) {
    return send_error(id, code::kNotFound, "no watch has this id");
  }
  ended = std::move(found->second.watch);
  open_.erase(found);
  send_field(id, "ended", "true");
}

bool Session::drop_waiting(Id id) {
  for (auto& [name, drag] : drags_) {
    if (!drag.next || drag.next->id != id) continue;
    drag.next.reset();
    send_answer(id, failure(code::kCancelled, "cancelled"));
    return true;
  }
  return false;
}

void Session::take(Id id, Message::Cancel) {
  std::shared_ptr<Job> job;
  {
    const std::lock_guard lock(mutex_);
    if (drop_waiting(id)) return;
    const auto found = open_.find(id);
    // Its answer may be on the way: then nobody waits for another one.
    if (found == open_.end() || !found->second.place) return;
    found->second.is_cancelled = true;
    job = found->second.job;
  }
  if (job) job->cancel();
}

void Session::send(std::string text) {
  if (has_ended_ || socket_->send(std::move(text))) return;
  // A client that does not read cannot tell which answers are missing.
  has_ended_ = true;
  socket_->close();
}

void Session::send_field(Id id, std::string_view name, std::string_view json) {
  send(fmt::format("{{\"id\": {}, \"{}\": {}}}", id, name, json));
}

void Session::send_error(Id id, int code, std::string_view error) {
  send(fmt::format("{{\"id\": {}, {}, \"code\": {}}}", id, error_members(code, error), code));
}

void Session::send_answer(Id id, const Answer& answer) {
  if (answer.code == code::kOk) return send_field(id, "answer", answer.json);
  if (answer.code == code::kCancelled) return send_field(id, "cancelled", "true");
  send_error(id, answer.code, answer.error);
}

/// The socket's side of a conversation.
class Listener final : public http::SocketEvents {
 public:
  explicit Listener(std::shared_ptr<Session> session) : session_(std::move(session)) {}
  ~Listener() override { session_->end(); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;
  void received(std::string text) override { session_->received(text); }

 private:
  const std::shared_ptr<Session> session_;
};

}  // namespace

std::unique_ptr<http::SocketEvents> open_session(std::shared_ptr<Desk> desk,
                                                 std::shared_ptr<http::Socket> socket) {
  return std::make_unique<Listener>(std::make_shared<Session>(std::move(desk), std::move(socket)));
}

}  // namespace camway::view
