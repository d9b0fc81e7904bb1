// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <camway/plan_response_t.hpp>

namespace camway::fleet {

/// The mark of an answer, by which it is compared with another one to the same request.
struct AnswerMark {
  std::string planner;    ///< who gave it
  std::string client_id;  ///< of the request
  std::int64_t request_id = 0;
  std::int64_t scene_revision = 0;
  std::string scene_digest;
  /// XXH3-128 of the answer without its times.
  std::array<std::uint64_t, 2> digest{};
  /// Whether the deadline, or a cancel, cut planning short. Then another answer may differ.
  bool is_cut_short = false;
};

AnswerMark mark_of(const plan_response_t& answer, std::string planner);

/// Returns whether two answers differ although they must not: they are to one revision of the
/// scene, and neither was cut short.
bool differ(const AnswerMark& a, const AnswerMark& b);

/// Remembers answers that were given while another planner may still answer the same job: each for
/// a minute, and a few hundred at most.
/// Not thread-safe.
class AnswerMemory {
 public:
  using Clock = std::chrono::steady_clock;

  static constexpr std::chrono::seconds kKept{60};
  static constexpr std::size_t kMost = 256;

  void keep(std::int64_t job, AnswerMark mark, Clock::time_point now);
  /// Returns what is kept of the job; null if nothing is. Valid until the next call of `keep`.
  [[nodiscard]] const AnswerMark* find(std::int64_t job, Clock::time_point now);

  /// Forgets the job. Returns false if nothing was kept of it.
  bool forget(std::int64_t job);

  [[nodiscard]] std::size_t size() const { return by_age_.size(); }

 private:
  struct Kept {
    std::int64_t job;
    AnswerMark mark;
    Clock::time_point until;
  };

  void drop_oldest();

  std::list<Kept> by_age_;  ///< oldest first
  std::map<std::int64_t, std::list<Kept>::iterator> by_job_;
};

}  // namespace camway::fleet
