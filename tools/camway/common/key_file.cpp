// SPDX-License-Identifier: MIT
#include "tools/camway/common/key_file.h"

#include <camway/authentication.h>

#include <utility>

namespace camway::tools {

CLI::Option* add_key_file(CLI::App& command, std::string& file) {
  return command
      .add_option("--key-file", file,
                  "Keys that messages are signed and checked with, as the daemon's auth.key_file; "
                  "without it nothing is signed, and what comes is believed")
      ->type_name("FILE");
}

std::string use_key_file(const std::string& file, ClientOptions& options) {
  if (file.empty()) return {};
  LoadedAuthentication loaded = authentication_from(file);
  options.authentication = std::move(loaded.authentication);
  return loaded.error.empty() ? std::string() : "--key-file " + loaded.error;
}

}  // namespace camway::tools
