// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/nats/connection.h"

namespace camway::nats {

/// A file of `ConnectOptions` that no connection can use.
struct SecurityFileFault {
  enum class File : std::uint8_t { kCredentials, kCa, kCertificate, kKey };
  File file = File::kCredentials;
  std::string reason;  ///< names the file
};

/// Reads the files that a connection proves itself with. Returns what is wrong with them: what
/// cannot be read, certificates that do not hold now, a key that is encrypted or another
/// certificate's. Whether a server takes them is for the server to say. Thread-safe.
std::vector<SecurityFileFault> faults_of_security_files(const ConnectOptions& options);

}  // namespace camway::nats
