// SPDX-License-Identifier: MIT
#pragma once

#include <camway/client.h>

#include <memory>
#include <string>

#include "daemon/base/result.h"
#include "tools/view/backend.h"

namespace camway::view {

/// Returns a backend that asks a daemon, or why no daemon can be asked. `scene` is the scene of
/// requests that name none. A daemon need not be there: until one is heard, answers say so.
///
/// Plans of a daemon are those of `camway plan --daemon`. A daemon's triangles are not known here:
/// paths are not checked, and pictures have no walls.
base::Result<std::unique_ptr<Backend>> plan_by_daemon(std::string scene,
                                                      const ClientOptions& options);

}  // namespace camway::view
