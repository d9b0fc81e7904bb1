// SPDX-License-Identifier: MIT
#include "client/engine/ask_scene.h"

#include <algorithm>
#include <future>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include <camway/cancel_t.hpp>
#include <camway/map_page_t.hpp>
#include <camway/missing_pages_t.hpp>

#include "client/messages/scene.h"
#include "client/messages/text.h"
#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/checksum.h"
#include "lcmtypes/wire/layout.h"
#include "lcmtypes/wire/object_mesh.h"
#include "lcmtypes/wire/utime.h"

namespace camway {
namespace {

/// Pages of an upload, about 3 MB, that are sent before the daemon is asked which ones came.
constexpr std::size_t kPagesAtOnce = 64;

std::string explain(std::int32_t status, const std::string& message) {
  return to_string(static_cast<Status>(status)) + ": " +
         (message.empty() ? "(no reason given)" : message);
}

/// Time for the daemon to say what became of a request that is cancelled. It answers at once,
/// whatever its workers do.
constexpr double kCancelWait_s = 1.0;

Failure cancelled() { return {Status::kCancelled, "cancelled before anything was changed"}; }

/// The answer to one request, or the reason why there is none.
template <class Response>
struct Asked {
  std::optional<Response> response;
  Failure failure{Status::kOk, {}};
};

/// A pending request that one message answers.
template <class Response>
class OneAnswer final : public Call {
 public:
  OneAnswer(Kind kind, Context& context, std::int64_t request_id, std::vector<Outgoing> messages,
            Clock::time_point deadline)
      : Call(kind, request_id, std::move(messages), context.retry(deadline)), context_(context) {}

  std::future<Asked<Response>> answer() { return promise_.get_future(); }

  void take_answer(std::span<const std::uint8_t> bytes, Clock::time_point now) override {
    wire::Decoded<Response> decoded = wire::decode<Response>(bytes);
    if (!decoded.message) {
      fault_ = decoded.fault.text(Response::getTypeName());
      return;
    }
    if (decoded.message->client_id != context_.options().client_id) return;
    retry().note_life();
    const auto status = static_cast<Status>(decoded.message->status);
    if (status == Status::kOverloaded || status == Status::kStopping) {
      refusal_ = {status, explain(decoded.message->status, decoded.message->message)};
      if (status == Status::kStopping) retry().note_stopping(now);
      return;
    }
    response_ = std::move(*decoded.message);
  }
  bool answered() const override { return response_.has_value() || ends_; }
  void cancel() override {
    // An upload keeps no worker busy, so there is nothing to cancel at the daemon.
    ends_ = kind() != Kind::kScene;
    if (ends_ || std::exchange(is_cancelled_, true)) return;
    cancel_t message{};
    message.client_id = context_.options().client_id;
    message.request_id = request_id();
    message.utime = wire::utime_now();
    replace_request_messages({{context_.channels().cancel_scene(), wire::encode(message)}});
    retry().restart_within(kCancelWait_s, Clock::now());
  }
  void finish(Outcome outcome) override {
    Asked<Response> asked{std::move(response_), {Status::kOk, {}}};
    if (outcome == Outcome::kAnswered && !asked.response) {
      asked.failure = cancelled();
    } else if (outcome != Outcome::kAnswered) {
      asked.failure = failure_of(outcome);
    }
    promise_.set_value(std::move(asked));
  }

 private:
  /// Returns why there is no answer.
  Failure failure_of(Outcome outcome) const {
    const bool is_late = outcome == Outcome::kDeadline || outcome == Outcome::kSilence;
    if (is_late && refusal_) return *refusal_;
    Failure failure = context_.explain(outcome, retry().ever_heard(), {}, fault_);
    if (is_late && is_cancelled_) {
      // The request may wait at a daemon that is busy.
      failure.error = "cancelled, but no daemon says what became of it: " + failure.error;
    }
    return failure;
  }

  Context& context_;
  std::optional<Response> response_;
  std::optional<Failure> refusal_;
  std::string fault_;
  bool ends_ = false;          ///< whether the call ends without an answer
  bool is_cancelled_ = false;  ///< whether the daemon was told to cancel
  std::promise<Asked<Response>> promise_;
};

/// One call about scenes, which may send several requests in turn.
class Asker {
 public:
  explicit Asker(const SceneAsker& asker)
      : context(asker.context),
        engine(asker.engine),
        deadline(after(asker.context.options().deadline_s)),
        cancel_(asker.cancel),
        cancels_(asker.cancel.count()) {}

  Context& context;
  Engine& engine;
  const Clock::time_point deadline;

