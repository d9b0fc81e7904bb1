// SPDX-License-Identifier: MIT
#include "client/c/handles.h"

namespace camway::c {

Handles& Handles::all() {
  static Handles* const handles = new Handles;
  return *handles;
}

std::int64_t Handles::count() const {
  const std::shared_lock lock(mutex_);
  return static_cast<std::int64_t>(live_.size());
}

void Handles::refuse(const void* handle) {
  throw Refusal{CAMWAY_BAD_ARGUMENT, handle == nullptr
                                         ? "a handle is NULL"
                                         : "a handle was freed before, or is of another kind"};
}

}  // namespace camway::c
