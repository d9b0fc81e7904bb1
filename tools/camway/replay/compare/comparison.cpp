// SPDX-License-Identifier: MIT
#include "tools/camway/replay/compare/comparison.h"

#include <algorithm>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <utility>

namespace camway::tools {
namespace {

/// The requests of a session that belong to no request of the other one yet.
class OpenRequests {
 public:
  explicit OpenRequests(Session& session) : is_taken_(session.requests.size(), false) {
    for (std::size_t i = 0; i < session.requests.size(); ++i) {
      const RecordedRequest& request = session.requests[i];
      by_id_[{request.ids.client_id, request.ids.request_id}] = i;
      by_content_[request.content_digest].push_back(i);
    }
  }

  std::optional<std::size_t> take_same_id(const RecordedRequest& request) {
    const auto found = by_id_.find({request.ids.client_id, request.ids.request_id});
    if (found == by_id_.end()) return std::nullopt;
    is_taken_[found->second] = true;
    return found->second;
  }

  /// Takes the first open request with the same content.
  std::optional<std::size_t> take_same_content(const RecordedRequest& request) {
    const auto found = by_content_.find(request.content_digest);
    if (found == by_content_.end()) return std::nullopt;
    std::deque<std::size_t>& queue = found->second;
    while (!queue.empty() && is_taken_[queue.front()]) queue.pop_front();
    if (queue.empty()) return std::nullopt;
    is_taken_[queue.front()] = true;
    return queue.front();
  }

  [[nodiscard]] bool is_taken(std::size_t index) const { return is_taken_[index]; }

 private:
  std::map<std::pair<std::string, std::int64_t>, std::size_t> by_id_;
  std::map<std::string, std::deque<std::size_t>, std::less<>> by_content_;
  std::vector<bool> is_taken_;
};

/// Returns for each request of `then` the index of its partner in `now`.
std::vector<std::optional<std::size_t>> partners_of(const Session& then, OpenRequests& open) {
  std::vector<std::optional<std::size_t>> partners;
  for (const RecordedRequest& request : then.requests) {
    partners.push_back(open.take_same_id(request));
  }
  // Ids go first for all requests: content alone may belong to another repetition.
  for (std::size_t i = 0; i < partners.size(); ++i) {
    if (!partners[i]) partners[i] = open.take_same_content(then.requests[i]);
  }
  return partners;
}

ComparedRequest compared_with(const RecordedRequest& then, RecordedRequest* now,
                              const Thresholds& thresholds) {
  ComparedRequest compared;
  compared.recorded = &then;
  if (now == nullptr) {
    compared.note = "only in the baseline";
    return compared;
  }
  compared.now = std::move(now->answer);
  if (then.content_digest != now->content_digest) {
    compared.note = "another request has this id now";
    return compared;
  }
  static_cast<Judgement&>(compared) = judge(then, answers_of(compared), thresholds);
  return compared;
}

}  // namespace

std::size_t count(const std::vector<ComparedRequest>& compared, Verdict verdict) {
  return static_cast<std::size_t>(std::ranges::count(compared, verdict, &ComparedRequest::verdict));
}

bool has_failed(const std::vector<ComparedRequest>& compared, const Failing& failing) {
  return std::ranges::any_of(compared, [&](const ComparedRequest& request) {
    return std::ranges::find(failing, request.verdict) != failing.end();
  });
}

std::vector<std::size_t> worst_first(const std::vector<ComparedRequest>& compared) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < compared.size(); ++i) {
    const bool has_two = compared[i].verdict != Verdict::kNotCompared;
    if (has_two && !compared[i].difference.has_same_bits()) order.push_back(i);
  }
  std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t index) {
    return static_cast<int>(compared[index].verdict);
  });
  return order;
}

AnswerPair answers_of(ComparedRequest& compared) {
  const auto& then = compared.recorded->answer;
  AnswerPair answers{then ? &*then : nullptr, compared.now ? &*compared.now : nullptr};
  if (answers.then != nullptr && answers.now != nullptr) {
    const std::string& was = answers.then->scene_digest;
    const std::string& is = answers.now->scene_digest;
    answers.has_same_scene = was.empty() || is.empty() || was == is;
  }
  compared.scene_changed = !answers.has_same_scene;
  return answers;
}

std::vector<ComparedRequest> compare(const Session& then, Session& now,
                                     const Thresholds& thresholds) {
  OpenRequests open(now);
  const auto partners = partners_of(then, open);
  std::vector<ComparedRequest> compared;
  for (std::size_t i = 0; i < partners.size(); ++i) {
    RecordedRequest* partner = partners[i] ? &now.requests[*partners[i]] : nullptr;
    compared.push_back(compared_with(then.requests[i], partner, thresholds));
  }
  for (std::size_t i = 0; i < now.requests.size(); ++i) {
    if (open.is_taken(i)) continue;
    ComparedRequest& only = compared.emplace_back();
    only.recorded = &now.requests[i];
    only.now = std::exchange(now.requests[i].answer, std::nullopt);
    only.note = "only in the new log";
  }
  return compared;
}

}  // namespace camway::tools
