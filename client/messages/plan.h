// SPDX-License-Identifier: MIT
#pragma once

#include <camway/plan.h>

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <camway/plan_response_t.hpp>

#include "client/messages/bytes.h"

namespace camway {

/// Why `request` has no form on the wire: the field at fault and its limit. Nothing if it has one.
/// Values (a zero quaternion, say) are for the daemon to judge.
std::optional<std::string> fault_in_form(const PlanRequest& request);

/// The messages of a request, none above `wire::kMaxMessageBytes`.
/// Precondition: no `fault_in_form`.
std::vector<Bytes> to_pages(const PlanRequest& request, const std::string& client_id,
                            std::int64_t request_id);

/// Puts the pages of the answer to one request together, in whatever order and however often they
/// come. Pages of another answer to the same request (the daemon was restarted) replace it.
class PlanCollector {
 public:
  PlanCollector(std::string client_id, std::int64_t request_id);

  enum class Taken { kNew, kKnown, kForeign, kBad };
  /// Takes a message: a new page, one that is here already, one for somebody else, or none at all.
  Taken take(std::span<const std::uint8_t> bytes);

  bool complete() const;
  /// How many pages there are, and how many of them came. 0 until the first comes.
  std::size_t pages_expected() const;
  std::size_t pages_here() const { return pages_.size(); }
  /// The numbers of those that did not come. Precondition: at least one came.
  std::vector<std::int32_t> missing() const;
  /// What was wrong with the last message that was kBad.
  const std::string& fault() const { return fault_; }

  /// The status on the pages so far. Precondition: at least one page.
  Status status() const;
  /// Forgets all pages.
  void clear() { pages_.clear(); }

  /// The whole answer; `kBadAnswer` if its path is none. Precondition: complete.
  PlanResponse response() const;

 private:
  std::string client_id_;
  std::int64_t request_id_;
  std::map<std::int32_t, plan_response_t> pages_;
  std::string fault_;
};

}  // namespace camway
