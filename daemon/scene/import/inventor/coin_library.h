// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

/// Coin, the library that reads Open Inventor and VRML, as an import process uses it. Not
/// thread-safe.
namespace camway::scene::inventor {

/// Starts Coin, once in a process, before it is confined: Coin loads parts of itself and looks for
/// libraries, which later fails. It is told not to look for fonts, sounds and types in libraries,
/// to fetch nothing, and that no time passes, so that what depends on time (Rotor, Blinker) is the
/// same at each import.
void start_coin();

/// Messages of Coin since the last call: the texts of its errors of reading, and its warnings, one
/// line each.
struct CoinMessages {
  std::vector<std::string> errors;
  std::vector<std::string> warnings;
};
CoinMessages take_messages();

}  // namespace camway::scene::inventor
