// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "lcmtypes/wire/pages.h"

namespace camway::service {

using wire::Bytes;

/// Identifies a request. Requests with equal keys are the same request.
struct RequestKey {
  std::string client_id;
  std::int64_t request_id = 0;

  // clang-tidy 14 takes the comparison with 0 that this generates for a null pointer.
  auto operator<=>(const RequestKey&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// The encoded messages of an answer, shared by cache and outbox.
using Pages = std::shared_ptr<const std::vector<Bytes>>;

/// Returns an answer of one message.
inline Pages one_page(Bytes bytes) {
  return std::make_shared<const std::vector<Bytes>>(1, std::move(bytes));
}

}  // namespace camway::service
