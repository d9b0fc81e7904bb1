// SPDX-License-Identifier: MIT
// A client process of the integration tests:
//
//   planning_client CLIENT_ID SCENE REQUEST.json...
//
// plans each request and prints `answer FILE STATUS HASH-OF-THE-PATH`, followed by the error if
// there is one. Exit code 0 if the daemon answered all requests with any status; 1 if not.
#include <camway/client.h>

#include <cstdint>
#include <cstring>
#include <iostream>
#include <string>
#include <type_traits>

#include "tools/json/json_request.h"
#include "tools/support/client_request.h"

namespace {

/// Returns the FNV-1a hash of the bits of all numbers.
std::uint64_t hash_of(const camway::Path& path) {
  static_assert(sizeof(camway::Segment) == 42 * sizeof(double), "no padding to hash");
  std::uint64_t hash = 14695981039346656037u;
  for (const camway::Segment& segment : path.segments()) {
    unsigned char bytes[sizeof(segment)];
    std::memcpy(bytes, &segment, sizeof(segment));
    for (const unsigned char byte : bytes) hash = (hash ^ byte) * 1099511628211u;
  }
  return hash;
}

bool from_daemon(camway::Status status) { return static_cast<int>(status) < 100; }

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  camway::ClientOptions options;
  options.client_id = argv[1];
  options.retries = 1000;
  camway::Client client(options);
  bool all_answered = true;
  for (int i = 3; i < argc; ++i) {
    const auto request = camway::tools::read_as<camway::tools::RequestFile>(argv[i]);
    if (!request) {
      std::cerr << request.error << '\n';
      return 2;
    }
    const camway::PlanResponse response =
        client.plan(camway::tools::to_client_request(*request, argv[2]));
    std::cout << "answer " << argv[i] << ' ' << to_string(response.status) << ' ' << std::hex
              << hash_of(response.path) << std::dec << std::endl;
    if (!response.ok()) std::cout << "error " << response.error << std::endl;
    all_answered = all_answered && from_daemon(response.status);
  }
  return all_answered ? 0 : 1;
}
