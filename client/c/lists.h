// SPDX-License-Identifier: MIT
#pragma once

#include <camway/camway.h>

#include <algorithm>
#include <cstddef>

#include "client/c/refusal.h"

namespace camway::c {

/// Writes the first `capacity` of `items`, each by `convert`, and the number of all.
template <class List, class Item, class Convert>
camway_status write_list(const List& items, Item* target, std::size_t capacity, std::size_t* count,
                         const Convert& convert) {
  require(count, "count");
  *count = 0;
  require_array(target, capacity, "the array");
  const std::size_t written = std::min(capacity, items.size());
  for (std::size_t i = 0; i < written; ++i) target[i] = convert(items[i]);
  *count = items.size();
  return CAMWAY_OK;
}

}  // namespace camway::c
