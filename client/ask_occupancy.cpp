// SPDX-License-Identifier: MIT
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/occupancy_wire.h"
#include "client/session.h"
#include "lcmtypes/wire_check.h"

namespace camway {
namespace {

/// The parts of a large batch are asked anew so often when the scene changes between them.
constexpr int kMaxRestarts = 3;

/// A part's answer, or why there is none.
struct PartAnswer {
  std::optional<occupancy_response_t> response;
  Failure failure{Status::kOk, {}};
};

std::string explain(const occupancy_response_t& response) {
  const std::string said = response.message.empty() ? "(no reason given)" : response.message;
  return to_string(static_cast<Status>(response.status)) + " (scene \"" + response.scene +
         "\"): " + said;
}

PartAnswer ask_part(Session& session, const occupancy_request_t& request,
                    Clock::time_point deadline) {
  OccupancyCollector collector(request.client_id, request.request_id);
  std::optional<Failure> refusal;
  session.receive_occupancy_with([&](std::span<const std::uint8_t> bytes) {
    if (collector.take(bytes) != OccupancyCollector::Taken::kNew) return;
    if (collector.response()->status == occupancy_response_t::STATUS_OVERLOADED) {
      refusal = Failure{Status::kOverloaded, explain(*collector.response())};
      collector.clear();
      session.note_life();
    } else {
      session.note_news();
    }
  });
  const auto answered = [&] { return collector.response().has_value(); };
  const Question question{
      session.channels().occupancy_request(), {wire::encode(request)}, answered, answered};
  int tries = 0;
  const Outcome outcome = session.ask(question, deadline, tries);
  session.receive_occupancy_with({});
  if (outcome == Outcome::kAnswered) return {collector.response(), {Status::kOk, {}}};
  if (refusal && outcome == Outcome::kDeadline) return {std::nullopt, *refusal};
  return {std::nullopt, session.explain(outcome, {}, collector.fault())};
}

/// Asks all parts in turn; nothing if the scene changed between them.
std::optional<OccupancyAnswer> ask_parts(Session& session, std::vector<occupancy_request_t>& parts,
                                         Clock::time_point deadline) {
  OccupancyAnswer answer;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    parts[i].request_id = session.new_request_id();
    const PartAnswer part = ask_part(session, parts[i], deadline);
    if (!part.response) return failed<OccupancyAnswer>(part.failure);
    const occupancy_response_t& response = *part.response;
    if (response.status != occupancy_response_t::STATUS_OK) {
      return failed<OccupancyAnswer>({static_cast<Status>(response.status), explain(response)});
    }
    if (i > 0 && response.scene_revision != answer.scene_revision) return std::nullopt;
    answer.scene_revision = response.scene_revision;
    answer.resolution_m = response.resolution_m;
    if (const auto fault = append(parts[i], response, answer)) {
      return failed<OccupancyAnswer>(
          {Status::kBadAnswer, "the daemon's answer makes no sense: " + *fault +
                                   "; check that client and daemon are of one version"});
    }
  }
  answer.status = Status::kOk;
  return answer;
}

}  // namespace

OccupancyAnswer ask_occupancy(Session& session, const OccupancyBatch& batch) {
  if (const auto fault = fault_in_form(batch)) {
    return failed<OccupancyAnswer>({Status::kInvalid, *fault});
  }
  const ClientOptions& options = session.options();
  const Clock::time_point deadline = after(options.deadline_s);
  std::vector<occupancy_request_t> parts = to_requests(batch, options.client_id);
  for (int i = 0; i <= kMaxRestarts; ++i) {
    if (std::optional<OccupancyAnswer> answer = ask_parts(session, parts, deadline)) {
      return *std::move(answer);
    }
  }
  return failed<OccupancyAnswer>({Status::kNoAnswer,
                                  "the scene changed each time before all parts of the batch were "
                                  "answered; ask less at once"});
}

}  // namespace camway
