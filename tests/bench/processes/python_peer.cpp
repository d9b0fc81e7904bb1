// SPDX-License-Identifier: MIT
#include <camway/client.h>

#include <chrono>
#include <cstdio>
#include <iostream>
#include <string>

#include "tools/json/json_request.h"
#include "tools/support/client_request.h"

/// The C++ client beside which the package for Python is measured: plans the request of FILE each
/// time that it reads a seed, and writes the milliseconds and whether the path is proved.
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
    const auto begin = std::chrono::steady_clock::now();
    const camway::PlanResponse answer = client.plan(request);
    const std::chrono::duration<double, std::milli> taken =
        std::chrono::steady_clock::now() - begin;
    std::printf("%.6f %d\n", taken.count(), answer.ok() ? 1 : 0);
    std::fflush(stdout);
  }
  return 0;
}
