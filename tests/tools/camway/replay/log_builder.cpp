// SPDX-License-Identifier: MIT
#include "tests/tools/camway/replay/log_builder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "lcmtypes/wire/pages.h"

namespace camway::tools {
namespace {

void append_big_endian(std::string& bytes, std::uint64_t value, int count) {
  for (int shift = 8 * (count - 1); shift >= 0; shift -= 8) {
    bytes += static_cast<char>(value >> shift & 0xFF);
  }
}

}  // namespace

void LogBuilder::add_event(const std::string& channel, const std::vector<std::uint8_t>& data) {
  constexpr std::uint64_t kFirstUtime = 1'700'000'000'000'000;
  constexpr std::uint64_t kStepUs = 1000;
  const std::uint64_t number = offsets_.size();
  offsets_.push_back(bytes_.size());
  append_big_endian(bytes_, 0xEDA1DA01, 4);
  append_big_endian(bytes_, number, 8);
  append_big_endian(bytes_, kFirstUtime + number * kStepUs, 8);
  append_big_endian(bytes_, channel.size(), 4);
  append_big_endian(bytes_, data.size(), 4);
  bytes_ += channel;
  bytes_.append(data.begin(), data.end());
}

void LogBuilder::add_request(const planning::PlanRequest& request, const messages::RequestIds& ids,
                             const std::string& prefix) {
  for (const wire::Bytes& page : wire::encode_pages(messages::to_wire(request, ids))) {
    add_event(prefix + "_PLAN_REQUEST", page);
  }
}

void LogBuilder::add_answer(const planning::PlanResult& result,
                            const messages::AnswerHeader& header, const std::string& prefix) {
  for (const wire::Bytes& page : wire::encode_pages(messages::to_wire(result, header))) {
    add_event(prefix + "_PLAN_RESPONSE_" + header.ids.client_id, page);
  }
}

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "camway-test-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) ADD_FAILURE() << "cannot make " << name;
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string TemporaryFolder::write(std::string_view name, std::string_view content) const {
  const std::string path = file(name);
  std::ofstream(path, std::ios::binary) << content;
  return path;
}

std::string read_all(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  EXPECT_TRUE(stream) << file;
  return {std::istreambuf_iterator<char>(stream), {}};
}

planning::PlanRequest simple_request(const std::vector<geometry::Vec3>& positions_m) {
  planning::PlanRequest request;
  request.scene = "wall";
  request.camera = {1.2, 0.9, 0.1};
  for (const geometry::Vec3& position : positions_m) {
    motion::Keyframe keyframe;
    keyframe.pose.position = position;
    request.keyframes.push_back(keyframe);
  }
  return request;
}

scene::Mesh wall_mesh() {
  scene::Mesh mesh;
  mesh.vertices = {{-0.2, -1, 0}, {0.2, -1, 0}, {0.2, 1, 0}, {-0.2, 1, 0},
                   {2, -1, -0.2}, {2, -1, 0.2}, {2, 1, 0.2}, {2, 1, -0.2}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  mesh.objects = {{"wall", 0, 2}, {"fin", 2, 2}};
  return mesh;
}

std::string wall_obj() {
  return "o wall\nv -0.2 -1 0\nv 0.2 -1 0\nv 0.2 1 0\nv -0.2 1 0\nf 1 2 3\nf 1 3 4\n"
         "o fin\nv 2 -1 -0.2\nv 2 -1 0.2\nv 2 1 0.2\nv 2 1 -0.2\nf 5 6 7\nf 5 7 8\n";
}

}  // namespace camway::tools
