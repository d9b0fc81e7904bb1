// SPDX-License-Identifier: MIT
#pragma once

#include "lcmtypes/wire/convert.h"

/// Converts between the client's structs and the messages, in both directions: `convert(from, to)`
/// copies every member that the struct and the message have under the same name. A struct needs its
/// own overload only for members whose name or form differs from the message. `to` has to be as it
/// is by default, because lists are appended to.
namespace camway {

/// Converts a struct that has every member of the message under the same name, or a part of one
/// (`wire::convert`).
template <class From, class To>
void convert(const From& from, To& to) {
  wire::convert([](const auto& member, auto& into) { convert(member, into); }, from, to);
}

/// Converts every member that the struct and the message have under the same name.
template <class From, class To>
void convert_common(const From& from, To& to) {
  wire::convert_common([](const auto& member, auto& into) { convert(member, into); }, from, to);
}

}  // namespace camway
