// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/planning/request.h"
#include "daemon/planning/result.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tests/messages/random_messages.h"

/// Requests, results and scenes for tests of the wire: of the right form, without meaning.
namespace camway::testing {

/// Finite numbers, `keyframes` of them, times increasing.
planning::PlanRequest sample_request(std::size_t keyframes, Random& random);

/// One of each kind of body, the camera's own quadrilateral (nothing) included.
std::vector<std::optional<motion::BodyShape>> sample_bodies(Random& random);

/// The largest body that a request may hold: `kMaxBodyPoints` points in as many pieces.
motion::BodyShape largest_body(Random& random);

/// A result of the form that planning returns, with a path of `segments` segments, twice as many
/// keyframes, half of them inserted, and a report of everything that corrections may say.
planning::PlanResult sample_result(std::size_t segments, Random& random);

/// An empty scene.
std::shared_ptr<const scene::Snapshot> empty_scene(std::string name);

}  // namespace camway::testing
