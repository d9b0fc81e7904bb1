// SPDX-License-Identifier: MIT
#include "daemon/service/log/log.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <regex>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/support/random.h"

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

/// Returns the text between the quotes of `value="..."`, without escapes.
std::string unescaped(const std::string& line) {
  std::string text;
  const std::size_t begin = line.find("value=\"") + 7;
  for (std::size_t i = begin; i + 2 < line.size(); ++i) {
    if (line[i] != '\\') {
      text += line[i];
    } else if (line[++i] == 'x') {
      text += static_cast<char>(std::stoi(line.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      text += line[i] == 'n' ? '\n' : line[i];
    }
  }
  return text;
}

TEST(Log, TextBeyondAsciiIsKeptIfItIsTextAndNothingIsLost) {
  const auto line_of = [](const std::string& value) {
    std::ostringstream out;
    Log log(out, LogFormat::kText, LogLevel::kInfo);
    log.info("event", {{"value", value}});
    return out.str().substr(out.str().find("event"));
  };
  EXPECT_EQ(line_of("Büro 間 \U0001F3A5"), "event value=\"Büro 間 \U0001F3A5\"\n");
  EXPECT_EQ(line_of("\u0085"), "event value=\"\\xc2\\x85\"\n") << "a new line to some";
  EXPECT_EQ(line_of("\u202Ea"), "event value=\"\\xe2\\x80\\xaea\"\n") << "written backwards";
  EXPECT_EQ(line_of("\xed\xa0\x80"), "event value=\"\\xed\\xa0\\x80\"\n") << "a surrogate";
  EXPECT_EQ(line_of("\xc0\xaf\xe2\x82"), "event value=\"\\xc0\\xaf\\xe2\\x82\"\n");

  constexpr std::uint64_t kSeed = 20261122;
  testing::Random random(kSeed);
  const std::string starts =
      "a\"\\\n\x1b\x80\xbf\xc2\xdf\xe0\xa0\xed\x9f\xe2\xef\xf0\x90\xf4\x8f\xff";
  for (int trial = 0; trial < 20'000; ++trial) {
    std::string text = "=";  // so that it is quoted
    for (std::size_t size = random() % 8; size > 0; --size) {
      text += random() % 4 == 0 ? static_cast<char>(random()) : starts[random() % starts.size()];
    }
    const std::string line = line_of(text);
    ASSERT_EQ(unescaped(line), text) << "trial " << trial;
    // Throws if a string is not well-formed UTF-8.
    ASSERT_NO_THROW((void)nlohmann::json(line).dump()) << "trial " << trial;
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
