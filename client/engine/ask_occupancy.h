// SPDX-License-Identifier: MIT
#pragma once

#include <camway/occupancy.h>

#include "client/engine/context.h"
#include "client/engine/engine.h"

namespace camway {

/// Queries the occupancy map of a scene and waits for the answer. Sends as many requests as the
/// batch needs, and repeats them if the scene changes in between. Not for the engine's own thread.
OccupancyAnswer ask_occupancy(Context& context, Engine& engine, const OccupancyBatch& batch);

}  // namespace camway
