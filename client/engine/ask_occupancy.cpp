// SPDX-License-Identifier: MIT
#include "client/engine/ask_occupancy.h"

#include <deque>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <camway/cancel_t.hpp>

#include "client/engine/occupancy_collector.h"
#include "client/messages/convert.h"
#include "client/messages/occupancy.h"
#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/utime.h"

namespace camway {
namespace {

std::string explain(const occupancy_response_t& response) {
  const std::string said = response.message.empty() ? "(no reason given)" : response.message;
  return to_string(static_cast<Status>(response.status)) + " (scene \"" + response.scene +
         "\"): " + said;
}

/// The answer to a part of a batch, or the reason why there is none.
struct PartAnswer {
  std::optional<occupancy_response_t> response;
  Failure failure{Status::kOk, {}};
};

/// A pending part of a batch.
class PartCall final : public Call {
 public:
  PartCall(Context& context, const occupancy_request_t& request, Clock::time_point deadline)
      : Call(Kind::kOccupancy, request.request_id,
             {{context.channels().occupancy_request(), wire::encode(request)}},
             context.retry(deadline)),
        context_(context),
        collector_(request.client_id, request.request_id) {}

  std::future<PartAnswer> answer() { return promise_.get_future(); }

  void take_answer(std::span<const std::uint8_t> bytes, Clock::time_point /*now*/) override {
    if (collector_.take(bytes) != OccupancyCollector::Taken::kNew) return;
    retry().note_life();
    if (collector_.response()->status == occupancy_response_t::STATUS_OVERLOADED) {
      refusal_ = Failure{Status::kOverloaded, explain(*collector_.response())};
      collector_.clear();
    }
  }
  bool answered() const override { return collector_.response().has_value(); }
  void cancel() override {
    cancel_t message{};
    message.client_id = context_.options().client_id;
    message.request_id = request_id();
    message.utime = wire::utime_now();
    replace_request_messages({{context_.channels().cancel_occupancy(), wire::encode(message)}});
    retry().restart();
  }
  void finish(Outcome outcome) override {
    PartAnswer answer{collector_.response(), {Status::kOk, {}}};
    if (outcome != Outcome::kAnswered) {
      answer = {std::nullopt,
                refusal_ && (outcome == Outcome::kDeadline || outcome == Outcome::kSilence)
                    ? *refusal_
                    : context_.explain(outcome, retry().ever_heard(), {}, collector_.fault())};
    }
    promise_.set_value(std::move(answer));
  }

 private:
  Context& context_;
  OccupancyCollector collector_;
  std::optional<Failure> refusal_;
  std::promise<PartAnswer> promise_;
};

/// Sends the parts of a batch in order, each while the one before is being answered.
class PartsInTurn {
 public:
  PartsInTurn(Context& context, Engine& engine, std::vector<occupancy_request_t>& parts,
              Clock::time_point deadline)
      : context_(context), engine_(engine), parts_(parts), deadline_(deadline) {}
  /// Cancels the pending parts.
  ~PartsInTurn() {
    for (std::size_t i = taken_; i < begun_; ++i) {
      engine_.cancel(Call::Kind::kOccupancy, parts_[i].request_id);
    }
  }
  PartsInTurn(const PartsInTurn&) = delete;
  PartsInTurn& operator=(const PartsInTurn&) = delete;

  /// Returns the answer to the next part. Requires that there is one.
  PartAnswer next() {
    while (begun_ < parts_.size() && begun_ < taken_ + kAtOnce) begin_next();
    PartAnswer answer = answers_.front().get();
    answers_.pop_front();
    ++taken_;
    return answer;
  }

 private:
  /// Two, so that the daemon's workers do not wait for the network. Not more, because each part is
  /// a message of full size, and the usual receive buffer holds few of them.
  static constexpr std::size_t kAtOnce = 2;

  void begin_next() {
    parts_[begun_].request_id = context_.new_request_id();
    const auto call = std::make_shared<PartCall>(context_, parts_[begun_], deadline_);
    answers_.push_back(call->answer());
    engine_.start(call);
    ++begun_;
  }

  Context& context_;
  Engine& engine_;
  std::vector<occupancy_request_t>& parts_;
  Clock::time_point deadline_;
  std::deque<std::future<PartAnswer>> answers_;
  std::size_t begun_ = 0;
  std::size_t taken_ = 0;
};

/// Returns the answer to all parts; nothing if the scene changed between them.
std::optional<OccupancyAnswer> ask_parts(Context& context, Engine& engine,
                                         std::vector<occupancy_request_t>& parts,
                                         Clock::time_point deadline) {
  OccupancyAnswer answer;
  PartsInTurn turns(context, engine, parts, deadline);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const PartAnswer part = turns.next();
    if (!part.response) return failed<OccupancyAnswer>(part.failure);
    const occupancy_response_t& response = *part.response;
    if (response.status != occupancy_response_t::STATUS_OK) {
      return failed<OccupancyAnswer>({static_cast<Status>(response.status), explain(response)});
    }
    if (i > 0 && response.scene_revision != answer.scene_revision) return std::nullopt;
    answer.scene_revision = response.scene_revision;
    convert(response.daemon_start, answer.daemon_start);
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

OccupancyAnswer ask_occupancy(Context& context, Engine& engine, const OccupancyBatch& batch) {
  if (const auto fault = fault_in_form(batch)) {
    return failed<OccupancyAnswer>({Status::kInvalid, *fault});
  }
  const ClientOptions& options = context.options();
  const Clock::time_point deadline = after(options.deadline_s);
  std::vector<occupancy_request_t> parts = to_requests(batch, options.client_id);
  for (int i = 0; i <= kMaxRestarts; ++i) {
    if (std::optional<OccupancyAnswer> answer = ask_parts(context, engine, parts, deadline)) {
      return *std::move(answer);
    }
  }
  return failed<OccupancyAnswer>({Status::kNoAnswer,
                                  "the scene changed each time before all parts of the batch were "
                                  "answered; ask less at once"});
}

}  // namespace camway
