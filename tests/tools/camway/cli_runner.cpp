// SPDX-License-Identifier: MIT
#include "tests/tools/camway/cli_runner.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace camway::tools {

CliRun run_camway(const std::vector<std::string>& arguments, const std::string& input_file) {
  const TemporaryFolder folder;
  const std::string out = folder.file("out");
  const std::string err = folder.file("err");
  const std::string in = input_file.empty() ? "/dev/null" : input_file;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, in.c_str(), O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, out.c_str(), O_WRONLY | O_CREAT, 0600);
  posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), O_WRONLY | O_CREAT, 0600);
  std::vector<std::string> words{CAMWAY_BINARY};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t child = 0;
  const int error = posix_spawn(&child, CAMWAY_BINARY, &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  CliRun run;
  if (error != 0) {
    ADD_FAILURE() << "cannot start " << CAMWAY_BINARY;
    return run;
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFEXITED(status)) run.exit_code = WEXITSTATUS(status);
  run.out = read_all(out);
  run.err = read_all(err);
  return run;
}

std::string keyframe_json(double x, double y, double z) {
  return fmt::format(R"({{"position": [{}, {}, {}], "orientation": [1, 0, 0, 0]}})", x, y, z);
}

std::string request_json(const std::vector<std::string>& keyframes, const std::string& scene) {
  std::string list;
  for (const std::string& keyframe : keyframes) list += (list.empty() ? "" : ",\n    ") + keyframe;
  return fmt::format(R"({{
  "scene": "{}",
  "camera": {{"fov_x_deg": 70, "fov_y_deg": 50, "near": 0.1}},
  "keyframes": [
    {}]
}}
)",
                     scene, list);
}

}  // namespace camway::tools
