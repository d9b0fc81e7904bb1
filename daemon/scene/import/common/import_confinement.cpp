// SPDX-License-Identifier: MIT
#include "daemon/scene/import/common/import_confinement.h"

#include <fcntl.h>
#include <linux/landlock.h>
#include <seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <system_error>

namespace camway::scene {
namespace {

namespace fs = std::filesystem;

/// System calls that no file reader needs: an attempt kills the process.
constexpr std::initializer_list<int> kDeadly = {SCMP_SYS(socket),
                                                SCMP_SYS(socketpair),
                                                SCMP_SYS(connect),
                                                SCMP_SYS(bind),
                                                SCMP_SYS(listen),
                                                SCMP_SYS(accept),
                                                SCMP_SYS(accept4),
                                                SCMP_SYS(sendto),
                                                SCMP_SYS(sendmsg),
                                                SCMP_SYS(sendmmsg),
                                                SCMP_SYS(fork),
                                                SCMP_SYS(vfork),
                                                SCMP_SYS(clone),
                                                SCMP_SYS(clone3),
                                                SCMP_SYS(execve),
                                                SCMP_SYS(execveat),
                                                SCMP_SYS(ptrace),
                                                SCMP_SYS(process_vm_readv),
                                                SCMP_SYS(process_vm_writev),
                                                SCMP_SYS(io_uring_setup)};

/// System calls that reading files and building a mesh need, with any arguments.
constexpr std::initializer_list<int> kAllowed = {
    // files, whose opening has a rule of its own
    SCMP_SYS(read), SCMP_SYS(pread64), SCMP_SYS(readv), SCMP_SYS(close), SCMP_SYS(lseek),
    SCMP_SYS(_llseek), SCMP_SYS(fstat), SCMP_SYS(fstat64), SCMP_SYS(stat), SCMP_SYS(stat64),
    SCMP_SYS(lstat), SCMP_SYS(lstat64), SCMP_SYS(newfstatat), SCMP_SYS(fstatat64), SCMP_SYS(statx),
    SCMP_SYS(access), SCMP_SYS(faccessat), SCMP_SYS(faccessat2), SCMP_SYS(readlink),
    SCMP_SYS(readlinkat), SCMP_SYS(getcwd), SCMP_SYS(getdents), SCMP_SYS(getdents64),
    SCMP_SYS(fadvise64),
    // memory, but none that can be run
    SCMP_SYS(brk), SCMP_SYS(munmap), SCMP_SYS(mremap), SCMP_SYS(madvise), SCMP_SYS(futex),
    // the process itself
    SCMP_SYS(exit), SCMP_SYS(exit_group), SCMP_SYS(rt_sigaction), SCMP_SYS(rt_sigprocmask),
    SCMP_SYS(rt_sigreturn), SCMP_SYS(sigreturn), SCMP_SYS(sigaltstack), SCMP_SYS(restart_syscall),
    SCMP_SYS(getpid), SCMP_SYS(gettid), SCMP_SYS(getuid), SCMP_SYS(geteuid), SCMP_SYS(getgid),
    SCMP_SYS(getegid), SCMP_SYS(getrlimit), SCMP_SYS(ugetrlimit), SCMP_SYS(uname),
    SCMP_SYS(sysinfo), SCMP_SYS(sched_yield), SCMP_SYS(sched_getaffinity),
    // clocks and random numbers
    SCMP_SYS(clock_gettime), SCMP_SYS(clock_gettime64), SCMP_SYS(clock_getres),
    SCMP_SYS(gettimeofday), SCMP_SYS(time), SCMP_SYS(getrandom)};

using Filter = std::unique_ptr<void, decltype(&seccomp_release)>;

bool add(const Filter& filter, std::uint32_t action, int call) {
  // A call that this machine does not have needs no rule.
  const int result = seccomp_rule_add(filter.get(), action, call, 0);
  return result == 0 || result == -EDOM;
}

bool allow_if(const Filter& filter, int call, scmp_arg_cmp condition) {
  const int result = seccomp_rule_add_array(filter.get(), SCMP_ACT_ALLOW, call, 1, &condition);
  return result == 0 || result == -EDOM;
}

/// Whether argument `index` has none of `bits`.
scmp_arg_cmp without(unsigned int index, std::uint64_t bits) {
  return {index, SCMP_CMP_MASKED_EQ, bits, 0};
}

bool add_conditions(const Filter& filter, int output_fd) {
  constexpr std::uint64_t kWriting = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC | O_APPEND | O_TMPFILE;
  // O_TMPFILE holds the bit of O_DIRECTORY, which only reads.
  constexpr std::uint64_t kNotReading = kWriting & ~std::uint64_t{O_DIRECTORY};
  const auto output = static_cast<scmp_datum_t>(output_fd);
  const auto self = static_cast<scmp_datum_t>(getpid());
  return allow_if(filter, SCMP_SYS(open), without(1, kNotReading)) &&
         allow_if(filter, SCMP_SYS(openat), without(2, kNotReading)) &&
         allow_if(filter, SCMP_SYS(write), {0, SCMP_CMP_EQ, output, 0}) &&
         allow_if(filter, SCMP_SYS(writev), {0, SCMP_CMP_EQ, output, 0}) &&
         allow_if(filter, SCMP_SYS(mmap), without(2, PROT_EXEC)) &&
         allow_if(filter, SCMP_SYS(mmap2), without(2, PROT_EXEC)) &&
         allow_if(filter, SCMP_SYS(mprotect), without(2, PROT_EXEC)) &&
         // Closing on exec and the like, not locks or leases.
         allow_if(filter, SCMP_SYS(fcntl), {1, SCMP_CMP_LE, F_SETFD, 0}) &&
         // abort() signals itself.
         allow_if(filter, SCMP_SYS(tgkill), {0, SCMP_CMP_EQ, self, 0}) &&
         // Reading limits, not setting them.
         allow_if(filter, SCMP_SYS(prlimit64), {2, SCMP_CMP_EQ, 0, 0});
}

bool filter_system_calls(int output_fd) {
  const Filter filter(seccomp_init(SCMP_ACT_ERRNO(EPERM)), &seccomp_release);
  if (!filter) return false;
  for (const int call : kDeadly) {
    if (!add(filter, SCMP_ACT_KILL_PROCESS, call)) return false;
  }
  for (const int call : kAllowed) {
    if (!add(filter, SCMP_ACT_ALLOW, call)) return false;
  }
  return add_conditions(filter, output_fd) && seccomp_load(filter.get()) == 0;
}

/// Adds a folder to those that may be read. A missing folder adds nothing.
void allow_reading_below(int ruleset, const fs::path& folder) {
  const int fd = open(folder.c_str(), O_PATH | O_CLOEXEC);
  if (fd < 0) return;
  landlock_path_beneath_attr rule{};
  rule.allowed_access = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
  rule.parent_fd = fd;
  syscall(SYS_landlock_add_rule, ruleset, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
  close(fd);
}

/// Denies this process all files but those beside `file`, if the kernel can.
void limit_files(const fs::path& file) {
  landlock_ruleset_attr attributes{};
  // All of the first version of Landlock, from execution to symbolic links; writing is closed by
  // seccomp in any case.
  attributes.handled_access_fs = (LANDLOCK_ACCESS_FS_MAKE_SYM << 1U) - 1;
  const auto ruleset = static_cast<int>(
      syscall(SYS_landlock_create_ruleset, &attributes, sizeof attributes.handled_access_fs, 0));
  if (ruleset < 0) return;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  allow_reading_below(ruleset, folder);
  std::error_code error;
  const fs::path real = fs::canonical(file, error);
  if (!error) allow_reading_below(ruleset, real.parent_path());
  syscall(SYS_landlock_restrict_self, ruleset, 0);
  close(ruleset);
}

}  // namespace

bool confine_this_process(const fs::path& file, int output_fd) {
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return false;
  limit_files(file);
  return filter_system_calls(output_fd);
}

}  // namespace camway::scene
