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

/// The diagnosis of a machine on which Camway does not work. `gather_facts` collects facts and
/// `diagnose` judges them, so that tests can judge machines that are not at hand.
namespace camway::tools {

using service::LcmNetwork;

/// The network device of the route to the multicast group.
struct MulticastRoute {
  std::string device;
  bool multicast = true;  ///< whether the device has the flag MULTICAST
};

/// A scene file that the configuration names.
struct SceneFileFact {
  std::string scene;
  std::string file;
  bool exists = false;
  bool readable = false;
};

/// The match of a daemon's signatures and the keys of this command.
enum class Signature {
  kNone,       ///< the daemon does not sign, and there are no keys here
  kUnchecked,  ///< the daemon signs but accepts unsigned messages, and there are no keys here
  kNeeded,     ///< the daemon signs and drops unsigned messages, and there are no keys here
  kOurs,       ///< the daemon signs with a key that is known here
  kDistrusted  ///< there are keys here, and the daemon's messages do not pass their check
};

/// Facts from the status of a daemon.
struct DaemonFact {
  std::string version;
  double clock_ahead_s = 0.0;  ///< daemon's clock minus the local clock, transmission included
  bool is_alone = true;        ///< whether no other daemon was heard until its next status
  Signature signature = Signature::kNone;
};

struct HostFacts {
  LcmNetwork network;
  bool other_hosts = false;  ///< whether daemon and clients shall be on several hosts
  std::string own_version;
  std::optional<MulticastRoute> route;                       ///< unset: the group cannot be reached
  std::optional<std::int64_t> receive_buffer_bytes;          ///< net.core.rmem_default
  std::optional<std::int64_t> largest_receive_buffer_bytes;  ///< net.core.rmem_max
  std::int64_t dropped_datagrams = 0;  ///< dropped since boot because receive buffers were full
  std::string lcm_error;               ///< reason why LCM cannot be opened; empty if it can
  std::string unguarded;             ///< reason why other hosts are heard though ttl is 0, or empty
  std::optional<DaemonFact> daemon;  ///< unset: none was heard
  std::string config_file;           ///< empty: none was given
  bool config_is_readable = true;
  std::vector<std::string> config_faults;  ///< faults of that file
  std::vector<SceneFileFact> scene_files;  ///< scenes that it names
};

enum class Severity {
  kGood,
  kNote,     ///< works; a remark
  kWarning,  ///< works now, but may fail
  kProblem,  ///< does not work
};
std::string_view to_string(Severity severity);

struct Finding {
  std::string_view check;
  Severity severity = Severity::kGood;
  std::string text;
  std::string mend = {};  ///< remedy: a command, or what to change; empty if none is needed
};

/// Returns the findings from `facts`, at least one for each check, in the order of the checks.
/// Thread-safe.
std::vector<Finding> diagnose(const HostFacts& facts);

struct DoctorOptions {
  std::string url;
  std::string prefix = "CAMWAY";
  std::string config_file;
  bool other_hosts = false;
  double timeout_s = 3.0;                                ///< time to listen for a daemon
  std::shared_ptr<const Authentication> authentication;  ///< null: no keys
};

/// Collects the facts about this machine. Changes nothing.
HostFacts gather_facts(const DoctorOptions& options);

}  // namespace camway::tools
