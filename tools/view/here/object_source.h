// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "daemon/base/result.h"
#include "daemon/scene/snapshot/scene_object.h"
#include "tools/view/orders.h"

namespace camway::view {

/// Makes the content of an object. Meshes are read in a confined process. Files are refused: no
/// folder is set aside for clients here.
base::Result<std::shared_ptr<const scene::ObjectSource>> make_object_source(
    const Form& form, const scene::ObjectOptions& options);

}  // namespace camway::view
