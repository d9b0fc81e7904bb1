// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace camway::view {

/// Status codes of HTTP that the door answers with.
namespace code {
inline constexpr int kOk = 200;
inline constexpr int kInvalid = 400;
inline constexpr int kForbidden = 403;
inline constexpr int kNotFound = 404;
inline constexpr int kNotAllowed = 405;
inline constexpr int kTooLarge = 413;
inline constexpr int kTooMany = 429;
inline constexpr int kCancelled = 499;  ///< of no standard; common for "the client gave up"
inline constexpr int kOurFault = 500;
inline constexpr int kNotOffered = 501;
inline constexpr int kNoDaemon = 503;
inline constexpr int kNoAnswer = 504;
}  // namespace code

/// The outcome of what a client asked for.
struct Answer {
  int code = code::kOk;
  std::string json;   ///< the answer, an object; empty exactly if there is an error
  std::string error;  ///< why there is no answer, a sentence; empty with `code::kOk`
};

/// Returns an answer that is a reason.
inline Answer failure(int code, std::string error) { return {code, {}, std::move(error)}; }

/// Returns `text` as a string of JSON, in quotes. Bytes that are no UTF-8 are replaced.
std::string json_string(std::string_view text);

/// Returns the member that a sentence about a wrong request is about, without the name of its
/// document: "options.limits" of "request: options.limits: has no limit". The name of the document
/// where it is about all of that; empty where it names nothing.
std::string_view field_of(std::string_view error);

/// Returns the members of an error: `"error": ...`, and `"field": ...` where the request is wrong
/// and the sentence names a member.
std::string error_members(int code, std::string_view error);

/// Takes an answer: called exactly once, on any thread. Must neither throw nor wait.
using Done = std::function<void(Answer)>;

}  // namespace camway::view
