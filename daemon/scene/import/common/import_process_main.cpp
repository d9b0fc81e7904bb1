// SPDX-License-Identifier: MIT
#include "daemon/scene/import/common/import_process_main.h"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <charconv>
#include <csignal>
#include <cstddef>
#include <exception>
#include <new>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/scene/import/common/import_confinement.h"

namespace camway::scene::import_process {
namespace {

namespace layout = import_record;

/// Enough for a scene file and the files that it refers to, one after the other.
constexpr rlim_t kMaxOpenFiles = 64;

bool set_limit(int resource, rlim_t value) {
  const rlimit limit{value, value};
  return setrlimit(static_cast<__rlimit_resource_t>(resource), &limit) == 0;
}

bool limit_this_process(rlim_t memory_bytes, rlim_t cpu_s) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  // Sanitizers reserve terabytes of address space.
  const bool address_space = true;
#else
  const bool address_space = set_limit(RLIMIT_AS, memory_bytes);
#endif
  return address_space && set_limit(RLIMIT_CPU, cpu_s) && set_limit(RLIMIT_CORE, 0) &&
         set_limit(RLIMIT_FSIZE, memory_bytes) && set_limit(RLIMIT_NOFILE, kMaxOpenFiles) &&
         set_limit(RLIMIT_NPROC, 0) && prctl(PR_SET_PDEATHSIG, SIGKILL) == 0;
}

bool confine([[maybe_unused]] const char* file) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return true;  // sanitizers need more system calls than are left
#else
  return confine_this_process(file, layout::kOutputFd);
#endif
}

bool write_all(const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = write(layout::kOutputFd, at, size);
    if (written <= 0) return false;
    at += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

template <class T>
bool write_all(const std::vector<T>& values) {
  return write_all(values.data(), values.size() * sizeof(T));
}

std::optional<rlim_t> parse_limit(std::string_view text) {
  rlim_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

int write_record(layout::Record& record) {
  layout::set_counts(record);
  const bool written = write_all(&record.header, sizeof record.header) &&
                       write_all(record.text.data(), record.text.size()) &&
                       write_all(record.notes.data(), record.notes.size()) &&
                       write_all(record.vertices) && write_all(record.triangles) &&
                       write_all(record.objects) &&
                       write_all(record.names.data(), record.names.size()) &&
                       write_all(record.occupied) && write_all(record.free);
  return written ? layout::kExitOk : layout::kExitInternal;
}

int refuse(std::string reason) {
  layout::Record record;
  record.text = std::move(reason);
  return write_record(record) == layout::kExitOk ? layout::kExitRefused : layout::kExitInternal;
}

int run(int argc, char** argv, const std::function<void()>& prepare,
        const std::function<int(const std::string&)>& import) {
  if (argc != 4) _exit(layout::kExitInternal);
  const std::optional<rlim_t> memory_bytes = parse_limit(argv[2]);
  const std::optional<rlim_t> cpu_s = parse_limit(argv[3]);
  if (!memory_bytes || !cpu_s || !limit_this_process(*memory_bytes, *cpu_s)) {
    _exit(layout::kExitInternal);
  }
  // Called before a library can catch bad_alloc and report it as something else.
  std::set_new_handler([] { _exit(layout::kExitOutOfMemory); });
  prepare();
  if (!confine(argv[1])) _exit(layout::kExitNotConfined);
  int code = layout::kExitInternal;
  try {
    code = import(argv[1]);
  } catch (const std::exception& e) {
    // Libraries often throw the mere name of a C++ type.
    code = refuse(std::string("it is damaged, or has what its reader does not know (") + e.what() +
                  ")");
  }
  // The output is complete; the destructors of libraries at exit could only fail.
  _exit(code);
}

}  // namespace camway::scene::import_process
