// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/integration/fixture.h"

namespace camway::integration {
namespace {

using ::testing::HasSubstr;

class MalformedTest : public IntegrationTest {};

/// The program judges stalls and memory too, which a machine that is busy with other tests does not
/// allow.
TEST_F(MalformedTest, ADaemonAnswersInTheMidstOfMalformedMessages) {
  start_daemon();
  Process flood({MALFORMED_FLOOD_BINARY, std::to_string(daemon().pid()), "20000"},
                file("flood.log"));
  EXPECT_NE(flood.wait().value_or(2), 2) << flood.output();
  EXPECT_THAT(flood.output(), HasSubstr("20000 counted by the daemon"));
  EXPECT_THAT(flood.output(), HasSubstr("0 unanswered"));
  EXPECT_TRUE(Client(patient()).plan(request_of("office-free-door", "office")).ok());
  EXPECT_THAT(daemon().output(), HasSubstr("lines left out kind=malformed"));
}

}  // namespace
}  // namespace camway::integration
