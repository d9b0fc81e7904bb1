// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

/// Open CASCADE, the library that reads STEP and IGES, as an import process uses it. Not
/// thread-safe.
namespace camway::scene::cad {

/// Starts the library, once in a process, before it is confined. It is told to print nothing, to
/// keep B-splines as the file has them, and to compute in millimetres.
void start_cad();

/// Runs `work`, and turns what the library throws, which is no `std::exception`, into one:
/// `std::bad_alloc` or `std::runtime_error` with its message.
void with_cad_errors(const std::function<void()>& work);

}  // namespace camway::scene::cad
