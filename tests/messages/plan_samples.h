// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/planning/request/request.h"
#include "daemon/planning/result/result.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tests/messages/random_messages.h"

/// Requests, results and scenes for tests of the wire: valid in form, but without meaning.
namespace camway::testing {

/// Returns options of which about half have a random value of their range, the others the default.
/// Each value survives in messages and files bit for bit.
planning::PlanOptions sample_options(Random& random);

/// Returns a request with finite numbers, `keyframes` keyframes and increasing times.
planning::PlanRequest sample_request(std::size_t keyframes, Random& random);

/// Returns one body of each kind; an unset one stands for the camera's near quadrilateral.
std::vector<std::optional<motion::BodyShape>> sample_bodies(Random& random);

/// Returns the largest body that a request may hold, a mesh.
motion::BodyShape largest_body(Random& random);

/// Returns a result with the form of a plan: a path of `segments` segments, twice as many
/// keyframes, half of them inserted, and all fields that corrections may set.
planning::PlanResult sample_result(std::size_t segments, Random& random);

/// Returns an empty scene.
std::shared_ptr<const scene::Snapshot> empty_scene(std::string name);

}  // namespace camway::testing
