// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace camway::testing {

/// Names a case of a parameterised test after its member `name`; the last argument of
/// INSTANTIATE_TEST_SUITE_P.
inline constexpr auto name_of_case = [](const auto& info) { return std::string(info.param.name); };

}  // namespace camway::testing
