// SPDX-License-Identifier: MIT
#pragma once

#include "tools/view/page_files.h"

namespace camway::view {

/// Returns the page that was built with the program. Without node, npm or, at its first build, the
/// network, it is a page that says so and has neither script nor style.
PageFiles embedded_page();

}  // namespace camway::view
