// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

#include <CLI/CLI.hpp>

#include "daemon/planning/request/request.h"

namespace camway::tools {

/// The flags of `camway plan` that override options of a request. `planning::visit_table` has
/// them: each option that is a number, a name or a switch has a flag, and so has
/// `orientation.max_turn`. An option that was renamed has a flag by its old name, too, which
/// excludes the flag by the new name.
/// Not thread-safe.
class OptionFlags {
 public:
  /// Adds the flags to `command`, which must not outlive this object.
  void add_to(CLI::App& command);

  /// Overrides the options whose flags were given. Errors about these options name the flag.
  /// Requires that the command line was parsed.
  void apply(planning::PlanRequest& request) const;

 private:
  planning::PlanOptions options_;
  /// By path: "options.clearance_m" has "--clearance-m" and "--clearance".
  std::multimap<std::string, CLI::Option*, std::less<>> flags_;
};

}  // namespace camway::tools
