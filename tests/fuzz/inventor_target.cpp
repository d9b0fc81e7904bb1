// SPDX-License-Identifier: MIT
#include "daemon/scene/import/import.h"
#include "tests/fuzz/targets.h"
#include "tests/support/temporary_folder.h"

namespace camway::testing {
namespace {

/// Coin trusts its files, so a mutant may end the import process, and nothing else.
bool exercise_inventor_file(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return false;
  static const TemporaryFolder folder;
  const std::string file = folder.write("scene.iv", as_text(bytes));
  scene::ImportOptions options;
  options.time_limit_s = 5.0;
  options.memory_limit_bytes = std::size_t{1} << 30;
  const scene::ImportResult read = scene::import_mesh(file, options);
  promise(read.mesh.has_value() == read.error.empty(), "a mesh or a reason");
  promise(!read.mesh || read.report.surface_error_m >= 0.0, "the error of surfaces is a bound");
  return read.mesh.has_value();
}

std::vector<FuzzBytes> inventor_file_seeds() {
  const std::string points = "point [ 0 0 0, 1 0 0, 1 1 0, 0 1 0, 0 0 1, 1 0 1, 1 1 1, 0 1 1 ]";
  return {
      fuzz_bytes("#Inventor V2.1 ascii\nSeparator { Units { units FEET } Coordinate3 { " + points +
                 " } IndexedFaceSet { coordIndex [ 0,1,2,3,-1, 4,5,6,-1 ] } FaceSet { startIndex 1 "
                 "numVertices [ 3, -1 ] } TriangleStripSet { numVertices [ 5 ] } QuadMesh { "
                 "verticesPerColumn 2 verticesPerRow 4 } }\n"),
      fuzz_bytes(
          "#Inventor V2.1 ascii\nSeparator { Coordinate4 { point [ 0 0 0 1, 1 0 1 1, 2 0 0 "
          "1, 0 1 1 1, 1 1 5 2, 2 1 1 1, 0 2 0 1, 1 2 1 1, 2 2 0 1 ] } NurbsSurface { "
          "numUControlPoints 3 numVControlPoints 3 uKnotVector [ 0,0,0,1,1,1 ] vKnotVector [ "
          "0,0,0,1,1,1 ] } }\n"),
      fuzz_bytes(
          "#Inventor V2.1 ascii\nDEF a Switch { whichChild -3 LOD { range [ 1 ] Sphere { "
          "radius 2 } Cube { } } Array { numElements1 3 Cone { parts SIDES } } Text3 { string "
          "\"x\" } MultipleCopy { matrix [ 1 0 0 0 0 1 0 0 0 0 1 0 5 0 0 1 ] Cylinder { } } "
          "}\nUSE a\n"),
      fuzz_bytes("#VRML V1.0 ascii\nSeparator { Transform { translation 1 2 3 rotation 0 1 0 0.5 "
                 "scaleFactor 1 2 1 } Coordinate3 { " +
                 points +
                 " } IndexedFaceSet { coordIndex [ 0,1,2,3,-1 ] } WWWInline { name \"x.wrl\" } "
                 "IndexedLineSet { coordIndex [ 0,1,-1 ] } }\n"),
      fuzz_bytes(
          "#VRML V2.0 utf8\nPROTO P [ field SFVec3f size 1 2 3 ] { Shape { geometry Box { "
          "size IS size } } }\nTransform { translation 1 0 0 children [ P { } Shape { geometry "
          "Extrusion { spine [ 0 0 0, 0 1 0, 1 2 0 ] } } Shape { geometry ElevationGrid { "
          "xDimension 2 zDimension 2 height [ 0, 1, 2, 3 ] } } Shape { geometry "
          "IndexedFaceSet { coord Coordinate { " +
          points + " } coordIndex [ 0 1 2 3 -1 ] } } ] }\n")};
}

}  // namespace

constinit const FuzzTarget kInventorFileTarget{"inventor_file", exercise_inventor_file,
                                               inventor_file_seeds, 60};

}  // namespace camway::testing