  template <class Response>
  Asked<Response> ask(Call::Kind kind, std::int64_t request_id,
                      std::vector<Outgoing> messages) const {
    if (is_cancelled()) return {std::nullopt, cancelled()};
    const auto call = std::make_shared<OneAnswer<Response>>(kind, context, request_id,
                                                            std::move(messages), deadline);
    std::future<Asked<Response>> answer = call->answer();
    start(call);
    return answer.get();
  }

  /// Returns whether calls about scenes were cancelled since this one began.
  bool is_cancelled() const { return cancel_.count() != cancels_; }

  /// Starts a request and lets a cancel end it.
  void start(const std::shared_ptr<Call>& call) const {
    engine.start(call);
    // A cancel that came before the start did not find the request.
    if (is_cancelled()) engine.cancel(call->kind(), call->request_id());
  }

 private:
  const SceneCancel& cancel_;
  const std::uint64_t cancels_;
};

/// Sends some pages, then asks which ones are missing.
Asked<upload_status_t> ask_upload(const Asker& asker, const std::vector<std::uint8_t>& bytes,
                                  std::int64_t checksum, const std::vector<std::int32_t>& pages) {
  const std::int64_t request_id = asker.context.new_request_id();
  std::vector<Outgoing> messages;
  const auto add = [&](std::int32_t page) {
    upload_page_t message = page_of(bytes, checksum, page);
    message.client_id = asker.context.options().client_id;
    message.request_id = request_id;
    messages.push_back({asker.context.channels().upload(), wire::encode(message)});
  };
  for (const std::int32_t page : pages) add(page);
  add(-1);
  return asker.ask<upload_status_t>(Call::Kind::kUpload, request_id, std::move(messages));
}

/// The result of an upload.
struct Uploaded {
  bool was_there = false;  ///< whether the daemon had all of it before anything was sent
  std::optional<Failure> failure;
};

/// Sends missing pages until the daemon has all of them.
Uploaded upload(const Asker& asker, const std::vector<std::uint8_t>& bytes) {
  const std::int64_t checksum = wire::crc64(bytes.data(), bytes.size());
  std::vector<std::int32_t> pages;  // none at first: the daemon may have some
  for (;;) {
    const Asked<upload_status_t> asked = ask_upload(asker, bytes, checksum, pages);
    if (!asked.response) return {false, asked.failure};
    const upload_status_t& status = *asked.response;
    if (status.status != upload_status_t::STATUS_OK) {
      return {false, Failure{static_cast<Status>(status.status),
                             "upload: " + explain(status.status, status.message)}};
    }
    if (status.total_missing == 0) return {pages.empty(), std::nullopt};
    if (Clock::now() >= asker.deadline) {
      return {false, Failure{Status::kNoAnswer,
                             "the upload was not complete by the deadline; ask again to "
                             "go on, or wait longer"}};
    }
    pages.assign(status.missing.begin(),
                 status.missing.begin() +
                     static_cast<std::ptrdiff_t>(std::min(kPagesAtOnce, status.missing.size())));
  }
}

Asked<scene_response_t> ask_once(const Asker& asker, scene_request_t request) {
  request.client_id = asker.context.options().client_id;
  request.request_id = asker.context.new_request_id();
  request.utime = wire::utime_now();
  request.deadline_s = asker.context.options().change_deadline_s;
  return asker.ask<scene_response_t>(
      Call::Kind::kScene, request.request_id,
      {{asker.context.channels().scene_request(), wire::encode(request)}});
}

SceneAnswer answer_of(const Asked<scene_response_t>& asked) {
  if (!asked.response) return failed<SceneAnswer>(asked.failure);
  const scene_response_t& response = *asked.response;
  SceneAnswer answer;
  answer.status = static_cast<Status>(response.status);
  convert(response.daemon_start, answer.daemon_start);
  if (!answer.ok()) {
    answer.error = explain(response.status, response.message);
    return answer;
  }
  answer.message = response.message;
  convert(response.scene, answer.scene);
  convert(response.scenes, answer.scenes);
  convert(response.objects, answer.objects);
  convert(response.changes, answer.revisions);
  return answer;
}

/// Returns the fault of a request that cannot be sent, or nothing.
std::optional<std::string> fault_in_form(const scene_request_t& request) {
  for (const auto& fault :
       {fault_in_text("scene", request.scene, wire::kMaxSceneNameBytes),
        fault_in_text("object", request.object, wire::kMaxObjectNameBytes),
        fault_in_text("digest", request.digest, wire::kMaxDigestBytes),
        fault_in_text("restore_as", request.restore_as, wire::kMaxSceneNameBytes),
        fault_in_text("file", request.file, wire::kMaxFileNameBytes),
        fault_in_text("format", request.upload_format, wire::kMaxFormatBytes)}) {
    if (fault) return fault;
  }
  return std::nullopt;
}

}  // namespace

void SceneCancel::cancel(Engine& engine) {
  ++count_;
  for (const Call::Kind kind : {Call::Kind::kScene, Call::Kind::kUpload, Call::Kind::kMap}) {
    engine.cancel_all(kind);
  }
}

SceneAnswer ask_scene(const SceneAsker& with, scene_request_t request,
                      const std::vector<std::uint8_t>& bytes) {
  if (const auto fault = fault_in_form(request)) {
    return failed<SceneAnswer>({Status::kInvalid, *fault});
  }
  const Asker asker(with);
  if (bytes.empty()) return answer_of(ask_once(asker, std::move(request)));
  SceneAnswer answer;
  // Between upload and request the daemon may restart, or drop the upload in favour of others.
  for (int restart = 0; restart <= kMaxRestarts; ++restart) {
    Uploaded uploaded = upload(asker, bytes);
    if (uploaded.failure) return failed<SceneAnswer>(*std::move(uploaded.failure));
    if (restart > 0 && uploaded.was_there) return answer;
    answer = answer_of(ask_once(asker, request));
    if (answer.status != Status::kInvalid) return answer;
  }
  return answer;
}

namespace {

/// A pending request for pages of a map.
class MapPages final : public Call {
 public:
  MapPages(Context& context, std::int64_t request_id, std::int32_t num_pages,
           const std::vector<std::int32_t>& wanted, Clock::time_point deadline)
      : Call(Kind::kMap, request_id, {}, context.retry(deadline)),
        context_(context),
        num_pages_(num_pages),
        wanted_(wanted.begin(), wanted.end()) {
    replace_request_messages(missing());
  }

