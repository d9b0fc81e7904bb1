// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <camway/plan_request_t.hpp>
#include <camway/plan_response_t.hpp>

#include "daemon/planning/request.h"
#include "daemon/planning/result.h"

/// Between the wire and the structs of planning. Form only: whether values make sense is judged by
/// `planning::validate`. Functions without state, safe from any thread.
namespace camway::service {

/// How long a request may take from its receipt to the end of planning.
struct DeadlineLimits {
  double default_s = 10.0;  ///< for requests that say 0 [Limit: 0 < value] [Units: seconds]
  double max_s = 60.0;      ///< longer ones are cut to this [Limit: default_s <= value]
};

/// The deadline that holds for a request that says `wire_s`, in seconds. Only an exact 0 asks for
/// the default: NaN and negative values stay, for `planning::validate`.
double deadline_of(double wire_s, const DeadlineLimits& limits);

/// A request, or why there is none, e.g. "method: 'magic' is unknown".
struct ConvertedRequest {
  std::optional<planning::PlanRequest> request;
  std::string error;
};

/// `wire` holds the keyframes of all pages. Its zeros become the defaults of
/// `planning::PlanOptions`. What is not zero though it does not count (a time without `has_times`,
/// a target without its policy) is an error: it was meant.
ConvertedRequest from_wire(const plan_request_t& wire, const DeadlineLimits& limits = {});

/// Who asked for what.
struct RequestIds {
  std::string client_id;
  std::int64_t request_id = 0;
  std::int64_t utime = 0;  ///< microseconds since 1970
};

/// The whole request as one page, which may be too large for a message: see `encode_pages`.
plan_request_t to_wire(const planning::PlanRequest& request, const RequestIds& ids);

/// A result, or why there is none: a status that no planning has (overloaded, malformed,
/// cancelled, limit), or segments that are no path, or a report that says what no correction does.
struct ConvertedResult {
  std::optional<planning::PlanResult> result;
  std::string error;
};

/// `wire` holds the lists of all pages. What it does not carry (`Timing::load_scene_ms`, the number
/// of a witness's feature beside its name, the witness of a correction's collision) stays 0 or
/// empty.
ConvertedResult from_wire(const plan_response_t& wire);

/// What an answer says beside the result.
struct AnswerHeader {
  RequestIds ids;  ///< `utime`: when the answer was computed
  std::string scene;
  std::int64_t scene_revision = 0;
  std::string scene_digest;
};

/// The whole answer as one page, which may be too large for a message: see `encode_pages`.
plan_response_t to_wire(const planning::PlanResult& result, const AnswerHeader& header);

/// An answer that holds nothing but a status of `plan_response_t` and a message.
plan_response_t plain_answer(std::int32_t status, std::string_view message,
                             const AnswerHeader& header);

/// The name of a status of any answer, for logs: "ok", "partial", ..., "limit", "no_map".
std::string_view status_name(std::int32_t wire_status);

/// `text` as a message may carry it: without NUL, at most `max_bytes`, cut between characters of
/// UTF-8.
std::string clipped(std::string_view text, std::size_t max_bytes);

}  // namespace camway::service
