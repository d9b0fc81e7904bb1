// SPDX-License-Identifier: MIT
#include "daemon/scene/import/common/import_confinement.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/landlock.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>

#include "tests/support/temporary_folder.h"

namespace camway::scene {
namespace {

constexpr int kOutputFd = 3;
constexpr int kNotConfined = 100;
/// Results of a child for something that it tried.
constexpr int kWorked = 0;
constexpr int kDenied = 1;

int verdict(long result) { return result >= 0 ? kWorked : kDenied; }

class ImportConfinement : public ::testing::Test {
 protected:
  void SetUp() override {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP()
        << "a sanitizer's runtime makes system calls that the confinement ends a process for "
           "(clone, mmap of its shadow memory)";
#endif
    std::filesystem::create_directories(folder_.path() / "scenes");
    for (const char* const name : {"scenes/a.obj", "secret"}) {
      std::FILE* const file = std::fopen((folder_.path() / name).c_str(), "w");
      ASSERT_NE(file, nullptr);
      std::fputs("v 0 0 0\n", file);
      std::fclose(file);
    }
  }

  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_.path() / name).string();
  }

  /// Returns the wait status of a confined child that runs `what`.
  int after(const std::function<int()>& what) const {
    const pid_t child = fork();
    if (child == 0) {
      const int output = open("/dev/null", O_WRONLY);
      dup2(output, kOutputFd);
      _exit(confine_this_process(path("scenes/a.obj"), kOutputFd) ? what() : kNotConfined);
    }
    int status = -1;
    waitpid(child, &status, 0);
    return status;
  }

  void expect_denied(const std::function<int()>& what) const {
    const int status = after(what);
    ASSERT_TRUE(WIFEXITED(status)) << status;
    EXPECT_EQ(WEXITSTATUS(status), kDenied);
  }
  void expect_allowed(const std::function<int()>& what) const {
    const int status = after(what);
    ASSERT_TRUE(WIFEXITED(status)) << status;
    EXPECT_EQ(WEXITSTATUS(status), kWorked);
  }
  void expect_deadly(const std::function<int()>& what) const {
    const int status = after(what);
    ASSERT_TRUE(WIFSIGNALED(status)) << status;
    EXPECT_EQ(WTERMSIG(status), SIGSYS);
  }

  testing::TemporaryFolder folder_;
};

TEST_F(ImportConfinement, ReadsItsFileAndWritesItsOutput) {
  expect_allowed([&] { return verdict(open(path("scenes/a.obj").c_str(), O_RDONLY)); });
  expect_allowed([&] { return verdict(open(path("scenes").c_str(), O_RDONLY | O_DIRECTORY)); });
  expect_allowed([] { return verdict(write(kOutputFd, "x", 1)); });
  expect_allowed([] { return std::malloc(std::size_t{64} << 20) != nullptr ? kWorked : kDenied; });
}

TEST_F(ImportConfinement, OpensNoSocket) {
  for (const int family : {AF_INET, AF_INET6, AF_UNIX, AF_NETLINK}) {
    expect_deadly([family] { return verdict(socket(family, SOCK_DGRAM, 0)); });
  }
}

TEST_F(ImportConfinement, StartsNothing) {
  expect_deadly([] { return verdict(fork()); });
  expect_deadly([] { return std::system("true"); });
  expect_deadly([] { return verdict(execl("/bin/true", "true", nullptr)); });
}

TEST_F(ImportConfinement, WritesNoFile) {
  expect_denied([&] { return verdict(open(path("new").c_str(), O_WRONLY | O_CREAT, 0600)); });
  expect_denied([&] { return verdict(open(path("scenes/new").c_str(), O_RDWR | O_CREAT, 0600)); });
  expect_denied([&] { return verdict(open(path("scenes/a.obj").c_str(), O_WRONLY)); });
  expect_denied([&] { return verdict(open(path("scenes/a.obj").c_str(), O_RDONLY | O_TRUNC)); });
  expect_denied([&] { return verdict(open(path("scenes").c_str(), O_TMPFILE | O_RDWR, 0600)); });
  expect_denied([&] { return verdict(unlink(path("scenes/a.obj").c_str())); });
  expect_denied([&] { return verdict(rename(path("scenes/a.obj").c_str(), path("b").c_str())); });
  expect_denied([&] { return verdict(mkdir(path("scenes/c").c_str(), 0700)); });
  expect_denied([&] { return verdict(symlink("a", path("scenes/d").c_str())); });
  expect_denied([&] { return verdict(chmod(path("scenes/a.obj").c_str(), 0777)); });
  expect_denied([&] { return verdict(truncate(path("scenes/a.obj").c_str(), 0)); });
  expect_denied([] { return verdict(write(STDERR_FILENO, "x", 1)); });
}

TEST_F(ImportConfinement, MakesNoMemoryExecutable) {
  const auto map = [](int protection) {
    return mmap(nullptr, 4096, protection, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  };
  expect_denied(
      [&] { return map(PROT_READ | PROT_WRITE | PROT_EXEC) == MAP_FAILED ? kDenied : kWorked; });
  expect_denied([&] { return verdict(mprotect(map(PROT_READ), 4096, PROT_READ | PROT_EXEC)); });
}

TEST_F(ImportConfinement, SignalsNobodyElse) {
  expect_denied([] { return verdict(kill(getppid(), 0)); });
  expect_denied([] { return verdict(syscall(SYS_tgkill, getppid(), getppid(), 0)); });
}

TEST_F(ImportConfinement, LoosensNoLimitsAndTakesNoLocks) {
  expect_allowed([] {
    rlimit limit{};
    return verdict(getrlimit(RLIMIT_CPU, &limit));
  });
  expect_denied([] {
    const rlimit limit{1, 1};
    return verdict(setrlimit(RLIMIT_CPU, &limit));
  });
  expect_denied([] { return verdict(fcntl(kOutputFd, F_SETFL, O_APPEND)); });
  expect_denied([] {
    const iovec piece{const_cast<char*>("x"), 1};
    return verdict(writev(STDERR_FILENO, &piece, 1));
  });
}

TEST_F(ImportConfinement, ReadsNothingElseWhereTheKernelHasLandlock) {
  if (syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION) < 0) {
    GTEST_SKIP() << "this kernel has no Landlock";
  }
  expect_denied([&] { return verdict(open(path("secret").c_str(), O_RDONLY)); });
  expect_denied([] { return verdict(open("/etc/passwd", O_RDONLY)); });
}

}  // namespace
}  // namespace camway::scene