  /// The pages that came, or the reason why some did not.
  struct Came {
    std::vector<map_page_t> pages;
    Failure failure{Status::kOk, {}};
  };
  std::future<Came> answer() { return promise_.get_future(); }

  void take_answer(std::span<const std::uint8_t> bytes, Clock::time_point now) override {
    wire::Decoded<map_page_t> decoded = wire::decode<map_page_t>(bytes);
    if (!decoded.message) {
      fault_ = decoded.fault.text("map_page_t");
      return;
    }
    map_page_t& page = *decoded.message;
    if (page.client_id != context_.options().client_id) return;
    retry().note_life();
    if (page.status != map_page_t::STATUS_OK) {
      refusal_ = page.message;
    } else if (page.num_pages != num_pages_ ||
               wire::crc64(page.bytes.data(), page.bytes.size()) != page.page_checksum) {
      fault_ = "map_page_t: is damaged";
    } else if (wanted_.erase(page.page) == 1) {
      retry().note_part(now);
      came_.pages.push_back(std::move(page));
    }
  }
  bool answered() const override { return wanted_.empty() || refusal_.has_value() || ends_; }
  void cancel() override { ends_ = true; }
  std::vector<Outgoing> missing() const override {
    missing_pages_t message{};
    message.client_id = context_.options().client_id;
    message.request_id = request_id();
    message.utime = wire::utime_now();
    message.num_pages = num_pages_;
    message.missing.assign(wanted_.begin(), wanted_.end());
    message.num_missing = static_cast<std::int32_t>(message.missing.size());
    return {{context_.channels().missing_map_pages(), wire::encode(message)}};
  }
  void finish(Outcome outcome) override {
    if (outcome != Outcome::kAnswered) {
      came_.failure = context_.explain(outcome, retry().ever_heard(), {}, fault_);
    } else if (refusal_) {
      came_.failure = {Status::kInvalid, *refusal_};
    } else if (!wanted_.empty()) {
      came_.failure = cancelled();
    }
    promise_.set_value(std::move(came_));
  }

