// SPDX-License-Identifier: MIT
//
// Becomes a program that may make only the system calls that a systemd unit permits:
//
//   unit_filter UNIT_FILE PROGRAM [ARGUMENT...]
//
// The systemd of this machine lists the calls of a group (`@system-service`); an unknown group is
// empty, as for systemd itself. Exit code 2 on failure.
#include <seccomp.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

namespace {

using Names = std::set<std::string>;

std::string output_of(const std::string& command) {
  std::string text;
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return text;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
  ::pclose(pipe);
  return text;
}

/// Adds the call `name`, or all calls of the group `name` and of the groups in it.
void add(const std::string& name, Names& groups, Names& calls) {
  if (name.front() != '@') {
    calls.insert(name);
    return;
  }
  if (!groups.insert(name).second) return;
  std::istringstream lines(output_of("systemd-analyze syscall-filter " + name + " 2>&1"));
  std::string line;
  // The first printed line is the group's own name.
  for (std::getline(lines, line); std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word;
    if (words >> word && word.front() != '#') add(word, groups, calls);
  }
}

Names allowed_by(const std::string& unit_file) {
  const std::string kKey = "SystemCallFilter=";
  Names groups;
  Names calls;
  std::ifstream unit(unit_file);
  for (std::string line; std::getline(unit, line);) {
    if (line.rfind(kKey, 0) != 0) continue;
    std::istringstream words(line.substr(kKey.size()));
    for (std::string word; words >> word;) add(word, groups, calls);
  }
  return calls;
}

bool load_filter(const Names& calls) {
  const scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ERRNO(EPERM));
  for (const std::string& call : calls) {
    const int number = seccomp_syscall_resolve_name(call.c_str());
    // Calls of other processors have pseudo numbers, which libseccomp skips.
    if (number != __NR_SCMP_ERROR) seccomp_rule_add(filter, SCMP_ACT_ALLOW, number, 0);
  }
  const bool loaded = seccomp_load(filter) == 0;
  seccomp_release(filter);
  return loaded;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: unit_filter UNIT_FILE PROGRAM [ARGUMENT...]\n");
    return 2;
  }
  const Names calls = allowed_by(argv[1]);
  if (calls.count("execve") == 0 || !load_filter(calls)) {
    std::fprintf(stderr, "unit_filter: no filter in %s, or none can be set here\n", argv[1]);
    return 2;
  }
  ::execv(argv[2], argv + 2);
  std::perror(argv[2]);
  return 2;
}
