// SPDX-License-Identifier: MIT
#include "tools/camway/doctor/doctor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

namespace camway::tools {
namespace {

using ::testing::HasSubstr;

/// Returns the facts of a machine without problems.
HostFacts healthy() {
  HostFacts facts;
  facts.network = service::parse_lcm_url("udpm://239.255.76.67:7667?ttl=0");
  facts.own_version = "1.2.3";
  facts.route = MulticastRoute{"lo", true};
  facts.receive_buffer_bytes = 8 << 20;
  facts.largest_receive_buffer_bytes = 8 << 20;
  facts.daemon = DaemonFact{"1.2.3", 0.01};
  facts.config_file = "camwayd.toml";
  facts.scene_files = {{"room", "/room.obj", true, true}};
  return facts;
}

TEST(Doctor, FindsNothingOnAHealthyMachine) {
  for (const Finding& finding : diagnose(healthy())) {
    EXPECT_EQ(finding.severity, Severity::kGood) << finding.check << ": " << finding.text;
    EXPECT_EQ(finding.mend, "") << finding.check;
  }
}

struct Illness {
  std::function<void(HostFacts&)> make;
  std::string check;
  Severity severity;
  std::string text;
  std::string mend;
};

std::vector<Illness> illnesses() {
  const auto url = [](const char* text) {
    return [text](HostFacts& facts) { facts.network = service::parse_lcm_url(text); };
  };
  return {
      {url("239.255.76.67"), "lcm url", Severity::kProblem, "must begin with a provider", "export"},
      {url("udpm://239.255.76.67:99999"), "lcm url", Severity::kProblem, "port", "export"},
      {url("udpm://239.255.76.67:7667?ttl=300"), "lcm url", Severity::kProblem, "ttl '300'",
       "export"},
      {url("memq://"), "lcm url", Severity::kNote, "no multicast network", ""},
      {[](HostFacts& facts) {
         facts.network.ttl = 9;
         facts.route = MulticastRoute{"eth0", true};
       },
       "ttl", Severity::kWarning, "passes routers", "udpm://239.255.76.67:7667?ttl=1"},
      {[](HostFacts& facts) { facts.unguarded = "Operation not permitted"; }, "ttl",
       Severity::kWarning, "what others send to it is heard: Operation not permitted",
       "ip route add 239.255.76.67 dev lo"},
      {[](HostFacts& facts) { facts.other_hosts = true; }, "ttl", Severity::kProblem,
       "nothing leaves this host", "udpm://239.255.76.67:7667?ttl=1"},
      {[](HostFacts& facts) { facts.route.reset(); }, "multicast route", Severity::kProblem,
       "no route to 239.255.76.67", "sudo ip route add 224.0.0.0/4 dev lo"},
      {[](HostFacts& facts) {
         facts.network.ttl = 1;
         facts.route.reset();
       },
       "multicast route", Severity::kProblem, "no route", "dev DEVICE"},
      {[](HostFacts& facts) {
         facts.route = MulticastRoute{"eth0", false};
       },
       "multicast route", Severity::kProblem, "eth0, which does no multicast",
       "sudo ip link set eth0 multicast on"},
      {[](HostFacts& facts) { facts.network.ttl = 1; }, "multicast route", Severity::kProblem,
       "no other host hears", "sudo ip route replace"},
      {[](HostFacts& facts) { facts.receive_buffer_bytes = 212'991; }, "receive buffer",
       Severity::kProblem, "212991 bytes are less", "sudo sysctl -w net.core.rmem_max="},
      {[](HostFacts& facts) { facts.receive_buffer_bytes = 212'992; }, "receive buffer",
       Severity::kNote, "do for a few clients", "sudo sysctl -w net.core.rmem_max="},
      {url("udpm://239.255.76.67:7667?recv_buf_size=100000000"), "receive buffer",
       Severity::kProblem, "net.core.rmem_max allows 8388608",
       "sudo sysctl -w net.core.rmem_max=100000000"},
      {url("udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4096"), "receive buffer",
       Severity::kProblem, "4096 bytes are less", "sudo sysctl"},
      {[](HostFacts& facts) { facts.largest_receive_buffer_bytes.reset(); }, "receive buffer",
       Severity::kNote, "does not tell", ""},
      {[](HostFacts& facts) { facts.dropped_datagrams = 12; }, "lost datagrams", Severity::kWarning,
       "12 were dropped", "sudo sysctl"},
      {[](HostFacts& facts) { facts.lcm_error = "LCM cannot be opened"; }, "lcm",
       Severity::kProblem, "LCM cannot be opened", "mend what is said above"},
      {[](HostFacts& facts) { facts.daemon.reset(); }, "daemon", Severity::kProblem,
       "no status of a daemon", "systemctl start camwayd"},
      {[](HostFacts& facts) { facts.daemon->is_alone = false; }, "daemon", Severity::kWarning,
       "more than one is heard", "--prefix"},
      {[](HostFacts& facts) { facts.daemon->version = "1.2.2"; }, "daemon", Severity::kWarning,
       "version 1.2.2, this is 1.2.3", "install the same version"},
      {[](HostFacts& facts) { facts.daemon->signature = Signature::kUnchecked; }, "signatures",
       Severity::kNote, "takes what is not signed as well", "--key-file"},
      {[](HostFacts& facts) { facts.daemon->signature = Signature::kNeeded; }, "signatures",
       Severity::kProblem, "drops in silence what is not signed", "--key-file"},
      {[](HostFacts& facts) { facts.daemon->signature = Signature::kDistrusted; }, "signatures",
       Severity::kProblem, "not signed with a key of --key-file", "auth.key_file"},
      {[](HostFacts& facts) { facts.daemon->clock_ahead_s = 90.0; }, "clocks", Severity::kWarning,
       "90.0 s ahead of ours", "timedatectl"},
      {[](HostFacts& facts) { facts.daemon->clock_ahead_s = -90.0; }, "clocks", Severity::kWarning,
       "90.0 s behind ours", "timedatectl"},
      {[](HostFacts& facts) { facts.config_faults = {"c.toml:3: no"}; }, "configuration",
       Severity::kProblem, "c.toml:3: no", "mend that line"},
      {[](HostFacts& facts) {
         facts.config_is_readable = false;
         facts.config_faults = {"c.toml: cannot be opened"};
       },
       "configuration", Severity::kProblem, "c.toml: cannot be opened",
       "name a file with settings"},
      {[](HostFacts& facts) { facts.scene_files[0].exists = false; }, "scene files",
       Severity::kProblem, "'room': /room.obj does not exist", "mend `file`"},
      {[](HostFacts& facts) { facts.scene_files[0].readable = false; }, "scene files",
       Severity::kProblem, "cannot be read", "chmod a+r '/room.obj'"},
  };
}

TEST(Doctor, FindsEveryIllnessAndHowToMendIt) {
  for (const Illness& illness : illnesses()) {
    SCOPED_TRACE(illness.text);
    HostFacts facts = healthy();
    illness.make(facts);
    const std::vector<Finding> findings = diagnose(facts);
    const auto found = std::find_if(findings.begin(), findings.end(), [&](const Finding& finding) {
      return finding.check == illness.check;
    });
    ASSERT_NE(found, findings.end());
    EXPECT_EQ(to_string(found->severity), to_string(illness.severity)) << found->text;
    EXPECT_THAT(found->text, HasSubstr(illness.text));
    EXPECT_THAT(found->mend, HasSubstr(illness.mend));
    // One problem is not taken for another; some networks without multicast hide other checks.
    for (const Finding& finding : findings) {
      if (finding.check != illness.check && finding.check != "ttl") {
        EXPECT_EQ(to_string(finding.severity), "good") << finding.check << ": " << finding.text;
      }
    }
  }
}

}  // namespace
}  // namespace camway::tools
