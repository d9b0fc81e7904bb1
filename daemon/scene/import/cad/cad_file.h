// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <TopoDS_Shape.hxx>

#include "daemon/base/result.h"

namespace camway::scene::cad {

/// The library computes in millimetres.
inline constexpr double kMillimetre_m = 1e-3;

/// A solid, or faces that belong to none, with its placement.
struct CadPart {
  std::string name;
  TopoDS_Shape shape;
};

/// The contents of a file. Lengths of shapes are in millimetres.
struct CadFile {
  std::string format;
  double unit_m = 0.0;  ///< metres per unit of the file
  std::string unit;     ///< in words
  std::vector<CadPart> parts;
  std::uint64_t roots_lost = 0;  ///< that the library could not read
  std::uint64_t entities_with_errors = 0;
};

/// Reads a STEP file, or an IGES file if `is_iges`, and places the parts of its assemblies. A part
/// is named after the innermost product that has a name and after its own, such as "bracket/rib",
/// or else `part_1` and so on. Fails with the reason. Throws what the library throws.
base::Result<CadFile> read_cad_file(const std::string& file, bool is_iges);

}  // namespace camway::scene::cad
