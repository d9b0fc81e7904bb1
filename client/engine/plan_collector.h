// SPDX-License-Identifier: MIT
#pragma once

#include <camway/plan.h>

#include <cstdint>
#include <span>
#include <string>

#include <camway/plan_response_t.hpp>

#include "lcmtypes/wire/pages.h"

namespace camway {

/// Collects the pages of the answer to one request, which may come in any order and repeatedly.
/// Pages of a new answer to the same request, after a restart of the daemon, replace the old ones.
/// Not thread-safe.
class PlanCollector {
 public:
  PlanCollector(std::string client_id, std::int64_t request_id);

  enum class Taken { kNew, kKnown, kForeign, kBad };
  /// Takes a message and returns what it was: a new page, a known page, a message for another
  /// request or client, or a message that is no valid page.
  Taken take(std::span<const std::uint8_t> bytes);

  const wire::PageSet<plan_response_t>& pages() const { return pages_; }
  bool complete() const { return pages_.complete(); }
  /// Returns the fault of the last message that was kBad.
  const std::string& fault() const { return fault_; }

  /// Returns the status of the answer. Requires at least one page.
  Status status() const { return static_cast<Status>(pages_.any().status); }
  /// Forgets all pages.
  void clear() { pages_ = {}; }

  /// Returns the answer; one with `kBadAnswer` if its content is not valid. Requires `complete()`.
  PlanResponse response() const;

 private:
  std::string client_id_;
  std::int64_t request_id_;
  wire::PageSet<plan_response_t> pages_;
  std::string fault_;
};

}  // namespace camway
