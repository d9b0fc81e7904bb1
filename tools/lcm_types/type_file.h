// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "daemon/base/result.h"

/// Message types of LCM as their `.lcm` files define them, and messages read by them. Camway's own
/// messages need none of this: their code is generated.
namespace camway::tools {

/// The size of one dimension of an array: a number, or the name of the member that counts.
using LcmSize = std::variant<std::uint64_t, std::string>;

/// A member of a struct.
struct LcmMember {
  std::string type;  ///< a primitive type, or a struct with its package: "exlcm.pose_t"
  std::string name;
  std::vector<LcmSize> sizes;        ///< outermost first; empty: no array
  std::vector<std::string> written;  ///< the sizes as the file has them, for the fingerprint
};

/// A struct, as `lcm-gen` would make code of it.
struct LcmStruct {
  std::string name;  ///< with its package
  std::vector<LcmMember> members;
};

/// Structs by name.
using LcmTypes = std::map<std::string, LcmStruct, std::less<>>;

/// Returns whether `type` is one of LCM's own: int8_t, ..., double, string, boolean, byte.
bool is_lcm_primitive(std::string_view type);

/// Reads the text of a `.lcm` file and adds its structs to `types`. Constants are left out. Returns
/// its fault, with the line; empty without one.
std::string read_lcm_types(std::string_view text, LcmTypes& types);

/// Returns the 8 bytes that a message of this struct begins with, as LCM computes them of the names
/// and types of all members (Huang, Olson and Moore 2010, "LCM: Lightweight Communications and
/// Marshalling", section IV-C). Fails with the name of a struct that is not among `types`.
base::Result<std::uint64_t> lcm_fingerprint(const LcmTypes& types, std::string_view name);

}  // namespace camway::tools
