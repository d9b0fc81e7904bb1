// SPDX-License-Identifier: MIT
#pragma once

#include <camway/camway.h>
#include <camway/watch.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "client/c/handles.h"

namespace camway::c {

/// An event of a watch as the C interface has it, and all that it points to.
class WatchEventInC {
 public:
  WatchEventInC(std::shared_ptr<const WatchEvent> from, std::int64_t num_missed);

  const camway_watch_event& get() const { return event_; }

 private:
  std::shared_ptr<const WatchEvent> from_;
  std::vector<camway_collision> broken_;
  std::optional<ScopedHandle<camway_answer>> answer_;
  camway_watch_event event_{};
};

}  // namespace camway::c
