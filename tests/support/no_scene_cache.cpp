// SPDX-License-Identifier: MIT
//
// Every test program has this. It and the programs that it starts leave the cache of the user
// alone.
#include <cstdlib>

namespace {

[[maybe_unused]] const int is_set = setenv("CAMWAY_CACHE_DIR", "", 1);

}  // namespace