 private:
  Context& context_;
  std::int32_t num_pages_;
  std::set<std::int32_t> wanted_;
  Came came_;
  std::optional<std::string> refusal_;
  std::string fault_;
  bool ends_ = false;  ///< whether the call ends without the pages
  std::promise<Came> promise_;
};

/// The fetched bytes, or the reason why there are none.
struct Exported {
  Failure failure{Status::kOk, {}};
  SceneAnswer answer;
  std::vector<std::uint8_t> bytes;
};

/// Fetches all pages of what `exported` describes.
Exported fetch(const Asker& asker, const scene_response_t& exported) {
  Exported fetched;
  const auto size = static_cast<std::size_t>(std::max<std::int64_t>(0, exported.map_bytes));
  const auto num_pages = static_cast<std::int32_t>(
      std::max<std::size_t>(1, (size + wire::kMapPageBytes - 1) / wire::kMapPageBytes));
  for (std::int32_t first = 0; first < num_pages;
       first += static_cast<std::int32_t>(kPagesAtOnce)) {
    std::vector<std::int32_t> wanted;
    for (std::int32_t page = first; page < num_pages && wanted.size() < kPagesAtOnce; ++page) {
      wanted.push_back(page);
    }
    const auto call = std::make_shared<MapPages>(asker.context, exported.request_id, num_pages,
                                                 wanted, asker.deadline);
    std::future<MapPages::Came> answer = call->answer();
    asker.start(call);
    MapPages::Came came = answer.get();
    if (came.failure.status != Status::kOk) return {std::move(came.failure), {}, {}};
    std::ranges::sort(came.pages, {}, &map_page_t::page);
    for (const map_page_t& page : came.pages) {
      fetched.bytes.insert(fetched.bytes.end(), page.bytes.begin(), page.bytes.end());
    }
  }
  if (fetched.bytes.size() != size ||
      wire::crc64(fetched.bytes.data(), fetched.bytes.size()) != exported.map_checksum) {
    fetched.failure = {Status::kBadAnswer, "the checksum is not that of the pages"};
  }
  return fetched;
}

Exported ask_export(const SceneAsker& with, const scene_request_t& request) {
  if (const auto fault = fault_in_form(request)) return {{Status::kInvalid, *fault}, {}, {}};
  const Asker asker(with);
  Exported fetched;
  // The daemon may have dropped the export in favour of others, or restarted.
  for (int restart = 0; restart <= kMaxRestarts; ++restart) {
    const Asked<scene_response_t> asked = ask_once(asker, request);
    SceneAnswer answer = answer_of(asked);
    if (!answer.ok()) return {{answer.status, answer.error}, {}, {}};
    fetched = fetch(asker, *asked.response);
    fetched.answer = std::move(answer);
    if (fetched.failure.status != Status::kInvalid) return fetched;
  }
  return fetched;
}

}  // namespace

SceneMap ask_scene_map(const SceneAsker& asker, const scene_request_t& request) {
  Exported fetched = ask_export(asker, request);
  if (fetched.failure.status != Status::kOk) return failed<SceneMap>(std::move(fetched.failure));
  SceneMap map;
  map.status = Status::kOk;
  map.scene = std::move(fetched.answer.scene);
  map.bytes = std::move(fetched.bytes);
  return map;
}

SceneTriangles ask_triangles(const SceneAsker& asker, const scene_request_t& request) {
  Exported fetched = ask_export(asker, request);
  if (fetched.failure.status != Status::kOk)
    return failed<SceneTriangles>(std::move(fetched.failure));
  std::optional<wire::ObjectMesh> mesh = wire::decode_mesh(fetched.bytes);
  if (!mesh || fetched.answer.objects.size() != 1)
    return failed<SceneTriangles>({Status::kBadAnswer, "the triangles cannot be read"});
  SceneTriangles sent;
  sent.status = Status::kOk;
  sent.scene = std::move(fetched.answer.scene);
  sent.object = std::move(fetched.answer.objects.front());
  sent.vertices_m = std::move(mesh->vertices_m);
  sent.triangles = std::move(mesh->triangles);
  for (wire::ObjectMesh::Part& part : mesh->parts)
    sent.parts.push_back({std::move(part.name), part.triangles});
  sent.surface_error_m = mesh->surface_error_m;
  sent.has_inside = mesh->has_inside;
  return sent;
}

SceneAnswer ask_scene_list(const SceneAsker& with, scene_request_t request) {
  if (const auto fault = fault_in_form(request)) {
    return failed<SceneAnswer>({Status::kInvalid, *fault});
  }
  const Asker asker(with);
  for (int restart = 0; restart <= kMaxRestarts; ++restart) {
    SceneAnswer all;
    const auto size = [](const SceneAnswer& answer) {
      return answer.scenes.size() + answer.objects.size() + answer.revisions.size();
    };
    for (;;) {
      request.first = static_cast<std::int32_t>(size(all));
      const Asked<scene_response_t> asked = ask_once(asker, request);
      SceneAnswer part = answer_of(asked);
      if (!part.ok()) return part;
      if (request.first > 0 && part.scene.revision != all.scene.revision) break;
      all.status = part.status;
      all.daemon_start = part.daemon_start;
      all.scene = part.scene;
      all.scenes.insert(all.scenes.end(), part.scenes.begin(), part.scenes.end());
      all.objects.insert(all.objects.end(), part.objects.begin(), part.objects.end());
      all.revisions.insert(all.revisions.end(), part.revisions.begin(), part.revisions.end());
      const bool is_last = size(part) == 0;
      if (is_last || size(all) >= static_cast<std::size_t>(asked.response->total)) return all;
    }
  }
  return failed<SceneAnswer>(
      {Status::kNoAnswer, "the scene changed each time before all of it was listed"});
}

}  // namespace camway
