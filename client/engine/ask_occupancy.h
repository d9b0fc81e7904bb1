// SPDX-License-Identifier: MIT
#pragma once

#include <camway/occupancy.h>

#include "client/engine/context.h"
#include "client/engine/engine.h"

namespace camway {

/// Asks a scene's map in as many parts as the batch needs, one after the other, and waits for all.
OccupancyAnswer ask_occupancy(Context& context, Engine& engine, const OccupancyBatch& batch);

}  // namespace camway
