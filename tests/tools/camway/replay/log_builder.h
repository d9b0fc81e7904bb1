// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/planning/request/request.h"
#include "daemon/planning/result/result.h"
#include "daemon/scene/mesh/mesh.h"
#include "tests/messages/request_on_wire.h"

namespace camway::tools {

/// Writes an event log like lcm-logger, by the description in LCM's manual. Shares no code with the
/// reader.
class LogBuilder {
 public:
  void add_event(const std::string& channel, const std::vector<std::uint8_t>& data);

  /// Adds all pages of a request.
  void add_request(const planning::PlanRequest& request, const messages::RequestIds& ids,
                   const std::string& prefix = "CAMWAY");
  void add_answer(const planning::PlanResult& result, const messages::AnswerHeader& header,
                  const std::string& prefix = "CAMWAY");

  [[nodiscard]] const std::string& bytes() const { return bytes_; }
  /// Returns the length of the log before each event.
  [[nodiscard]] const std::vector<std::size_t>& offsets() const { return offsets_; }

 private:
  std::string bytes_;
  std::vector<std::size_t> offsets_;
};

/// A new folder, which the destructor removes.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] std::string file(std::string_view name) const { return (path_ / name).string(); }
  /// Writes a file into the folder and returns its path.
  std::string write(std::string_view name, std::string_view content) const;

 private:
  std::filesystem::path path_;
};

std::string read_all(const std::string& file);

/// Returns a request with a camera that looks along -Z, with keyframes at `positions_m`.
planning::PlanRequest simple_request(const std::vector<geometry::Vec3>& positions_m);

/// Returns two obstacles that the paper's method can correct: a wall in the plane z = 0, 0.4 m wide
/// and 2 m high, to hit head on; and a fin in the plane x = 2, from z = -0.2 to 0.2, to hit with a
/// side.
scene::Mesh wall_mesh();
/// Returns these obstacles as an OBJ file.
std::string wall_obj();

}  // namespace camway::tools
