// SPDX-License-Identifier: MIT
#include <camway/camway.h>
#include <camway/status.h>

#include <array>
#include <cstddef>
#include <string>

#include "client/c/handles.h"

namespace camway::c {
namespace {

static_assert(CAMWAY_OLD_SCENE == static_cast<int>(Status::kOldScene));
static_assert(CAMWAY_STOPPING == static_cast<int>(Status::kStopping));
static_assert(CAMWAY_BUSY == static_cast<int>(Status::kBusy));

/// Returns the name of a status of daemon or client, for as long as the process lives.
const char* name_of(camway_status status) {
  static const auto* const names = [] {
    auto* const made = new std::array<std::string, CAMWAY_BAD_ARGUMENT>;
    for (std::size_t i = 0; i < made->size(); ++i) (*made)[i] = to_string(static_cast<Status>(i));
    return made;
  }();
  return status >= 0 && status < CAMWAY_BAD_ARGUMENT
             ? (*names)[static_cast<std::size_t>(status)].c_str()
             : "unknown";
}

}  // namespace
}  // namespace camway::c

int32_t camway_abi_version(void) { return CAMWAY_ABI_VERSION; }

const char* camway_version(void) { return CAMWAY_VERSION; }

const char* camway_status_name(camway_status status) {
  switch (status) {
    case CAMWAY_BAD_ARGUMENT:
      return "bad_argument";
    case CAMWAY_OUT_OF_MEMORY:
      return "out_of_memory";
    case CAMWAY_NOT_READY:
      return "not_ready";
    default:
      break;
  }
  const char* const name = camway::c::guarded_text([&] { return camway::c::name_of(status); });
  return name == nullptr ? "unknown" : name;
}

int64_t camway_num_handles(void) { return camway::c::Handles::all().count(); }
