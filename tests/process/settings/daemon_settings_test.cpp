// SPDX-License-Identifier: MIT
#include "daemon/process/settings/daemon_settings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace camway::process {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(DaemonSettings, NumbersKeepTheirRangeAndComeBackAsText) {
  DaemonOptions options = default_options();
  for (const Setting& setting : settings_of(options)) {
    if (setting.is_text() || setting.is_switch()) continue;
    const std::string before = setting.text();
    for (const double bad :
         {std::nextafter(setting.least, -kInfinity), std::nextafter(setting.most, kInfinity),
          kInfinity, -kInfinity, std::numeric_limits<double>::quiet_NaN()}) {
      EXPECT_NE(setting.set(bad), "") << setting.key << ' ' << bad;
      EXPECT_EQ(setting.text(), before) << setting.key;
    }
    for (const double good : {setting.least, setting.most}) {
      EXPECT_EQ(setting.set(good), "") << setting.key << ' ' << good;
      EXPECT_NEAR(std::stod(setting.text()), good, 5e-4) << "milliseconds: " << setting.key;
    }
  }
}

TEST(DaemonSettings, DefaultsAreWithinTheirRanges) {
  DaemonOptions options = default_options();
  for (const Setting& setting : settings_of(options)) {
    if (setting.is_text() || setting.is_switch()) continue;
    EXPECT_EQ(setting.set(std::stod(setting.text())), "") << setting.key;
  }
}

TEST(DaemonSettings, EveryLogLevelHasAName) {
  DaemonOptions options = default_options();
  for (const Setting& setting : settings_of(options)) {
    if (setting.key != "log.level") continue;
    for (std::size_t i = 0; i < service::kLogLevels.size(); ++i) {
      EXPECT_EQ(setting.set(service::kLogLevels[i]), "");
      EXPECT_EQ(options.log_level, static_cast<service::LogLevel>(i));
      EXPECT_EQ(setting.text(), '"' + std::string(service::kLogLevels[i]) + '"');
    }
    EXPECT_NE(setting.set("loud").find("trace, debug, info, warn, error, off"), std::string::npos);
  }
}

TEST(DaemonSettings, ChangesNameTheKeyBothValuesAndWhetherTheyReload) {
  DaemonOptions after = default_options();
  after.log_level = service::LogLevel::kDebug;
  after.service.heartbeat_period = std::chrono::milliseconds(250);
  const std::vector<SettingChange> changes = changes_between(default_options(), after);
  ASSERT_EQ(changes.size(), 2U);
  EXPECT_EQ(changes[0].key, "status.period_s");
  EXPECT_EQ(changes[0].before, "1");
  EXPECT_EQ(changes[0].after, "0.25");
  EXPECT_FALSE(changes[0].reloads);
  EXPECT_EQ(changes[1].key, "log.level");
  EXPECT_EQ(changes[1].after, "\"debug\"");
  EXPECT_TRUE(changes[1].reloads);
}

}  // namespace
}  // namespace camway::process
