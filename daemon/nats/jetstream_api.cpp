// SPDX-License-Identifier: MIT
#include "daemon/nats/jetstream_api.h"

#include <algorithm>
#include <array>
#include <utility>

#include "daemon/base/base64.h"

namespace camway::nats {
namespace {

using nlohmann::json;

constexpr const char* kApiPrefix = "$JS.API.";

// More codes of errors.
constexpr int kWrongLastSequence = 10071;
constexpr int kInsufficientResources = 10023;
constexpr int kMemoryExceeded = 10028;
constexpr int kStorageExceeded = 10047;
constexpr int kAccountExceeded = 10002;
constexpr int kStoreFailed = 10077;  // "maximum bytes exceeded", or the disk is full
constexpr std::array kFullErrors = {kInsufficientResources, kMemoryExceeded, kStorageExceeded,
                                    kAccountExceeded, kStoreFailed};
// The cluster has no leader, or this server is not yet ready.
constexpr std::array kPassingErrors = {10004, 10007, 10008, 10009, 10041, 10118};

std::string words_of_request_fault(natsStatus status) {
  switch (status) {
    case NATS_TIMEOUT:
      return kNoAnswerInTime;
    case NATS_NO_RESPONDERS:
      return kNobodyAnswers;
    case NATS_CONNECTION_DISCONNECTED:
      return "the connection to NATS was lost";
    default:
      return std::string("NATS: ") + natsStatus_GetText(status);
  }
}

}  // namespace

StreamFault fault_of_error(int code) {
  if (code == kWrongLastSequence) return StreamFault::kConflict;
  if (std::ranges::find(kFullErrors, code) != kFullErrors.end()) return StreamFault::kFull;
  if (std::ranges::find(kPassingErrors, code) != kPassingErrors.end()) {
    return StreamFault::kUnreachable;
  }
  return StreamFault::kRefused;
}

StreamResult<ApiAnswer> api_answer_from(std::string_view bytes) {
  ApiAnswer answer{json::parse(bytes, nullptr, false), 0, ""};
  if (!answer.value.is_object()) {
    return {StreamFault::kRefused, "NATS answered with something that is no answer"};
  }
  if (const auto error = answer.value.find("error"); error != answer.value.end()) {
    answer.error_code = -1;
    answer.error_text = "unknown error";
    if (error->is_object()) {
      const auto code = error->find("err_code");
      const auto text = error->find("description");
      if (code != error->end() && code->is_number_integer()) answer.error_code = code->get<int>();
      if (text != error->end() && text->is_string()) answer.error_text = text->get<std::string>();
    }
  }
  return answer;
}

StreamResult<std::shared_ptr<natsMsg>> ask(Connection& connection, const std::string& stream,
                                           natsMsg& message, std::chrono::milliseconds wait) {
  if (std::string stall = connection.stall(); !stall.empty()) {
    return {StreamFault::kStalled, std::move(stall)};
  }
  // The library would wait for the connection, or send the message over the next one.
  if (!connection.is_connected()) {
    return {StreamFault::kUnreachable, "there is no connection to NATS"};
  }
  if (wait.count() <= 0) return {StreamFault::kUnreachable, kNoAnswerInTime};
  natsMsg* reply = nullptr;
  const NatsHandle handle = connection.parts().connection();
  const natsStatus status = natsConnection_RequestMsg(&reply, handle.get(), &message, wait.count());
  if (status == NATS_OK) return std::shared_ptr<natsMsg>(reply, natsMsg_Destroy);
  if (status == NATS_TIMEOUT) connection.parts().stalls->suspect(stream);
  const bool is_too_large = status == NATS_MAX_PAYLOAD;
  return {is_too_large ? StreamFault::kRefused : StreamFault::kUnreachable,
          words_of_request_fault(status)};
}

StreamResult<ApiAnswer> ask_api(Connection& connection, const std::string& what,
                                const json& request, std::chrono::milliseconds wait) {
  const std::string text = request.is_null() ? "" : request.dump();
  natsMsg* made = nullptr;
  if (natsMsg_Create(&made, (kApiPrefix + what).c_str(), nullptr, text.data(),
                     static_cast<int>(text.size())) != NATS_OK) {
    return {StreamFault::kRefused, "no memory for NATS"};
  }
  const NatsOwned<natsMsg> message(made);
  const std::string stream = what.substr(what.rfind('.') + 1);
  const auto reply = ask(connection, stream, *message, wait);
  if (!reply) return {reply.fault, reply.error};
  return api_answer_from(text_of(**reply));
}

StreamResult<Stream::Found> stored_message_from(const ApiAnswer& answer) {
  if (answer.error_code == kNoMessageError) return Stream::Found{};
  if (answer.error_code != 0) return {fault_of_error(answer.error_code), answer.error_text};
  const StreamResult<Stream::Found> damaged{StreamFault::kRefused, "NATS answered with no message"};
  const auto message = answer.value.find("message");
  if (message == answer.value.end() || !message->is_object()) return damaged;
  const auto subject = message->find("subject");
  const auto sequence = message->find("seq");
  if (subject == message->end() || !subject->is_string() || sequence == message->end() ||
      !sequence->is_number_unsigned()) {
    return damaged;
  }
  StoredMessage stored{subject->get<std::string>(), sequence->get<std::uint64_t>(), {}};
  if (const auto data = message->find("data"); data != message->end()) {
    if (!data->is_string()) return damaged;
    const auto payload = base::decode_base64(data->get_ref<const std::string&>());
    if (!payload) return damaged;
    stored.payload.assign(payload->begin(), payload->end());
  }
  return Stream::Found(std::move(stored));
}

}  // namespace camway::nats
