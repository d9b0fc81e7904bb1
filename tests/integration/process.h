// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace camway::integration {

/// Time after which a wait counts as failed. Every wait ends as soon as its condition holds.
inline constexpr std::chrono::seconds kPatience{60};

/// Evaluates `condition` repeatedly. Returns true once it holds, false after `kPatience`.
bool eventually(const std::function<bool()>& condition);

/// A program that runs beside the test and writes both outputs to a file. It is killed when the
/// test ends in any way.
class Process {
 public:
  /// Starts `arguments[0]`, with stdout and stderr to the file `output`.
  Process(const std::vector<std::string>& arguments, std::string output);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  [[nodiscard]] pid_t pid() const { return pid_; }
  void signal(int number) const;
  /// Waits for the end of the program. Returns its exit code, or 128 plus the number of the signal
  /// that killed it; nothing if it does not end.
  std::optional<int> wait();
  bool running();
  /// Returns whether an earlier call has seen its end.
  [[nodiscard]] bool known_to_have_ended() const { return exit_code_.has_value(); }
  /// Returns its output so far.
  std::string output() const;

 private:
  pid_t pid_ = -1;
  std::optional<int> exit_code_;
  std::string output_;
};

/// Returns the content of a file; empty if there is none.
std::string read_file(const std::string& path);
/// Writes a file, or replaces it at once.
void write_file(const std::string& path, const std::string& content);

}  // namespace camway::integration
