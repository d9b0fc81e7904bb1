// SPDX-License-Identifier: MIT
// make_scenes --out DIR: writes our scenes, their requests and the README that lists them.

#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>

#include "tools/make_scenes/catalogue.h"

namespace {

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << text;
  out.close();
  if (!out) throw std::runtime_error("cannot write " + file.string());
}

void write_all(const std::filesystem::path& folder) {
  using namespace camway::make_scenes;
  const std::vector<Entry> entries = make_catalogue();
  std::filesystem::create_directories(folder / "requests");
  for (const Entry& entry : entries) {
    write(folder / entry.file, entry.scene.obj(entry.title));
    if (entry.also_unigrafix) {
      write((folder / entry.file).replace_extension(".ug"), entry.scene.unigrafix(entry.title));
    }
    for (const Request& request : entry.requests) {
      write(folder / "requests" / (request.name + ".json"), to_json(request, entry.file));
    }
    std::cout << entry.file << ": " << entry.scene.triangles().size() << " triangles, "
              << entry.requests.size() << " requests\n";
  }
  write(folder / "README.md", readme(entries));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3 || std::string(argv[1]) != "--out") {
    std::cerr << "usage: make_scenes --out DIR\n";
    return 2;
  }
  try {
    write_all(argv[2]);
  } catch (const std::exception& error) {
    std::cerr << "make_scenes: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
