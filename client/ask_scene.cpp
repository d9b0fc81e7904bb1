// SPDX-License-Identifier: MIT
#include "client/ask_scene.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "client/scene_wire.h"
#include "client/text.h"
#include "lcmtypes/checksum.h"
#include "lcmtypes/wire_check.h"

namespace camway {
namespace {

/// Pages of an upload that are sent before the daemon is asked what came: some 3 MB.
constexpr std::size_t kPagesAtOnce = 64;
/// A list that changes while it is read is begun anew so often.
constexpr int kMaxRestarts = 3;

/// Waits for the answer to one request.
template <class Response>
class Collector {
 public:
  Collector(std::string client_id, std::int64_t request_id)
      : client_id_(std::move(client_id)), request_id_(request_id) {}

  /// Whether the answer is new.
  bool take(std::span<const std::uint8_t> bytes) {
    wire::Decoded<Response> decoded = wire::decode<Response>(bytes);
    if (!decoded.message) {
      fault = decoded.fault.text(Response::getTypeName());
      return false;
    }
    const Response& message = *decoded.message;
    if (message.client_id != client_id_ || message.request_id != request_id_) return false;
    response = std::move(*decoded.message);
    return true;
  }

  std::optional<Response> response;
  std::string fault;

 private:
  std::string client_id_;
  std::int64_t request_id_;
};

std::string explain(std::int32_t status, const std::string& message) {
  return to_string(static_cast<Status>(status)) + ": " +
         (message.empty() ? "(no reason given)" : message);
}

/// What came of one exchange.
template <class Response>
struct Asked {
  std::optional<Response> response;
  Failure failure{Status::kOk, {}};
};

Asked<upload_status_t> ask_upload(Session& session, const std::vector<std::uint8_t>& bytes,
                                  std::int64_t checksum, const std::vector<std::int32_t>& pages,
                                  Clock::time_point deadline) {
  const std::int64_t request_id = session.new_request_id();
  std::vector<Bytes> messages;
  const auto add = [&](std::int32_t page) {
    upload_page_t message = page_of(bytes, checksum, page);
    message.client_id = session.options().client_id;
    message.request_id = request_id;
    messages.push_back(wire::encode(message));
  };
  for (const std::int32_t page : pages) add(page);
  add(-1);
  Collector<upload_status_t> collector(session.options().client_id, request_id);
  session.receive_upload_with([&](std::span<const std::uint8_t> message) {
    if (collector.take(message)) session.note_news();
  });
  const auto answered = [&] { return collector.response.has_value(); };
  int tries = 0;
  const Outcome outcome = session.ask(
      {session.channels().upload(), std::move(messages), answered, answered}, deadline, tries);
  session.receive_upload_with({});
  if (outcome == Outcome::kAnswered) return {collector.response, {Status::kOk, {}}};
  return {std::nullopt, session.explain(outcome, {}, collector.fault)};
}

/// Sends what the daemon does not have yet, until it has all. Nothing if it has.
std::optional<Failure> upload(Session& session, const std::vector<std::uint8_t>& bytes,
                              Clock::time_point deadline) {
  const std::int64_t checksum = wire::crc64(bytes.data(), bytes.size());
  std::vector<std::int32_t> pages;  // none at first: the daemon may have some
  for (;;) {
    const Asked<upload_status_t> asked = ask_upload(session, bytes, checksum, pages, deadline);
    if (!asked.response) return asked.failure;
    const upload_status_t& status = *asked.response;
    if (status.status != upload_status_t::STATUS_OK) {
      return Failure{static_cast<Status>(status.status),
                     "upload: " + explain(status.status, status.message)};
    }
    if (status.total_missing == 0) return std::nullopt;
    if (Clock::now() >= deadline) {
      return Failure{Status::kNoAnswer,
                     "the upload was not complete by the deadline; ask again to "
                     "go on, or raise ClientOptions.deadline_s"};
    }
    pages.assign(status.missing.begin(),
                 status.missing.begin() +
                     static_cast<std::ptrdiff_t>(std::min(kPagesAtOnce, status.missing.size())));
  }
}

Asked<scene_response_t> ask_once(Session& session, scene_request_t request,
                                 Clock::time_point deadline) {
  request.client_id = session.options().client_id;
  request.request_id = session.new_request_id();
  request.utime = microseconds_since_1970();
  Collector<scene_response_t> collector(request.client_id, request.request_id);
  std::optional<Failure> refusal;
  session.receive_scene_with([&](std::span<const std::uint8_t> bytes) {
    if (!collector.take(bytes)) return;
    if (collector.response->status == scene_response_t::STATUS_OVERLOADED) {
      refusal = Failure{Status::kOverloaded,
                        explain(collector.response->status, collector.response->message)};
      collector.response.reset();
      session.note_life();
    } else {
      session.note_news();
    }
  });
  const auto answered = [&] { return collector.response.has_value(); };
  int tries = 0;
  const Outcome outcome =
      session.ask({session.channels().scene_request(), {wire::encode(request)}, answered, answered},
                  deadline, tries);
  session.receive_scene_with({});
  if (outcome == Outcome::kAnswered) return {collector.response, {Status::kOk, {}}};
  if (refusal && outcome == Outcome::kDeadline) return {std::nullopt, *refusal};
  return {std::nullopt, session.explain(outcome, {}, collector.fault)};
}

SceneAnswer answer_of(const Asked<scene_response_t>& asked) {
  if (!asked.response) return failed<SceneAnswer>(asked.failure);
  const scene_response_t& response = *asked.response;
  SceneAnswer answer;
  answer.status = static_cast<Status>(response.status);
  if (!answer.ok()) {
    answer.error = explain(response.status, response.message);
    return answer;
  }
  answer.message = response.message;
  answer.scene = from_wire(response.scene);
  for (const scene_info_t& scene : response.scenes) answer.scenes.push_back(from_wire(scene));
  for (const scene_object_t& object : response.objects) {
    answer.objects.push_back(from_wire(object));
  }
  return answer;
}

/// Why `request` has no form on the wire.
std::optional<std::string> fault_in_form(const scene_request_t& request) {
  for (const auto& fault :
       {fault_in_text("scene", request.scene, wire::kMaxSceneNameBytes),
        fault_in_text("object", request.object, wire::kMaxObjectNameBytes),
        fault_in_text("file", request.file, wire::kMaxFileNameBytes),
        fault_in_text("format", request.upload_format, wire::kMaxFormatBytes)}) {
    if (fault) return fault;
  }
  return std::nullopt;
}

}  // namespace

SceneAnswer ask_scene(Session& session, scene_request_t request,
                      const std::vector<std::uint8_t>& bytes) {
  if (const auto fault = fault_in_form(request)) {
    return failed<SceneAnswer>({Status::kInvalid, *fault});
  }
  const Clock::time_point deadline = after(session.options().deadline_s);
  if (!bytes.empty()) {
    if (std::optional<Failure> failure = upload(session, bytes, deadline)) {
      return failed<SceneAnswer>(*std::move(failure));
    }
  }
  return answer_of(ask_once(session, std::move(request), deadline));
}

SceneAnswer ask_scene_list(Session& session, scene_request_t request) {
  if (const auto fault = fault_in_form(request)) {
    return failed<SceneAnswer>({Status::kInvalid, *fault});
  }
  const Clock::time_point deadline = after(session.options().deadline_s);
  for (int restart = 0; restart <= kMaxRestarts; ++restart) {
    SceneAnswer all;
    for (;;) {
      request.first = static_cast<std::int32_t>(all.scenes.size() + all.objects.size());
      const Asked<scene_response_t> asked = ask_once(session, request, deadline);
      SceneAnswer part = answer_of(asked);
      if (!part.ok()) return part;
      if (request.first > 0 && part.scene.revision != all.scene.revision) break;
      all.status = part.status;
      all.scene = part.scene;
      all.scenes.insert(all.scenes.end(), part.scenes.begin(), part.scenes.end());
      all.objects.insert(all.objects.end(), part.objects.begin(), part.objects.end());
      const bool is_last = part.scenes.empty() && part.objects.empty();
      const std::size_t here = all.scenes.size() + all.objects.size();
      if (is_last || here >= static_cast<std::size_t>(asked.response->total)) return all;
    }
  }
  return failed<SceneAnswer>(
      {Status::kNoAnswer, "the scene changed each time before all of its objects were listed"});
}

}  // namespace camway
