// SPDX-License-Identifier: MIT
#include "daemon/service/log.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

namespace camway::service {
namespace {

TEST(Log, TextHasAFactAfterTheOther) {
  std::ostringstream out;
  Log log(out, LogFormat::kText, LogLevel::kInfo);
  log.info(
      "answered",
      {{"client", "a-b"}, {"request", -7}, {"ms", 1.5}, {"message", "no \"way\""}, {"none", ""}});
  EXPECT_TRUE(std::regex_match(
      out.str(),
      std::regex(R"(\[\d{4}-\d\d-\d\d \d\d:\d\d:\d\d\.\d{3}\] \[camwayd\] \[info\] answered )"
                 R"(client=a-b request=-7 ms=1.5 message="no \\"way\\"" none=""\n)")))
      << out.str();
}

TEST(Log, JsonIsAnObjectOnEachLine) {
  std::ostringstream out;
  Log log(out, LogFormat::kJson, LogLevel::kInfo);
  log.info("answered", {{"client", "a\n\"b"}, {"request", -7}, {"ms", 1.5}});
  log.error("bad \xff bytes");
  std::istringstream lines(out.str());
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  auto json = nlohmann::json::parse(line);
  EXPECT_EQ(json.at("level"), "info");
  EXPECT_EQ(json.at("event"), "answered");
  EXPECT_EQ(json.at("client"), "a\n\"b");
  EXPECT_EQ(json.at("request"), -7);
  EXPECT_EQ(json.at("ms"), 1.5);
  EXPECT_TRUE(
      std::regex_match(json.at("time").get<std::string>(),
                       std::regex(R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}[+-]\d\d:\d\d)")));
  ASSERT_TRUE(std::getline(lines, line));
  EXPECT_EQ(nlohmann::json::parse(line).at("level"), "error");
  EXPECT_FALSE(std::getline(lines, line));
}

TEST(Log, GoesOnWhenTheDiskWasFull) {
  std::ostringstream out;
  Log log(out, LogFormat::kText, LogLevel::kInfo);
  out.setstate(std::ios::badbit | std::ios::failbit);
  log.info("there is room again");
  EXPECT_NE(out.str().find("there is room again\n"), std::string::npos) << out.str();
}

TEST(Log, NobodyForgesALine) {
  for (const LogFormat format : {LogFormat::kText, LogFormat::kJson}) {
    std::ostringstream out;
    Log log(out, format, LogLevel::kInfo);
    log.info("a\nb\x1b[2J", {{"key", "c\r\nd\x7f"}});
    const std::string text = out.str();
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
    EXPECT_EQ(text.find('\x1b'), std::string::npos);
  }
}

TEST(Log, LevelsAreHeeded) {
  std::ostringstream out;
  Log log(out, LogFormat::kText, LogLevel::kWarn);
  EXPECT_EQ(log.level(), LogLevel::kWarn);
  log.info("quiet");
  EXPECT_EQ(out.str(), "");
  log.set_level(LogLevel::kOff);
  log.error("quiet");
  EXPECT_EQ(out.str(), "");
  log.set_level(LogLevel::kInfo);
  log.info("loud");
  EXPECT_NE(out.str().find("loud"), std::string::npos);
}

TEST(Log, LinesOfSeveralThreadsStayWhole) {
  std::ostringstream out;
  Log log(out, LogFormat::kJson, LogLevel::kInfo);
  {
    std::vector<std::jthread> threads;
    for (int thread = 0; thread < 4; ++thread) {
      threads.emplace_back([&, thread] {
        for (int i = 0; i < 500; ++i) log.info("line", {{"thread", thread}, {"number", i}});
      });
    }
  }
  std::istringstream lines(out.str());
  int whole = 0;
  for (std::string line; std::getline(lines, line);) {
    if (nlohmann::json::accept(line)) ++whole;
  }
  EXPECT_EQ(whole, 2000);
}

}  // namespace
}  // namespace camway::service
