// SPDX-License-Identifier: MIT
#include "tests/fuzz/files/forked_reader.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <iostream>
#include <optional>
#include <thread>
#include <vector>

#include "daemon/base/file_descriptor.h"
#include "daemon/scene/import/common/import_process_main.h"
#include "daemon/scene/import/record/import_record.h"
#include "daemon/scene/import/record/record_layout.h"

namespace camway::testing {
namespace {

namespace layout = scene::import_record;
using Clock = std::chrono::steady_clock;

constexpr std::string_view kCamerasPrefix = "cameras ";

struct Order {
  std::string file;
  bool wants_cameras = false;
};

Order order_of(const std::string& line) {
  if (line.starts_with(kCamerasPrefix)) return {line.substr(kCamerasPrefix.size()), true};
  return {line, false};
}

/// The streams of the import process, as `run_import_process` sets them.
void set_streams(int output_fd) {
  const int null_fd = open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(null_fd, stream);
  dup2(output_fd, layout::kOutputFd);
  closefrom(layout::kOutputFd + 1);
}

[[noreturn]] void read_here(const ForkedReader& reader, const Order& order, int output_fd,
                            const scene::ImportOptions& options) {
  set_streams(output_fd);
  std::string program = "forked";
  std::string file = order.file;
  std::string memory = std::to_string(options.memory_limit_bytes);
  std::string cpu_s = std::to_string(static_cast<unsigned long>(std::ceil(options.time_limit_s)));
  std::array<char*, 4> argv = {program.data(), file.data(), memory.data(), cpu_s.data()};
  scene::import_process::run(
      static_cast<int>(argv.size()), argv.data(), [] {},
      order.wants_cameras ? reader.cameras : reader.import);
}

/// Returns the exit status, or nothing with the process killed at its limit.
std::optional<int> wait_for(pid_t pid, double limit_s) {
  const Clock::time_point end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                   std::chrono::duration<double>(limit_s));
  int status = 0;
  for (std::chrono::microseconds pause(100); Clock::now() < end;
       pause = std::min(2 * pause, std::chrono::microseconds(5000))) {
    if (waitpid(pid, &status, WNOHANG) == pid) return status;
    std::this_thread::sleep_for(pause);
  }
  kill(pid, SIGKILL);
  waitpid(pid, &status, 0);
  return std::nullopt;
}

std::vector<std::byte> bytes_of(int fd) {
  struct stat information {};
  if (fstat(fd, &information) != 0) return {};
  std::vector<std::byte> bytes(static_cast<std::size_t>(information.st_size));
  const ssize_t got = pread(fd, bytes.data(), bytes.size(), 0);
  bytes.resize(got < 0 ? 0 : static_cast<std::size_t>(got));
  return bytes;
}

/// Checks the answer as `import_mesh` and `import_cameras` do.
std::string judged(const std::vector<std::byte>& bytes, const Order& order,
                   const scene::ImportOptions& options) {
  if (order.wants_cameras) {
    const scene::CameraRecordResult record = scene::read_camera_record(bytes);
    if (record.broken) return "broken\t";
    return record.refusal.empty() ? "read\tcameras" : "refused\t" + record.refusal;
  }
  scene::ImportReport report;
  const scene::ImportRecordResult record = scene::read_import_record(bytes, options, report);
  if (record.broken) return "broken\t";
  if (!record.mesh) return "refused\t" + record.refusal;
  return "read\t" + std::to_string(record.mesh->triangles.size()) + " triangles";
}

std::string outcome_of(std::optional<int> status, int output_fd, const Order& order,
                       const scene::ImportOptions& options) {
  if (!status) return "limited\twall clock";
  if (WIFSIGNALED(*status)) {
    const int signal = WTERMSIG(*status);
    if (signal == SIGXCPU || signal == SIGXFSZ) return "limited\tsignal";
    return "fallen\tsignal " + std::to_string(signal);
  }
  const int code = WEXITSTATUS(*status);
  if (code == layout::kExitOutOfMemory) return "limited\tmemory";
  if (code != layout::kExitOk && code != layout::kExitRefused) {
    return "fallen\texit code " + std::to_string(code);
  }
  return judged(bytes_of(output_fd), order, options);
}

std::string read_one(const ForkedReader& reader, const Order& order) {
  const scene::ImportOptions options;
  const base::FileDescriptor output(memfd_create("forked", MFD_CLOEXEC));
  if (output.get() < 0) return "broken\tno memory for an answer";
  const pid_t pid = fork();
  if (pid < 0) return "broken\tno process";
  if (pid == 0) read_here(reader, order, output.get(), options);
  const std::optional<int> status = wait_for(pid, options.time_limit_s);
  return outcome_of(status, output.get(), order, options);
}

}  // namespace

int serve_forked(const ForkedReader& reader) {
  // Descriptor 3 is taken first, so that no answer of a child is there before it is moved to it.
  const base::FileDescriptor reserved(open("/dev/null", O_RDONLY | O_CLOEXEC));
  reader.prepare();
  for (std::string line; std::getline(std::cin, line);) {
    std::cout << read_one(reader, order_of(line)) << std::endl;
  }
  return 0;
}

}  // namespace camway::testing
