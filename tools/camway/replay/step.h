// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <iosfwd>
#include <string>

#include "tools/camway/replay/compare/pictures.h"
#include "tools/camway/replay/replay_run.h"

namespace camway::tools {

/// The terminal, and the writer of pictures, for a person who steps through a session.
struct StepDesk {
  std::istream& in;
  std::ostream& out;
  /// Writes a picture. Returns an error, empty on success.
  std::function<std::string(const std::string& file, const std::string& svg)> write_picture;
};

/// Plans one request after the other, shows each with its difference, and reads a line after each:
/// empty or "n" for the next one, "d" for a picture of both paths, "q" or the end of the input to
/// stop. Returns the requests that were planned.
std::vector<ComparedRequest> step_through(const Session& session, ReplayScenes& scenes,
                                          const ReplayOptions& options, const StepDesk& desk);

}  // namespace camway::tools
