// SPDX-License-Identifier: MIT
#pragma once

#include <camway/occupancy.h>

#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/scene/mirror/scene_mirror.h"

namespace camway::tools {

/// Queries as written on the command line: numbers separated by commas.
struct OccupancyTexts {
  std::vector<std::string> points;        ///< x,y,z
  std::vector<std::string> boxes;         ///< xmin,ymin,zmin,xmax,ymax,zmax
  std::vector<std::string> spheres;       ///< x,y,z,radius
  std::vector<std::string> rays;          ///< ox,oy,oz,dx,dy,dz,range
  std::vector<std::string> distances;     ///< x,y,z,max
  std::vector<std::string> sphere_paths;  ///< x,y,z,x,y,z,radius
};

/// Returns the queries of `texts` in their order, or an error that names the option and the text:
/// wrong count, not a finite number, a box with min above max, a negative radius, range or
/// distance, or a ray of zero length.
base::Result<OccupancyBatch> parse_batch(const OccupancyTexts& texts);

/// Returns the answer to a batch from a map in this process, the same as a daemon's.
OccupancyAnswer answer_offline(const scene::SceneMirror& map, const OccupancyBatch& batch);

/// Returns a line for each query, with its text from the command line.
std::string describe(const OccupancyTexts& texts, const OccupancyAnswer& answer);

}  // namespace camway::tools
