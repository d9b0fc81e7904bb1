// SPDX-License-Identifier: MIT
#include "tools/make_scenes/catalogue.h"

#include <algorithm>
#include <stdexcept>

#include "tools/make_scenes/gallery.h"
#include "tools/make_scenes/maze.h"
#include "tools/make_scenes/office.h"

namespace camway::make_scenes {
namespace {

/// Throws if a keyframe collides, because that would make the request invalid.
void check_keyframes(const Entry& entry) {
  for (const Request& request : entry.requests) {
    if (!request.times_ms.empty() && request.times_ms.size() != request.views.size()) {
      throw std::logic_error(request.name + ": times and keyframes differ in number");
    }
    for (std::size_t i = 0; i < request.views.size(); ++i) {
      const double clearance =
          clearance_m(entry.scene.triangles(), request.lens, request.views[i], 1.0);
      if (clearance < kLeastClearanceM) {
        throw std::logic_error(request.name + ": keyframe " + std::to_string(i) + " has only " +
                               std::to_string(clearance) + " m of clearance");
      }
    }
  }
}

std::string table_row(const Request& request) {
  return "| `requests/" + request.name + ".json` | " + std::to_string(request.views.size()) +
         (request.times_ms.empty() ? "" : ", timed") + " | " +
         std::to_string(request.lens.fov_x_deg) + " x " + std::to_string(request.lens.fov_y_deg) +
         "°, " + std::to_string(request.lens.near / 10000) + " cm | " + request.purpose + " |\n";
}

}  // namespace

std::vector<Entry> make_catalogue() {
  std::vector<Entry> entries;
  entries.push_back(
      {"office.obj", "office building",
       "Three storeys of 30 x 20 m: a corridor on each from west to east with rooms on "
       "both sides, stairs north of its middle, an atrium with columns south of it, "
       "open from the ground floor to the roof. Doors are openings of 0.95 x 2.1 m in "
       "walls of 20 cm. The lift shaft and the safe are closed on all sides. In the "
       "spirit of the Soda Hall model of the UC Berkeley Walkthrough Group; no part "
       "of that model is in it.",
       make_office(), office_requests(), true});
  entries.push_back({"maze.obj", "maze",
                     "10 x 8 cells of 2 m between walls of 20 cm, with floor and ceiling, an "
                     "entrance in the west and an exit in the east; several ways round.",
                     Maze(kMazeSeed).scene(), maze_requests()});
  entries.push_back({"gallery.obj", "gallery of thin and nasty things",
                     "A corridor of 40 m with exhibits: a floating cube of 5 cm, poles of 1 cm, "
                     "wires of 1 mm, single triangles, plates without thickness, a louvre, a ring, "
                     "240 triangles at one vertex, slivers, duplicated and degenerate triangles "
                     "(3, which an import drops), a rod, a wall with a narrow slot.",
                     make_gallery(), gallery_requests()});
  for (const Entry& entry : entries) check_keyframes(entry);
  return entries;
}

std::string readme(const std::vector<Entry>& entries) {
  std::string text =
      "# Scenes and requests\n\n"
      "Made by `tools/make_scenes/main.cpp`; do not edit. `make_scenes --out scenes` writes the "
      "same bytes everywhere, and a test\ncompares them. Metres, y up, right-handed; every object "
      "has a name. All keyframes keep a clearance of 2 cm or more.\n\n"
      "- **free**: the interpolated path does not collide.\n"
      "- **graze**: it clips furniture, door frames, columns or something thin.\n"
      "- **wall**: consecutive keyframes lie on different sides of a wall, with a way round.\n"
      "- **impossible**: a keyframe lies inside a closed box, another outside.\n";
  for (const Entry& entry : entries) {
    text += "\n## " + entry.file + "\n\n" + entry.note + "\n\n" +
            std::to_string(entry.scene.triangles().size()) + " triangles, " +
            std::to_string(entry.scene.objects().size()) + " objects." +
            (entry.also_unigrafix ? " The `.ug` file is the same scene in UniGrafix." : "") +
            "\n\n" +
            "| request | keyframes | field of view, near | what for |\n|---|---|---|---|\n";
    for (const Request& request : entry.requests) text += table_row(request);
  }
  return text;
}

}  // namespace camway::make_scenes
