// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace camway::view {

/// Returns 128 random bits of the kernel as 32 hexadecimal digits; empty if it gives none.
std::string random_token();

/// Returns whether both texts are equal. Its time depends on their lengths alone, so that it does
/// not tell how many characters of a guess are right.
bool is_same_secret(std::string_view a, std::string_view b);

}  // namespace camway::view
