// SPDX-License-Identifier: MIT
#include "daemon/scene/import/import_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <optional>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "daemon/base/file_descriptor.h"
#include "daemon/base/result.h"
#include "daemon/scene/import/record/cad_names.h"
#include "daemon/scene/import/record/inventor_names.h"
#include "daemon/scene/import/record/record_layout.h"

namespace camway::scene {
namespace {

namespace fs = std::filesystem;
using End = ImportProcessResult::End;
using Clock = std::chrono::steady_clock;

constexpr const char* kProgram = "camway-import";
constexpr const char* kInventorProgram = "camway-import-inventor";
constexpr const char* kCadProgram = "camway-import-cad";

/// Whether the build has `kInventorProgram`, which needs a library that may be missing.
#ifdef CAMWAY_WITH_INVENTOR
constexpr bool kReadsInventor = true;
#else
constexpr bool kReadsInventor = false;
#endif
/// The same of `kCadProgram`.
#ifdef CAMWAY_WITH_CAD
constexpr bool kReadsCad = true;
#else
constexpr bool kReadsCad = false;
#endif

/// The program that reads files of a name, or why there is none.
base::Result<const char*> program_for(const std::string& name, ImportTask task) {
  const bool is_inventor = is_inventor_name(name);
  const bool is_cad = is_cad_name(name);
  if (is_inventor && !kReadsInventor) {
    return base::Failure{"this build has no reader for Open Inventor (libcoin)"};
  }
  if (is_cad && !kReadsCad) {
    return base::Failure{
        "this build has no reader for STEP and IGES (libocct-data-exchange): export a mesh (OBJ, "
        "STL, glTF)"};
  }
  if (task == ImportTask::kCameras && is_cad) {
    return base::Failure{"STEP and IGES have no cameras"};
  }
  return is_inventor ? kInventorProgram : is_cad ? kCadProgram : kProgram;
}

std::string text_of_errno(int error) { return std::generic_category().message(error); }

bool is_program(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) && access(path.c_str(), X_OK) == 0;
}

/// The folder of `set_import_program_folder`.
struct ProgramFolder {
  std::mutex mutex;
  fs::path path;
};
ProgramFolder& program_folder() {
  static ProgramFolder folder;
  return folder;
}
fs::path program_folder_path() {
  const std::scoped_lock lock(program_folder().mutex);
  return program_folder().path;
}

std::optional<fs::path> find_program(const char* name) {
  const fs::path first = program_folder_path();
  if (!first.empty() && is_program(first / name)) return first / name;
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  if (!error && is_program(self.parent_path() / name)) return self.parent_path() / name;
  const char* path = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe): never set by us
  std::string_view rest = path == nullptr ? "" : path;
  while (!rest.empty()) {
    const std::size_t colon = std::min(rest.find(':'), rest.size());
    const fs::path directory(rest.substr(0, colon));
    // A relative directory could hold any program, depending on where the daemon was started.
    if (directory.is_absolute() && is_program(directory / name)) return directory / name;
    rest.remove_prefix(std::min(colon + 1, rest.size()));
  }
  return std::nullopt;
}

