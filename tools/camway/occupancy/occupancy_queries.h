// SPDX-License-Identifier: MIT
#pragma once

#include <camway/occupancy.h>

#include <string>
#include <vector>

#include "daemon/scene/occupancy/occupancy_mirror.h"

namespace camway::tools {

/// Queries as they stand on the command line: numbers with commas between them.
struct OccupancyTexts {
  std::vector<std::string> points;        ///< x,y,z
  std::vector<std::string> boxes;         ///< xmin,ymin,zmin,xmax,ymax,zmax
  std::vector<std::string> spheres;       ///< x,y,z,radius
  std::vector<std::string> rays;          ///< ox,oy,oz,dx,dy,dz,range
  std::vector<std::string> distances;     ///< x,y,z,max
  std::vector<std::string> sphere_paths;  ///< x,y,z,x,y,z,radius
};

/// The batch that `texts` ask for, in their order. Otherwise `error` names the option and the text:
/// wrong count, not a finite number, a box turned inside out, a negative radius, range or distance,
/// a ray without direction.
struct ParsedBatch {
  OccupancyBatch batch;
  std::string error;  ///< empty if all is well
};
ParsedBatch parse_batch(const OccupancyTexts& texts);

/// What a daemon would answer, from a map in this process.
OccupancyAnswer answer_offline(const scene::OccupancyMirror& map, const OccupancyBatch& batch);

/// One line per query, in the words of the command line.
std::string describe(const OccupancyTexts& texts, const OccupancyAnswer& answer);

}  // namespace camway::tools
