// SPDX-License-Identifier: MIT
#include "client/c/refusal.h"

#include <exception>
#include <new>

namespace camway::c {
namespace {

std::string& last_error() {
  thread_local std::string text;
  return text;
}

}  // namespace

camway_status remember(camway_status status, const char* text) noexcept {
  try {
    last_error() = text;
  } catch (...) {
    last_error().clear();
  }
  return status;
}

camway_status remember_exception() noexcept {
  try {
    throw;
  } catch (const Refusal& refusal) {
    return remember(refusal.status, refusal.text.c_str());
  } catch (const std::bad_alloc&) {
    return remember(CAMWAY_OUT_OF_MEMORY, "out of memory");
  } catch (const std::exception& exception) {
    return remember(CAMWAY_INTERNAL_ERROR, exception.what());
  } catch (...) {
    return remember(CAMWAY_INTERNAL_ERROR, "an unknown exception");
  }
}

void require(const void* argument, const char* name) {
  if (argument == nullptr) throw Refusal{CAMWAY_BAD_ARGUMENT, std::string(name) + ": is NULL"};
}

void require_array(const void* array, std::size_t count, const char* name) {
  if (count > 0) require(array, name);
}

void require_choice(int value, int most, const char* name) {
  if (value >= 0 && value <= most) return;
  throw Refusal{CAMWAY_INVALID, std::string(name) + ": is " + std::to_string(value) +
                                    ", and not 0 to " + std::to_string(most)};
}

std::string text_of(const char* text, const char* name) {
  require(text, name);
  return text;
}

}  // namespace camway::c

const char* camway_last_error(void) { return camway::c::last_error().c_str(); }
