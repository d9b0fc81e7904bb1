// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace camway::integration {

/// How long anything here may take before it counts as failed. Nothing waits that long when all is
/// well: every wait is for a condition.
inline constexpr std::chrono::seconds kPatience{60};

/// Asks `condition` again and again until it holds (true) or patience is over (false).
bool eventually(const std::function<bool()>& condition);

/// A program that runs beside the test; both its outputs go to a file. Killed with the test,
/// however that ends.
class Process {
 public:
  /// Starts `arguments[0]`. `output` is where its stdout and stderr go, together.
  Process(const std::vector<std::string>& arguments, std::string output);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  [[nodiscard]] pid_t pid() const { return pid_; }
  void signal(int number) const;
  /// Waits for its end. The exit code, or 128 + the signal that killed it; nothing if it does not
  /// end.
  std::optional<int> wait();
  bool running();
  /// Somebody has seen that it ended.
  [[nodiscard]] bool known_to_have_ended() const { return exit_code_.has_value(); }
  /// What it has printed so far.
  std::string output() const;

 private:
  pid_t pid_ = -1;
  std::optional<int> exit_code_;
  std::string output_;
};

/// All of a file; empty if there is none.
std::string read_file(const std::string& path);

}  // namespace camway::integration
