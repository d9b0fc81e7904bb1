// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace camway::scene {

/// Permanently takes from this process the rights that reading a scene file does not need, because
/// a hostile file may take over its reader:
///
/// - The process is killed if it tries to open a socket, to start a process or a thread, to run a
///   program or to inspect another process (seccomp, SIGSYS).
/// - Files can only be read: opening one for writing, creating, renaming, removing, and every other
///   system call that is not on a short list fails (seccomp, EPERM). Writing is allowed to
///   `output_fd` alone, and memory cannot be made executable.
/// - Where the kernel has Landlock, only files below the folder of `file` can be opened; if `file`
///   is a link, also those below the folder of its target. Other files, such as the daemon's keys,
///   cannot be read.
/// - No program that it runs would get new rights (no_new_privs).
///
/// Returns false if seccomp does not work here; then nothing may be read. Requires that it is
/// called once, in a process with one thread.
[[nodiscard]] bool confine_this_process(const std::filesystem::path& file, int output_fd);

}  // namespace camway::scene
