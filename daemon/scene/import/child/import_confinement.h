// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace camway::scene {

/// Takes from this process what reading a scene file does not need, for good, because the reader of
/// a hostile file may be taken over:
///
/// - Any attempt to open a socket, to start a process or a thread, to run a program or to look into
///   another process ends it (seccomp, SIGSYS).
/// - Files can only be read: opening one for writing, creating, renaming, removing, and every other
///   call to the system that is not on a short list fails (seccomp, EPERM). Writing is allowed to
///   `output_fd` alone, and memory cannot be made executable.
/// - Where the kernel has Landlock, only what lies below the folder of `file` can be opened at all;
///   that of the file itself, too, where `file` is a link. Other files cannot be read: the daemon's
///   keys, for one.
/// - No program that it runs would get new rights (no_new_privs).
///
/// False if seccomp does not work here; then nothing may be read. To be called once, while there is
/// one thread.
[[nodiscard]] bool confine_this_process(const std::filesystem::path& file, int output_fd);

}  // namespace camway::scene
