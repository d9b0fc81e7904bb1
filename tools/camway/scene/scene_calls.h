// SPDX-License-Identifier: MIT
#pragma once

#include <camway/client.h>

#include <functional>

#include "tools/camway/common/commands.h"
#include "tools/camway/scene/scene_command_flags.h"

/// The calls of `camway scene`. Each opens a client with the options of the flags, sends a request,
/// prints the answer or the reason why there is none, and returns the exit code. The first signal
/// to end cancels the call, the second ends the process.
namespace camway::tools {

/// Runs `call` with a client, as the other functions do with calls of their own.
ExitCode ask_daemon(const SceneCommandFlags& flags,
                    const std::function<SceneAnswer(Client&)>& call);

ExitCode load_scene(const SceneCommandFlags& flags);
ExitCode add_object(const SceneCommandFlags& flags);
ExitCode move_object(const SceneCommandFlags& flags);
ExitCode insert_scan(const SceneCommandFlags& flags);
ExitCode export_map(const SceneCommandFlags& flags);

}  // namespace camway::tools
