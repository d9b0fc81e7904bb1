// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "tools/make_scenes/request.h"
#include "tools/make_scenes/solid.h"

namespace camway::make_scenes {

/// A scene file and its requests.
struct Entry {
  std::string file;  ///< name of the file, such as "office.obj"
  std::string title;
  std::string note;  ///< text for scenes/README.md
  Scene scene;
  std::vector<Request> requests;
  bool also_unigrafix = false;  ///< also written as a UniGrafix file of the same name
};

/// Returns the content of `scenes/`, in order. Throws std::logic_error with the request's name and
/// the keyframe's number if a keyframe is nearer than `kLeastClearanceM` to its own scene.
std::vector<Entry> make_catalogue();

constexpr double kLeastClearanceM = 0.02;

/// Returns the text of scenes/README.md.
std::string readme(const std::vector<Entry>& entries);

std::vector<Request> office_requests();
std::vector<Request> maze_requests();
std::vector<Request> gallery_requests();

constexpr std::uint64_t kMazeSeed = 11;

}  // namespace camway::make_scenes
