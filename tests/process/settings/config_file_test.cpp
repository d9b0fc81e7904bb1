// SPDX-License-Identifier: MIT
#include "daemon/process/settings/config_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <utility>

#include <toml++/toml.h>

#include "daemon/process/settings/bounds_text.h"
#include "daemon/process/settings/daemon_settings.h"
#include "tests/support/temporary_folder.h"

namespace camway::process {
namespace {

/// Reads texts as configuration files.
class ConfigFile : public ::testing::Test {
 protected:
  std::vector<std::string> read(const std::string& text) {
    return read_config_file(temporary_.write("c.toml", text), options_);
  }

  testing::TemporaryFolder temporary_;
  const std::filesystem::path& folder_ = temporary_.path();
  DaemonOptions options_ = default_options();
};

std::string sample() {
  std::ostringstream text;
  text << std::ifstream(CAMWAYD_SAMPLE_CONFIG).rdbuf();
  return text.str();
}

TEST_F(ConfigFile, TheSampleNamesEverySettingWithItsDefault) {
  std::set<std::string> named;
  for (const auto& [table, node] : toml::parse(sample())) {
    if (table == "scene") continue;
    for (const auto& [key, value] : *node.as_table()) {
      named.insert(std::string(table.str()) + "." + std::string(key.str()));
    }
  }
  std::set<std::string> settings;
  for (const Setting& setting : settings_of(options_)) settings.insert(std::string(setting.key));
  EXPECT_EQ(named, settings);

  unsetenv("LCM_DEFAULT_URL");
  options_ = default_options();
  EXPECT_EQ(read(sample()), std::vector<std::string>{});
  for (const SettingChange& change : changes_between(default_options(), options_)) {
    ADD_FAILURE() << change.key << " is " << change.before << ", but in the sample "
                  << change.after;
  }
}

TEST_F(ConfigFile, TheSceneOfTheSampleIsThere) {
  ASSERT_EQ(read_config_file(CAMWAYD_SAMPLE_CONFIG, options_), std::vector<std::string>{});
  ASSERT_EQ(options_.scenes.size(), 1U);
  EXPECT_EQ(options_.scenes[0].name, "office");
  EXPECT_TRUE(std::filesystem::is_regular_file(options_.scenes[0].file)) << options_.scenes[0].file;
  EXPECT_EQ(options_.scenes[0].options.import.scale, 1.0);
  EXPECT_EQ(options_.scenes[0].options.import.up, scene::UpAxis::kAsInFile);
  EXPECT_EQ(options_.scenes[0].options.occupancy_resolution_m, 0.1);
  EXPECT_FALSE(options_.scenes[0].options.bounds.any());
  EXPECT_FALSE(options_.scenes[0].watch);
  ASSERT_EQ(read("[[scene]]\nname = \"a\"\nfile = \"f\"\nwatch = true\n"),
            std::vector<std::string>{});
  EXPECT_TRUE(options_.scenes.back().watch);
  EXPECT_FALSE(options_.scenes.back().options.import.voxel_m);
  ASSERT_EQ(read("[[scene]]\nname = \"b\"\nfile = \"f\"\nvoxel_m = 0.02\n"),
            std::vector<std::string>{});
  EXPECT_EQ(options_.scenes.back().options.import.voxel_m, 0.02);
  EXPECT_FALSE(options_.scenes.back().options.bounds.any());
  EXPECT_THAT(read("[[scene]]\nname = \"a\"\nfile = \"f\"\nbounds = \"2..1/../..\"\n"),
              ::testing::ElementsAre(::testing::HasSubstr("bounds '2..1/../..': min[0]")));
}

TEST_F(ConfigFile, EverySettingIsNamedWhereItsValueIsWrong) {
  const auto expect_named = [&](const std::string& head, const std::string& key,
                                const std::string& value) {
    const std::vector<std::string> faults = read(head + "\n" + key + " = " + value + "\n");
    const bool named = std::any_of(faults.begin(), faults.end(), [&](const std::string& fault) {
      return fault.find("c.toml:2: ") != std::string::npos && fault.find(key) != std::string::npos;
    });
    EXPECT_TRUE(named) << key << " = " << value << ::testing::PrintToString(faults);
  };
  for (const Setting& setting : settings_of(options_)) {
    const std::size_t dot = setting.key.find('.');
    const std::string head = "[" + std::string(setting.key.substr(0, dot)) + "]";
    const std::string key(setting.key.substr(dot + 1));
    for (const char* value : {"[]", "{}", "1979-05-27", "nan", "-inf", "-1"}) {
      expect_named(head, key, value);
    }
    if (!setting.is_text()) expect_named(head, key, "\"a\"");
    if (!setting.is_switch()) expect_named(head, key, "true");
  }
  for (const char* key :
       {"name", "file", "scale", "up", "unknown", "voxel_m", "occupancy_resolution_m", "watch"}) {
    for (const char* value : {"[]", "{}", "1979-05-27", "nan", "-1"}) {
      expect_named("[[scene]]", key, value);
    }
  }
}

TEST_F(ConfigFile, FaultsNameFileLineAndKey) {
  const std::vector<std::pair<std::string, std::string>> table{
      {"[queue\n", ":1: "},
      {"[lcm]\nprefix = \"no blanks\"\n", ":2: lcm.prefix: 'no blanks' is not of 1 to 11 letters"},
      {"[lcm]\nurl = \"bogus://\"\n", ":2: lcm.url: must begin with a provider"},
      {"[lcm]\nurl = \"udpm://239.255.76.67:99999\"\n", ":2: lcm.url: port '99999'"},
      {"[lcm]\nurl = \"udpm://239.255.76.67:7667?ttl=abc\"\n", ":2: lcm.url: ttl 'abc'"},
      {"[lcm]\nurl = \"udpm://10.0.0.1:7667\"\n", ":2: lcm.url: '10.0.0.1' is no multicast"},
      {"[metrics]\naddress = \"localhost\"\n", ":2: metrics.address: must be an IPv4 or IPv6"},
      {"[[scene]]\nname = \"a\"\nfile = \"f\"\noccupancy_resolution_m = 1e-10\n",
       ":4: scene.occupancy_resolution_m: must be from 1e-9"},
      {"\nqueue = 1\n", ":2: 'queue' must be a table"},
      {"[lcm]\n\n[qeue]\nrequests = 1\n",
       ":3: 'qeue' is no setting; the file has auth, fleet, lcm, "},
      {"[queue]\nlenght = 5\n",
       ":2: 'queue.lenght' is no setting; [queue] has answer_bytes, answer_pages, answers, "
       "answers_of_a_client, malformed_answers_per_s, newcomers_count_as, refusals, "
       "remembered_clients, request_bytes, requests, requests_of_a_client"},
      {"[queue]\nrequests = 0\n", ":2: queue.requests: must be within 1 to 100000"},
      {"[queue]\nrequests = 1.5\n", ":2: queue.requests: must be a whole number"},
      {"[queue]\nrequests = \"5\"\n", ":2: queue.requests: must be a whole number"},
      {"[planning]\ndeadline_s = nan\n", ":2: planning.deadline_s: must be within"},
      {"[planning]\ndeadline_s = \"1\"\n", ":2: planning.deadline_s: must be a number"},
      {"[auth]\nrequired = 0\n", ":2: auth.required: must be true or false"},
      {"[log]\nlevel = 3\n", ":2: log.level: must be a text"},
      {"[log]\nlevel = \"loud\"\n", ":2: log.level: must be one of trace, "},
      {"[log]\nlevel = \"info\"\nlevel = \"info\"\n", ":3: "},
      {"scene = 1\n", ":1: scene: must be tables"},
      {"[scene]\nname = \"a\"\n", ":1: scene: must be tables"},
      {"[[scene]]\nfile = \"a.obj\"\n", "[[scene]]: 'name' is missing"},
      {"[[scene]]\nname = \"a\"\n", "[[scene]]: 'file' is missing"},
      {"[[scene]]\nname = \"a b\"\nfile = \"f\"\n", ":2: scene.name: must be of letters"},
      {"[[scene]]\nname = \"a\"\nfile = \"\"\n", ":3: scene.file: must name a file"},
      {"[[scene]]\nname = \"a\"\nfile = \"f\"\nscale = 0\n", ":4: scene.scale: must be a number"},
      {"[[scene]]\nname = \"a\"\nfile = \"f\"\nup = \"x\"\n", ":4: scene.up: must be as-in-file"},
      {"[[scene]]\nname = \"a\"\nfile = \"f\"\nwatch = 1\n", ":4: scene.watch: must be true or"},
      {"[[scene]]\nname = \"a\"\nfile = \"f\"\ncolour = 1\n", ":4: 'colour' is no setting of a"},
      {"[[scene]]\nname = \"a\"\nfile = \"f\"\n[[scene]]\nname = \"a\"\nfile = \"g\"\n",
       ":4: scene.name: 'a' is there twice"},
  };
  for (const auto& [text, fault] : table) {
    options_ = default_options();
    const std::vector<std::string> faults = read(text);
    ASSERT_EQ(faults.size(), 1U) << text << ::testing::PrintToString(faults);
    EXPECT_EQ(faults[0].find((folder_ / "c.toml").string() + ":"), 0U) << faults[0];
    EXPECT_NE(faults[0].find(fault), std::string::npos) << faults[0];
  }
}

TEST_F(ConfigFile, SaysWhereEachValueWasSaid) {
  ASSERT_TRUE(read("[queue]\nrequests = 7\n\n[[scene]]\nname = \"a\"\nfile = \"f\"\n").empty());
  const std::string file = (folder_ / "c.toml").string();
  EXPECT_EQ(options_.where("queue.requests"), file + ":2: queue.requests");
  EXPECT_EQ(options_.where("queue.answers"), "queue.answers") << "it is the default";
  EXPECT_EQ(options_.scenes.at(0).set_at, file + ":6");
}

TEST_F(ConfigFile, SwitchesAreTrueOrFalse) {
  EXPECT_TRUE(options_.auth.required);
  EXPECT_TRUE(read("[auth]\nrequired = false\n").empty());
  EXPECT_FALSE(options_.auth.required);
}

TEST_F(ConfigFile, AllFaultsComeInTheOrderOfTheirLines) {
  const std::vector<std::string> faults =
      read("[queue]\nrequests = 0\n[lcm]\nurls = \"\"\n[log]\nlevel = \"loud\"\n");
  ASSERT_EQ(faults.size(), 3U);
  EXPECT_NE(faults[0].find(":2: "), std::string::npos);
  EXPECT_NE(faults[1].find(":4: "), std::string::npos);
  EXPECT_NE(faults[2].find(":6: "), std::string::npos);
}

TEST_F(ConfigFile, RelativePathsAreRelativeToTheFolderOfTheFile) {
  ASSERT_EQ(read("[scenes]\nroots = \"a:/b/c:../d\"\n[auth]\nkey_file = \"keys:1\"\n"
                 "[[scene]]\nname = \"s\"\nfile = \"s.obj\"\n"),
            std::vector<std::string>{});
  const std::string folder = folder_.string() + "/";
  EXPECT_EQ(options_.scene_roots, folder + "a:/b/c:" + folder + "../d");
  EXPECT_EQ(options_.auth.key_file, folder + "keys:1") << "it is one file";
  EXPECT_EQ(options_.scenes.at(0).file, folder + "s.obj");

  ASSERT_EQ(read("[scenes]\nroots = \"\"\n[auth]\nkey_file = \"/etc/keys\"\n"),
            std::vector<std::string>{});
  EXPECT_EQ(options_.scene_roots, "");
  EXPECT_EQ(options_.auth.key_file, "/etc/keys");
}

TEST_F(ConfigFile, WhatCannotBeReadIsAFaultThatSaysWhy) {
  { const std::ofstream empty(folder_ / "empty.toml"); }
  const std::pair<std::filesystem::path, const char*> kFiles[] = {
      {folder_ / "missing.toml", ": cannot be opened: No such file or directory"},
      {folder_ / "empty.toml", ": is empty"},
      {folder_, ": is a folder"}};
  for (const auto& [file, reason] : kFiles) {
    const std::vector<std::string> faults = read_config_file(file, options_);
    ASSERT_EQ(faults.size(), 1U) << file;
    EXPECT_EQ(faults[0], file.string() + reason);
  }
}

}  // namespace
}  // namespace camway::process
