// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>

#include "tools/camway/doctor/doctor.h"

namespace camway::tools {
namespace {

/// Debian's default, for which Camway's bursts are made: room for three messages of full size with
/// the kernel's overhead.
constexpr std::int64_t kNeededBuffer = 212'992;
/// Room for the bursts of a dozen clients at a time.
constexpr std::int64_t kAmpleBuffer = std::int64_t{4} << 20;
/// Clock difference that people notice in the logs of two machines.
constexpr double kClockTolerance_s = 1.0;

std::string url_with_ttl(const LcmNetwork& network, int ttl) {
  return fmt::format("udpm://{}:{}?ttl={}", network.group, network.port, ttl);
}

Finding judge_url(const HostFacts& facts) {
  const LcmNetwork& network = facts.network;
  if (!network.fault.empty()) {
    return {"lcm url", Severity::kProblem, fmt::format("'{}': {}", network.url, network.fault),
            "export LCM_DEFAULT_URL='udpm://239.255.76.67:7667?ttl=0'"};
  }
  if (!network.multicast) {
    return {
        "lcm url", Severity::kNote,
        fmt::format("'{}' is no multicast network; what is said of multicast here does not hold",
                    network.url)};
  }
  return {"lcm url", Severity::kGood, network.url};
}

Finding judge_reach(const HostFacts& facts) {
  const int ttl = facts.network.ttl;
  if (ttl == 0 && facts.other_hosts) {
    return {"ttl", Severity::kProblem, "ttl is 0, so nothing leaves this host",
            fmt::format("export LCM_DEFAULT_URL='{}' for clients, and for the daemon --url or "
                        "lcm.url in its configuration",
                        url_with_ttl(facts.network, 1))};
  }
  if (ttl == 0 && !facts.unguarded.empty()) {
    return {"ttl", Severity::kWarning,
            fmt::format("0: nothing leaves this host, but what others send to it is heard: {}",
                        facts.unguarded),
            fmt::format("sudo ip route add {} dev lo", facts.network.group)};
  }
  if (ttl == 0) return {"ttl", Severity::kGood, "0: traffic stays on this host"};
  if (ttl > 1) {
    return {"ttl", Severity::kWarning,
            fmt::format("{}: traffic passes routers, and LCM has neither passwords nor encryption",
                        ttl),
            fmt::format("export LCM_DEFAULT_URL='{}'", url_with_ttl(facts.network, 1))};
  }
  return {"ttl", facts.other_hosts ? Severity::kGood : Severity::kNote,
          "1: every host of the local network hears and may ask"};
}

Finding judge_route(const HostFacts& facts) {
  const bool far = facts.network.ttl > 0;
  if (!facts.route) {
    return {"multicast route", Severity::kProblem,
            fmt::format("there is no route to {}", facts.network.group),
            far ? "sudo ip route add 224.0.0.0/4 dev DEVICE, with the device of your network"
                : "sudo ip link set lo multicast on && sudo ip route add 224.0.0.0/4 dev lo"};
  }
  const std::string& device = facts.route->device;
  if (!facts.route->multicast) {
    return {"multicast route", Severity::kProblem,
            fmt::format("{} goes out by {}, which does no multicast", facts.network.group, device),
            fmt::format("sudo ip link set {} multicast on", device)};
  }
  if (far && device == "lo") {
    return {"multicast route", Severity::kProblem,
            fmt::format("{} goes out by lo, so no other host hears, whatever the ttl",
                        facts.network.group),
            "sudo ip route replace 224.0.0.0/4 dev DEVICE, with the device of your network"};
  }
  return {"multicast route", Severity::kGood,
          fmt::format("{} goes out by {}", facts.network.group, device)};
}

std::string raise_buffer(std::int64_t bytes) {
  return fmt::format("sudo sysctl -w net.core.rmem_max={0} net.core.rmem_default={0}", bytes);
}

Finding judge_buffer(const HostFacts& facts) {
  constexpr std::string_view kCheck = "receive buffer";
  if (!facts.receive_buffer_bytes || !facts.largest_receive_buffer_bytes) {
    return {kCheck, Severity::kNote, "this machine does not tell its receive buffers"};
  }
  const std::optional<std::int64_t> asked = facts.network.receive_buffer_bytes;
  const std::int64_t largest = *facts.largest_receive_buffer_bytes;
  if (asked && *asked > largest) {
    return {kCheck, Severity::kProblem,
            fmt::format("the url asks for {} bytes, net.core.rmem_max allows {}", *asked, largest),
            fmt::format("sudo sysctl -w net.core.rmem_max={}", *asked)};
  }
  const std::int64_t bytes = asked.value_or(*facts.receive_buffer_bytes);
  if (bytes < kNeededBuffer) {
    return {kCheck, Severity::kProblem,
            fmt::format("{} bytes are less than three messages of full size take ({})", bytes,
                        kNeededBuffer),
            raise_buffer(kAmpleBuffer)};
  }
  if (bytes < kAmpleBuffer) {
    return {kCheck, Severity::kNote,
            fmt::format("{} bytes do for a few clients; with many at a time requests are lost and "
                        "sent again, which {} bytes mend",
                        bytes, kAmpleBuffer),
            raise_buffer(kAmpleBuffer)};
  }
  return {kCheck, Severity::kGood, fmt::format("{} bytes", bytes)};
}

Finding judge_drops(const HostFacts& facts) {
  if (facts.dropped_datagrams == 0) {
    return {"lost datagrams", Severity::kGood,
            "no receive buffer was full since this machine began"};
  }
  return {"lost datagrams", Severity::kWarning,
          fmt::format("{} were dropped since this machine began (by any program), because receive "
                      "buffers were full",
                      facts.dropped_datagrams),
          raise_buffer(kAmpleBuffer)};
}

Finding judge_lcm(const HostFacts& facts) {
  if (facts.lcm_error.empty()) return {"lcm", Severity::kGood, "opens, and hears itself"};
  return {"lcm", Severity::kProblem, facts.lcm_error, "mend what is said above, then ask again"};
}

Finding judge_daemon(const HostFacts& facts) {
  if (!facts.daemon) {
    return {"daemon", Severity::kProblem, "no status of a daemon was heard",
            "systemctl start camwayd, or camwayd --scene NAME=FILE, with the same url and prefix"};
  }
  if (!facts.daemon->is_alone) {
    return {"daemon", Severity::kWarning,
            "more than one is heard; each answers all requests, and clients take the first answer",
            "stop the others, or give each a prefix of its own (camwayd --prefix)"};
  }
  if (facts.daemon->version != facts.own_version) {
    return {"daemon", Severity::kWarning,
            fmt::format("version {}, this is {}", facts.daemon->version, facts.own_version),
            "install the same version on both sides"};
  }
  return {"daemon", Severity::kGood, fmt::format("version {} was heard", facts.daemon->version)};
}

Finding judge_signature(const DaemonFact& daemon) {
  constexpr std::string_view kCheck = "signatures";
  constexpr const char* kGiveKeys = "give the commands and this one --key-file";
  switch (daemon.signature) {
    case Signature::kNone:
      return {kCheck, Severity::kGood, "the daemon signs nothing, and no --key-file was given"};
    case Signature::kUnchecked:
      return {kCheck, Severity::kNote,
              "the daemon signs with keys, and takes what is not signed as well (auth.required is "
              "false); nobody checks that what is heard here is the daemon's",
              kGiveKeys};
    case Signature::kNeeded:
      return {
          kCheck, Severity::kProblem,
          "the daemon has keys (auth.key_file) and drops in silence what is not signed with one "
          "of them, and no --key-file was given",
          kGiveKeys};
    case Signature::kOurs:
      return {kCheck, Severity::kGood, "the daemon signs with a key of --key-file"};
    case Signature::kDistrusted:
      break;
  }
  return {kCheck, Severity::kProblem,
          "the daemon's messages are not signed with a key of --key-file, or its clock is too far "
          "from ours; each side drops in silence what the other says",
          "use the file that auth.key_file of the daemon's configuration names"};
}

Finding judge_clock(const DaemonFact& daemon) {
  if (std::abs(daemon.clock_ahead_s) <= kClockTolerance_s) {
    return {"clocks", Severity::kGood,
            fmt::format("the daemon's is within {:g} s of ours", kClockTolerance_s)};
  }
  return {
      "clocks", Severity::kWarning,
      fmt::format("the daemon's clock is {:.1f} s {} ours; logs of both do not match",
                  std::abs(daemon.clock_ahead_s), daemon.clock_ahead_s > 0 ? "ahead of" : "behind"),
      "sudo timedatectl set-ntp true, on both hosts"};
}

Finding judge_scene_file(const SceneFileFact& scene) {
  const std::string name = fmt::format("scene '{}': {}", scene.scene, scene.file);
  if (!scene.exists) {
    return {"scene files", Severity::kProblem, name + " does not exist",
            "mend `file` of that [[scene]] in the configuration"};
  }
  if (!scene.readable) {
    return {"scene files", Severity::kProblem, name + " cannot be read",
            fmt::format("chmod a+r '{}', and a+x its folders", scene.file)};
  }
  return {"scene files", Severity::kGood, name + " can be read"};
}

}  // namespace

std::string_view to_string(Severity severity) {
  switch (severity) {
    case Severity::kGood:
      return "good";
    case Severity::kNote:
      return "note";
    case Severity::kWarning:
      return "warning";
    case Severity::kProblem:
      return "problem";
  }
  return "";
}

std::vector<Finding> diagnose(const HostFacts& facts) {
  std::vector<Finding> findings{judge_url(facts)};
  if (facts.network.multicast && facts.network.fault.empty()) {
    findings.push_back(judge_reach(facts));
    findings.push_back(judge_route(facts));
    findings.push_back(judge_buffer(facts));
    findings.push_back(judge_drops(facts));
  }
  findings.push_back(judge_lcm(facts));
  findings.push_back(judge_daemon(facts));
  if (facts.daemon) {
    findings.push_back(judge_signature(*facts.daemon));
    findings.push_back(judge_clock(*facts.daemon));
  }
  if (facts.config_file.empty()) return findings;
  for (const std::string& fault : facts.config_faults) {
    findings.push_back({"configuration", Severity::kProblem, fault,
                        facts.config_is_readable ? "mend that line of the file"
                                                 : "name a file with settings that can be read"});
  }
  if (facts.config_faults.empty()) {
    findings.push_back({"configuration", Severity::kGood, facts.config_file + " is right"});
  }
  for (const SceneFileFact& scene : facts.scene_files) findings.push_back(judge_scene_file(scene));
  return findings;
}

}  // namespace camway::tools
