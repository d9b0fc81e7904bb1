// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/nats/connection_parts.h"
#include "daemon/nats/stream.h"

namespace camway::nats {

/// Codes of errors, as the server documents them (`err_code`).
inline constexpr int kNoMessageError = 10037;
inline constexpr int kSequenceNotFoundError = 10043;
inline constexpr int kDeleteFailedError = 10057;
inline constexpr int kStreamNotFoundError = 10059;
inline constexpr int kStreamNameError = 10058;
inline constexpr int kNoPeersError = 10005;

/// The error of a request that no server listens for.
inline constexpr const char* kNobodyAnswers =
    "no server of NATS keeps the stream now; a server whose disk is full may have switched its "
    "JetStream off, which its log says";

/// The error of a request that a server took too long for.
inline constexpr const char* kNoAnswerInTime = "NATS did not answer in time";

/// An answer of the API: the object, which may hold an `error` with these.
struct ApiAnswer {
  nlohmann::json value;
  int error_code = 0;  ///< 0 if there is none
  std::string error_text;
};

/// Asks the API of JetStream. Fails with `kUnreachable` or `kStalled` without an answer, and with
/// `kRefused` if it is none of the API. `what` is the end of the subject: "STREAM.INFO.name".
StreamResult<ApiAnswer> ask_api(Connection& connection, const std::string& what,
                                const nlohmann::json& request, std::chrono::milliseconds wait);

/// Sends a message to a stream and waits for the reply. Fails with `kUnreachable` or `kStalled`.
StreamResult<std::shared_ptr<natsMsg>> ask(Connection& connection, const std::string& stream,
                                           natsMsg& message, std::chrono::milliseconds wait);

/// Reads an answer, whatever the bytes are.
StreamResult<ApiAnswer> api_answer_from(std::string_view bytes);
/// The fault of an error of the API.
StreamFault fault_of_error(int code);
/// Reads the message of an answer to MSG.GET, whatever it is. Fails with `kRefused`.
StreamResult<Stream::Found> stored_message_from(const ApiAnswer& answer);

inline std::string_view text_of(natsMsg& message) {
  return {natsMsg_GetData(&message), static_cast<std::size_t>(natsMsg_GetDataLength(&message))};
}

}  // namespace camway::nats
