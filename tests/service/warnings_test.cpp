// SPDX-License-Identifier: MIT
#include "daemon/service/warnings.h"

#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>

#include <sstream>

namespace camway::service {
namespace {

using namespace std::chrono_literals;

TEST(Warnings, OneLineInAPeriodWithTheNumberLeftOut) {
  std::ostringstream text;
  const auto sink = std::make_shared<spdlog::sinks::ostream_sink_st>(text);
  const auto log = std::make_shared<spdlog::logger>("test", sink);
  log->set_pattern("%v");
  Warnings warnings(log, 5s);
  const Warnings::Clock::time_point begin{};
  warnings.warn("one", begin);
  warnings.warn("two", begin + 1s);
  warnings.warn("three", begin + 4999ms);
  warnings.warn("four", begin + 5s);
  warnings.warn("five", begin + 10s);
  EXPECT_EQ(text.str(), "one\nfour (2 more like this since the last line)\nfive\n");
  EXPECT_EQ(warnings.total(), 5);
}

}  // namespace
}  // namespace camway::service
