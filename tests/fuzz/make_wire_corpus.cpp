// SPDX-License-Identifier: MIT
//
// Writes the messages that the fuzzer starts from: make_wire_corpus FOLDER
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

#include <camway/cancel_t.hpp>
#include <camway/missing_pages_t.hpp>
#include <camway/occupancy_request_t.hpp>
#include <camway/plan_progress_t.hpp>
#include <camway/plan_request_t.hpp>
#include <camway/plan_response_t.hpp>
#include <camway/scene_request_t.hpp>
#include <camway/upload_page_t.hpp>
#include <camway/watch_report_t.hpp>
#include <camway/watch_t.hpp>

#include "lcmtypes/wire_check.h"
#include "tests/service/random_messages.h"

namespace {

using camway::testing::Random;

void write(const std::filesystem::path& file, const std::vector<std::uint8_t>& bytes) {
  std::ofstream stream(file, std::ios::binary);
  for (const std::uint8_t byte : bytes) stream.put(static_cast<char>(byte));
}

template <class Message>
void write_messages(const std::filesystem::path& folder, Random& random) {
  constexpr int kMessages = 30;
  for (int i = 0; i < kMessages; ++i) {
    const std::string name = std::string(Message::getTypeName()) + "_" + std::to_string(i);
    write(folder / name, camway::wire::encode(camway::testing::random_message<Message>(random)));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: make_wire_corpus FOLDER\n";
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  Random random(camway::testing::kSeed);
  write_messages<camway::plan_request_t>(folder, random);
  write_messages<camway::occupancy_request_t>(folder, random);
  write_messages<camway::plan_response_t>(folder, random);
  write_messages<camway::cancel_t>(folder, random);
  write_messages<camway::missing_pages_t>(folder, random);
  write_messages<camway::plan_progress_t>(folder, random);
  write_messages<camway::scene_request_t>(folder, random);
  write_messages<camway::upload_page_t>(folder, random);
  write_messages<camway::watch_t>(folder, random);
  write_messages<camway::watch_report_t>(folder, random);
  return 0;
}
