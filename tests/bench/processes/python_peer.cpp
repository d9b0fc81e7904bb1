// SPDX-License-Identifier: MIT
#include <camway/client.h>
#include <time.h>

#include <chrono>
#include <cstdio>
#include <iostream>
#include <string>

#include "tools/json/json_request.h"
#include "tools/support/client_request.h"

namespace {

/// Processor time of all threads of this process.
double processor_ms() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

}  // namespace

/// The C++ client beside which the package for Python is measured: plans the request of FILE each
/// time that it reads a seed, and writes the milliseconds that pass, those of the processor, and
/// whether the path is proved.
int main(int count, char** arguments) {
  namespace tools = camway::tools;
  if (count != 3) {
    std::cerr << "usage: bench_python_peer FILE SCENE\n";
    return 2;
  }
  const auto file = tools::read_as<tools::RequestFile>(arguments[1]);
  if (!file) {
    std::cerr << file.error << '\n';
    return 2;
  }
  camway::PlanRequest request = tools::to_client_request(*file, arguments[2]);
  camway::Client client;
  while (std::cin >> request.seed) {
    const double processor_begin_ms = processor_ms();
    const auto begin = std::chrono::steady_clock::now();
    const camway::PlanResponse answer = client.plan(request);
    const std::chrono::duration<double, std::milli> taken =
        std::chrono::steady_clock::now() - begin;
    const double processor_taken_ms = processor_ms() - processor_begin_ms;
    std::printf("%.6f %.6f %d\n", taken.count(), processor_taken_ms, answer.ok() ? 1 : 0);
    std::fflush(stdout);
  }
  return 0;
}
