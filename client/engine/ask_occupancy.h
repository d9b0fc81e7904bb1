// SPDX-License-Identifier: MIT
#pragma once

#include <camway/occupancy.h>

#include "client/engine/context.h"
#include "client/engine/engine.h"

namespace camway {

/// Queries the occupancy map of a scene and waits for the answer, for at most
/// `ClientOptions::deadline_s`. Sends as many requests as the batch needs, and begins anew if the
/// scene changes in between, up to `kMaxRestarts` times. Does not throw on a fault: the answer then
/// has its status and error.
///
/// Thread-safe, but not for the engine's own thread, which would wait for itself.
OccupancyAnswer ask_occupancy(Context& context, Engine& engine, const OccupancyBatch& batch);

}  // namespace camway
