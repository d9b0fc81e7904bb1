// SPDX-License-Identifier: MIT
#pragma once

#include <camway/camway.h>
#include <camway/status.h>

#include <cstddef>
#include <string>

namespace camway::c {

/// The failure of a function of the C interface: thrown inside it, and returned as its status.
struct Refusal {
  camway_status status;
  std::string text;
};

/// Keeps the text of a failure for `camway_last_error` of this thread, and returns `status`.
camway_status remember(camway_status status, const char* text) noexcept;

/// Returns a status of the client as one of the C interface, whose numbers are the same; remembers
/// `error` unless it is kOk.
inline camway_status returned(Status status, const std::string& error) noexcept {
  if (status == Status::kOk) return CAMWAY_OK;
  return remember(static_cast<camway_status>(status), error.c_str());
}

/// Remembers the exception that is being handled, and returns its status.
camway_status remember_exception() noexcept;

/// Runs the body of a function: `body` returns a status, and may throw anything.
template <class Body>
camway_status guarded(const Body& body) noexcept {
  try {
    return body();
  } catch (...) {
    return remember_exception();
  }
}

/// Runs the body of a function that returns a text, or NULL if `body` throws.
template <class Body>
const char* guarded_text(const Body& body) noexcept {
  try {
    return body();
  } catch (...) {
    remember_exception();
    return nullptr;
  }
}

/// Throws if `argument` is NULL.
void require(const void* argument, const char* name);

/// Throws if `array` is NULL and not empty.
void require_array(const void* array, std::size_t count, const char* name);

/// Throws CAMWAY_INVALID unless `value` is one of 0 to `most`.
void require_choice(int value, int most, const char* name);

/// Returns a text that has to be there.
std::string text_of(const char* text, const char* name);

/// Returns a text, empty for NULL.
inline std::string optional_text(const char* text) { return text == nullptr ? "" : text; }

}  // namespace camway::c
