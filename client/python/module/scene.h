// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>

#include "daemon/scene/snapshot/snapshot.h"

namespace camway::python {

/// A scene to plan in without a daemon. Immutable. Thread-safe.
struct LoadedScene {
  std::shared_ptr<const scene::Snapshot> snapshot;  ///< never null
  std::optional<scene::ImportOptions> reading;      ///< nothing for a scene made of arrays
};

}  // namespace camway::python