/// Opens a file for the output of the child. Its number is never that of a standard stream: these
/// may be closed in this process, and are opened anew in the child. Returns a negative number, with
/// `errno` set, on failure.
int open_output() {
  const base::FileDescriptor first(memfd_create("camway-import", MFD_CLOEXEC));
  return first.get() < 0 ? -1 : fcntl(first.get(), F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
}

/// The actions between fork and exec, which `posix_spawn` performs without running code of ours.
class SpawnSettings {
 public:
  explicit SpawnSettings(int output_fd) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawnattr_init(&attributes_);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
      posix_spawn_file_actions_addopen(&actions_, stream, "/dev/null", O_RDWR, 0);
    }
    posix_spawn_file_actions_adddup2(&actions_, output_fd, import_record::kOutputFd);
    posix_spawn_file_actions_addclosefrom_np(&actions_, import_record::kOutputFd + 1);
    sigset_t none;
    sigset_t all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setsigdefault(&attributes_, &all);
    posix_spawnattr_setpgroup(&attributes_, 0);  // this process handles Ctrl-C
    posix_spawnattr_setflags(
        &attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  }
  ~SpawnSettings() {
    posix_spawn_file_actions_destroy(&actions_);
    posix_spawnattr_destroy(&attributes_);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;

  /// Returns 0 or an error number.
  int spawn(pid_t& pid, const fs::path& program, const std::vector<std::string>& arguments) const {
    std::vector<char*> argv;
    for (const std::string& argument : arguments) {
      argv.push_back(const_cast<char*>(argument.c_str()));  // exec does not write to them
    }
    argv.push_back(nullptr);
    std::array<char*, 1> no_environment = {nullptr};
    return posix_spawn(&pid, program.c_str(), &actions_, &attributes_, argv.data(),
                       no_environment.data());
  }

 private:
  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

/// Returns the exit status; or nothing, with the process killed, if the deadline or the stop came
/// first.
std::optional<int> wait_until(pid_t pid, Clock::time_point deadline, const std::stop_token& stop) {
  std::chrono::microseconds pause(100);
  int status = 0;
  while (true) {
    const pid_t done = waitpid(pid, &status, WNOHANG);
    if (done == pid) return status;
    if (done < 0 && errno != EINTR) return std::nullopt;
    if (Clock::now() >= deadline || stop.stop_requested()) break;
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, std::chrono::microseconds(5000));
  }
  kill(pid, SIGKILL);
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return std::nullopt;
}

std::optional<std::vector<std::byte>> read_all(int fd) {
  struct stat information {};
  if (fstat(fd, &information) != 0) return std::nullopt;
  std::vector<std::byte> bytes(static_cast<std::size_t>(information.st_size));
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t got =
        pread(fd, bytes.data() + done, bytes.size() - done, static_cast<off_t>(done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return std::nullopt;
    done += static_cast<std::size_t>(got);
  }
  return bytes;
}

ImportProcessResult result_of_signal(int signal) {
  if (signal == SIGXCPU) return {End::kOutOfTime, {}, ""};
  if (signal == SIGXFSZ) return {End::kOutOfMemory, {}, ""};
  const char* name = sigabbrev_np(signal);
  return {End::kCrashed, {}, name != nullptr ? "SIG" + std::string(name) : std::to_string(signal)};
}

ImportProcessResult result_of_exit(int code, int output_fd) {
  switch (code) {
    case import_record::kExitOk:
    case import_record::kExitRefused: {
      std::optional<std::vector<std::byte>> output = read_all(output_fd);
      if (!output)
        return {End::kNotStarted, {}, "cannot read what " + std::string(kProgram) + " wrote"};
      return {End::kFinished, std::move(*output), ""};
    }
    case import_record::kExitOutOfMemory:
      return {End::kOutOfMemory, {}, ""};
    case import_record::kExitInternal:
      return {End::kNotStarted, {}, "the import process cannot set its limits or write"};
    case import_record::kExitNotConfined:
      return {End::kNotStarted,
              {},
              "the import process cannot confine itself: seccomp is not permitted here"};
    default:
      return {End::kCrashed, {}, "exit code " + std::to_string(code)};
  }
}

/// Names the package that has a program, where it is not the one of `camway` itself.
std::string package_hint(std::string_view program) {
  return program == "camway-import" ? "" : "; the package camway-formats has it";
}

}  // namespace

void set_import_program_folder(fs::path folder) {
  const std::scoped_lock lock(program_folder().mutex);
  program_folder().path = std::move(folder);
}

ImportProcessResult run_import_process(const fs::path& file, std::size_t memory_limit_bytes,
                                       double time_limit_s, const std::stop_token& stop,
                                       ImportTask task) {
  const base::Result<const char*> name = program_for(file.filename().string(), task);
  if (!name) return {End::kNotStarted, {}, name.error};
  const std::optional<fs::path> program = find_program(*name);
  if (!program) {
    const fs::path first = program_folder_path();
    return {End::kNotStarted,
            {},
            std::string(*name) + " is neither " +
                (first.empty() ? "" : "in " + first.string() + ", ") +
                "beside this program nor on PATH" + package_hint(*name)};
  }
  const base::FileDescriptor output(open_output());
  if (output.get() < 0) return {End::kNotStarted, {}, text_of_errno(errno)};
  // A little more processor time, so that the limit of wall clock is reached first.
  const double cpu_s = std::ceil(std::clamp(time_limit_s, 0.0, 1e6)) + 1.0;
  std::vector<std::string> arguments = {program->string(), file.string(),
                                        std::to_string(memory_limit_bytes),
                                        std::to_string(static_cast<unsigned long>(cpu_s))};
  if (task == ImportTask::kCameras) arguments.emplace_back(import_record::kCamerasArgument);
  const auto budget = std::chrono::duration<double>(std::clamp(time_limit_s, 0.0, 1e6));
  const Clock::time_point deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(budget);
  pid_t pid = 0;
  if (const int error = SpawnSettings(output.get()).spawn(pid, *program, arguments); error != 0) {
    return {End::kNotStarted, {}, program->string() + ": " + text_of_errno(error)};
  }
  const std::optional<int> status = wait_until(pid, deadline, stop);
  if (!status) return {stop.stop_requested() ? End::kStopped : End::kOutOfTime, {}, ""};
  if (WIFSIGNALED(*status)) return result_of_signal(WTERMSIG(*status));
  return result_of_exit(WEXITSTATUS(*status), output.get());
}

}  // namespace camway::scene
