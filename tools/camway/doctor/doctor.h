// SPDX-License-Identifier: MIT
#pragma once

#include <camway/authentication.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/service/transport/lcm_url.h"

/// What keeps Camway from working on a machine: facts, gathered in one place, and what they mean,
/// judged in another, so that machines that nobody has at hand can be judged too.
namespace camway::tools {

using service::LcmNetwork;

/// The device by which a machine would send to the group.
struct MulticastRoute {
  std::string device;
  bool multicast = true;  ///< the device's flag
};

/// A scene file that the configuration names.
struct SceneFileFact {
  std::string scene;
  std::string file;
  bool exists = false;
  bool readable = false;
};

/// How a daemon's messages and our keys go together.
enum class Signature {
  kNone,       ///< not signed, and we have no keys
  kUnchecked,  ///< signed, and we have no keys; the daemon takes unsigned messages, too
  kNeeded,     ///< the same, but it drops what is not signed
  kOurs,       ///< signed with one of ours
  kDistrusted  ///< we have keys, and clients with them drop it
};

/// The daemon's last status.
struct DaemonFact {
  std::string version;
  double clock_ahead_s = 0.0;  ///< of ours, transport included
  bool is_alone = true;        ///< until its next status nothing was heard of another one
  Signature signature = Signature::kNone;
};

struct HostFacts {
  LcmNetwork network;
  bool other_hosts = false;  ///< daemon and clients are to be on several hosts
  std::string own_version;
  std::optional<MulticastRoute> route;               ///< nothing: the group cannot be reached
  std::optional<std::int64_t> receive_buffer_bytes;  ///< net.core.rmem_default
  std::optional<std::int64_t> largest_receive_buffer_bytes;  ///< net.core.rmem_max
  std::int64_t dropped_datagrams = 0;  ///< since boot, for want of room in receive buffers
  std::string lcm_error;               ///< why LCM cannot be opened; empty when it can
  std::string unguarded;               ///< why other hosts are heard though ttl is 0; else empty
  std::optional<DaemonFact> daemon;    ///< nothing: none was heard
  std::string config_file;             ///< empty: none was named
  std::vector<std::string> config_faults;
  std::vector<SceneFileFact> scene_files;
};

enum class Severity {
  kGood,
  kNote,     ///< works, but somebody may want to know
  kWarning,  ///< works now, may not always
  kProblem,  ///< does not work
};
std::string_view to_string(Severity severity);

struct Finding {
  std::string_view check;
  Severity severity = Severity::kGood;
  std::string text;
  std::string mend = {};  ///< a command, or what to change; empty where there is nothing to mend
};

/// What `facts` mean, a finding for each check at least, in the order of the checks. Safe from any
/// thread.
std::vector<Finding> diagnose(const HostFacts& facts);

struct DoctorQuestions {
  std::string url;
  std::string prefix = "CAMWAY";
  std::string config_file;
  bool other_hosts = false;
  double timeout_s = 3.0;                                ///< how long to listen for a daemon
  std::shared_ptr<const Authentication> authentication;  ///< null: we have no keys
};

/// Looks at this machine. Changes nothing.
HostFacts gather_facts(const DoctorQuestions& questions);

}  // namespace camway::tools
