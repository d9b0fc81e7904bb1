// SPDX-License-Identifier: MIT
#include "tests/bench/command_line.h"

#include <fmt/format.h>

#include <cstdio>

#include "tests/bench/measure.h"

namespace camway::bench {

void add_request_options(CLI::App& app, RequestSource& source) {
  app.add_option("--requests", source.requests, "folder of requests, or one request")
      ->capture_default_str();
  app.add_option("--scene", source.scene, "scene of all requests, instead of the one named");
  app.add_option("--scale", source.scale, "multiplies the scene's coordinates")
      ->capture_default_str();
  app.add_option("--only", source.only, "requests with this in their name alone");
  app.add_option("--each", source.each, "so many requests of each difficulty at most");
}

void add_set_option(CLI::App& app, std::vector<RequestSet>& sets) {
  app.add_option("--set", sets, "in place of --requests, --scene, --scale; any number of them")
      ->type_name("REQUESTS SCENE SCALE");
}

void add_rounds_option(CLI::App& app, int& rounds) {
  app.add_option("--rounds", rounds, "repetitions")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
}

void add_json_option(CLI::App& app, std::string& file) {
  app.add_option("--json", file, "write all numbers to this file");
}

nlohmann::json document_of(const std::string& benchmark) {
  return {{"benchmark", benchmark}, {"machine", machine()}};
}

int finish(const nlohmann::json& document, const std::string& json_file) {
  const std::string error = write_json(json_file, document);
  if (!error.empty()) fmt::print(stderr, "bench: {}\n", error);
  return error.empty() ? 0 : 1;
}

}  // namespace camway::bench
