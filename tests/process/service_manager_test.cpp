// SPDX-License-Identifier: MIT
#include "daemon/process/service_manager.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <iterator>

#include "tests/support/notify_socket.h"
#include "tests/support/temporary_folder.h"

namespace camway::process {
namespace {

using namespace std::chrono_literals;
using testing::NotifySocket;
using testing::TemporaryFolder;

TEST(ServiceManager, SaysEachStateInADatagram) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "notify").string();
  for (const std::string& name : {path, std::string("@camway-test-") + std::to_string(getpid())}) {
    NotifySocket socket(name);
    const ServiceManager manager(name, 30s);
    manager.ready("serving");
    EXPECT_EQ(socket.next(), "READY=1\nSTATUS=serving");
    manager.reloading();
    const std::string reloading = socket.next();
    EXPECT_EQ(reloading.rfind("RELOADING=1\nMONOTONIC_USEC=", 0), 0U) << reloading;
    manager.alive();
    EXPECT_EQ(socket.next(), "WATCHDOG=1");
    manager.stopping();
    EXPECT_EQ(socket.next(), "STOPPING=1");
  }
}

std::size_t open_descriptors() {
  const std::filesystem::directory_iterator descriptors("/proc/self/fd");
  return static_cast<std::size_t>(std::distance(begin(descriptors), end(descriptors)));
}

TEST(ServiceManager, SaysNothingWhereNobodyListens) {
  EXPECT_FALSE(ServiceManager("", std::nullopt).present());
  const std::size_t descriptors = open_descriptors();
  ::testing::internal::CaptureStderr();
  ServiceManager("", std::nullopt).ready("serving");
  ServiceManager("/nowhere/at/all", 1s).alive();
  ServiceManager(std::string(500, 'x'), 1s).alive();
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(open_descriptors(), descriptors);
}

TEST(ServiceManager, DoesNotWaitForAManagerThatDoesNotRead) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "notify").string();
  NotifySocket socket(path);
  const ServiceManager manager(path, 30s);
  constexpr int kSent = 10'000;
  for (int i = 0; i < kSent; ++i) manager.alive();
  int received = 0;
  while (!socket.next(0ms).empty()) ++received;
  EXPECT_GT(received, 0);
  EXPECT_LT(received, kSent) << "the socket has room for all, so none had to be dropped";
}

TEST(ServiceManager, CallsThreeTimesInAPeriodAndOnlyIfItIsWatched) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "notify").string();
  NotifySocket socket(path);
  ServiceManager(path, std::nullopt).alive();
  EXPECT_EQ(socket.next(50ms), "");
  EXPECT_EQ(ServiceManager(path, 300ms).alive_period(), 100ms);
  EXPECT_EQ(ServiceManager(path, 1h).alive_period(), 1s);
  EXPECT_EQ(ServiceManager(path, 1us).alive_period(), 1ms);
}

TEST(ServiceManager, HeedsTheEnvironmentThatIsMeantForIt) {
  const auto with_environment = [](const char* socket, const char* period, const std::string& pid) {
    setenv("NOTIFY_SOCKET", socket, 1);
    setenv("WATCHDOG_USEC", period, 1);
    setenv("WATCHDOG_PID", pid.c_str(), 1);
    return ServiceManager::from_environment();
  };
  const std::string own = std::to_string(getpid());
  EXPECT_EQ(with_environment("/run/x", "600000", own).alive_period(), 200ms);
  EXPECT_EQ(with_environment("/run/x", "600000", "").alive_period(), 200ms);
  EXPECT_EQ(with_environment("/run/x", "600000", "1").alive_period(), 1s) << "the parent's";
  EXPECT_EQ(with_environment("/run/x", "-5", own).alive_period(), 1s);
  EXPECT_EQ(with_environment("/run/x", "9x", own).alive_period(), 1s);
  EXPECT_TRUE(with_environment("/run/x", "", "").present());
  EXPECT_FALSE(with_environment("", "", "").present());
  for (const char* name : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"}) unsetenv(name);
}

}  // namespace
}  // namespace camway::process
