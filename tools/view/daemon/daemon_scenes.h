// SPDX-License-Identifier: MIT
#pragma once

#include <camway/client.h>

#include <functional>
#include <string>
#include <vector>

#include "tools/view/answer.h"
#include "tools/view/facts.h"
#include "tools/view/orders.h"

namespace camway::view {

/// Returns the code of an answer without a result.
int code_of(Status status);

SceneFacts facts_of(const SceneInfo& scene);
std::vector<SceneFacts> facts_of(const std::vector<SceneInfo>& scenes);

/// Returns the `mesh_digest` of an object as it is described.
using MeshDigestOf = std::function<std::string(const SceneInfo&, const SceneObject&)>;

/// Has a daemon answer a question about scenes or make a change, and waits for the answer.
Answer ask_daemon_scene(Client& client, const SceneOrder& order, const MeshDigestOf& mesh_digest);

}  // namespace camway::view
