// SPDX-License-Identifier: MIT
#include "tools/view/desk.h"

#include <fmt/format.h>

#include <utility>

#include "daemon/version/build_info.h"
#include "tools/answers/interpolation.h"
#include "tools/json/option_fields.h"
#include "tools/view/export.h"

namespace camway::view {

Desk::Place Desk::take_place() {
  if (plans_->fetch_add(1) >= options_.limits.all_plans) {
    plans_->fetch_sub(1);
    return nullptr;
  }
  return {plans_.get(), [plans = plans_](void*) { plans->fetch_sub(1); }};
}

bool Desk::takes_change() {
  const std::lock_guard lock(rate_mutex_);
  return rate_.take(base::TokenBucket::Clock::now());
}

std::optional<Answer> Desk::refuse_change() const {
  if (!options_.is_read_only) return std::nullopt;
  return failure(code::kForbidden,
                 "scenes are not changed here: camway view was started with --read-only");
}

void Desk::ask_scene(SceneOrder order, Done done) {
  if (order.is_change()) {
    if (std::optional<Answer> refusal = refuse_change()) return done(*std::move(refusal));
    if (!takes_change()) {
      return done(failure(code::kTooMany, fmt::format("too many changes of scenes: at most {:g} "
                                                      "a second",
                                                      options_.limits.changes_per_s)));
    }
  }
  if (order.kind != SceneOrder::Kind::kList) order = in_scene(std::move(order));
  backend_.ask_scene(std::move(order), std::move(done));
}

void Desk::status(Done done) const {
  const bool is_read_only = options_.is_read_only;
  backend_.status([is_read_only, done = std::move(done)](Answer answer) {
    if (answer.code == code::kOk) {
      answer.json =
          fmt::format("{{\"read_only\": {}, \"backend\": {}}}", is_read_only, answer.json);
    }
    done(std::move(answer));
  });
}

void Desk::interpolate(PlanOrder order, Done done) {
  post([order = std::move(order), done = std::move(done)] {
    base::Result<std::string> text = tools::interpolated_text(order.request);
    if (!text) return done(failure(code::kInvalid, "the path cannot be written: " + text.error));
    done({code::kOk, *std::move(text), {}});
  });
}

void Desk::triangles(TrianglesOrder order, Done done) {
  order = in_scene(std::move(order));
  backend_.triangles(std::move(order.scene), std::move(order.indices), std::move(done));
}

Answer Desk::last() const {
  const std::shared_ptr<const LastPlan> plan = backend_.last();
  if (plan && plan->request_text && plan->answer_text) {
    return {
        code::kOk,
        fmt::format("{{\"request\": {}, \"answer\": {}}}", *plan->request_text, *plan->answer_text),
        {}};
  }
  if (options_.first_request.empty()) return {code::kOk, "{}", {}};
  return {code::kOk, fmt::format("{{\"request\": {}}}", options_.first_request), {}};
}

Answer Desk::fields() {
  auto json = nlohmann::ordered_json::parse(tools::option_fields_json());
  json["exports"] = export_formats();
  return {code::kOk, json.dump(), {}};
}

Answer Desk::version() {
  constexpr int kDoorVersion = 1;  // the v1 of the paths
  return {code::kOk,
          fmt::format("{{\"camway\": {}, \"door\": {}}}", json_string(service::version_text()),
                      kDoorVersion),
          {}};
}

}  // namespace camway::view
