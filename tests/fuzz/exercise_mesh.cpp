// SPDX-License-Identifier: MIT
#include "tests/fuzz/exercise_mesh.h"

#include "daemon/scene/import/readers/mesh_collector.h"
#include "daemon/scene/import/readers/mesh_reader.h"
#include "tests/fuzz/targets.h"
#include "tests/scene/import/readers/mesh_files.h"

namespace camway::testing {
namespace {

namespace format = scene::import_record;

}  // namespace

bool exercise_mesh(std::string_view extension, std::string_view bytes) {
  const auto read = scene::mesh_readers::read_mesh(extension, bytes);
  if (!read) return false;
  const format::Record& record = *read;
  promise(record.vertices.size() <= bytes.size(), "no vertex without a byte");
  promise(record.triangles.size() <= bytes.size(), "no triangle without a byte");
  promise(!record.text.empty(), "the format has a name");
  promise(!record.objects.empty(), "there is an object");
  std::uint64_t triangles = 0;
  std::uint64_t name_bytes = 0;
  for (const format::Object& object : record.objects) {
    triangles += object.triangles;
    name_bytes += object.name_bytes;
  }
  promise(triangles == record.triangles.size(), "objects cover all triangles");
  promise(name_bytes == record.names.size(), "objects have all names");
  promise(name_bytes <= 256 * record.objects.size(), "names are short");
  for (const format::Triangle& triangle : record.triangles) {
    for (const std::uint32_t corner : triangle) {
      promise(corner < record.vertices.size() || corner == scene::mesh_readers::kNoVertex,
              "corners are vertices, or none");
    }
  }
  return true;
}

std::vector<MeshFile> malformed_mesh_files() {
  using namespace std::string_literals;
  const std::string ply = "ply\nformat ascii 1.0\n";
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  const std::string faces = "property list uchar int vertex_indices\nend_header\n";
  const std::string binary = "ply\nformat binary_little_endian 1.0\n";
  std::string stl_bomb = "no text";
  stl_bomb.resize(80);
  stl_bomb += "\xff\xff\xff\xff";
  std::string nested;
  for (int i = 0; i < 2000; ++i) nested += "solid facet ";
  return {
      {".obj", ""},
      {".obj", "\0\0\0\0"s},
      {".obj", "v 1e999 -1e999 1e-999\nf 1 1 1 1\nf -1 -2 -9223372036854775808\n"},
      {".obj", "v\nv 1\nf\nf /\nf //\nf 1/ /2 3//\nf 99999999999999999999 1 2\n"},
      {".obj", "f 1 2 3 \\"},
      {".obj", "\\\\\\\n\\\n\\"},
      {".obj", "v 0 0 0" + std::string(100'000, ' ') + "\nf" + std::string(50'000, '1')},
      {".obj", "v 1 2\0003 4\nf 1\0001 1\n"s},
      {".obj", "o " + std::string(100'000, 'x') + "\nv 0 0 0\nf 1 1 1\nusemtl " +
                   std::string(100'000, 'y') + "\nf 1 1 1\n"},
      {".off", ""},
      {".off", "OFF"},
      {".off", "OFF\n400000000 1 0\n0 0 0 0 \n"},
      {".off", "OFF\n-1 -1 0\n"},
      {".off", "OFF\n18446744073709551616 1 0\n"},
      {".off", "OFF\n9223372036854775807 9223372036854775807 0\n"},
      {".off", "OFF\n1 1 0\n0 0 0\n4000000000 0 0 0\n"},
      {".off", "OFF\n1 2 0\n0 0 1e999\n3 0 0 -1\n3 0 0 99999999999\n"},
      {".off", "OFF\n3 1 0\n0 0"},
      {".off", "OFF BINARY\n\0\0\0\1"s},
      {".off", "4OFF\n1 1 0\n1 2 3 0\n3 0 0 0\n"},
      {".ply", ""},
      {".ply", "ply"},
      {".ply", "ply\n"},
      {".ply", ply + "element vertex 99999999999999\n" + xyz + "end_header\n0 0 0\n"},
      {".ply", ply + "element vertex -1\n" + xyz + "end_header\n"},
      {".ply", ply + "element vertex 1\n" + xyz + "element face 1\n" + faces + "0 0 0\n-1 0\n"},
      {".ply", ply + "element vertex 1\n" + xyz + "element face 1\n" + faces + "0 0 0\n1e9 0\n"},
      {".ply",
       ply + "element vertex 1\n" + xyz + "element face 1\n" + faces + "nan 0 0\n3 0 nan 1e99"},
      {".ply",
       ply + "element vertex 1\n" + xyz + "element vertex 1\n" + xyz + "end_header\n0 0 0 0 0 0"},
      {".ply", ply + "element face 9\nelement vertex 1\n" + xyz + "end_header\n0 0 0"},
      {".ply", ply + "property float x\nend_header\n"},
      {".ply", ply + "element vertex 1\nproperty list float int x\nend_header\n"},
      {".ply", "ply\nelement vertex 1\n" + xyz + "end_header\n"},
      {".ply", binary + "element vertex 4000000000\n" + xyz + "end_header\n\0\0\0\0"s},
      {".ply", binary + "element vertex 1\n" + xyz +
                   "element face 1\nproperty list int int "
                   "vertex_indices\nend_header\n\0\0\0\0\0\0\0\0\0\0\0\0\xff\xff\xff\x7f"s},
      {".ply", binary + "element vertex 1\n" + xyz +
                   "element face 1\nproperty list int int "
                   "vertex_indices\nend_header\n\0\0\0\0\0\0\0\0\0\0\0\0\xff\xff\xff\xff"s},
      {".stl", ""},
      {".stl", stl_bomb},
      {".stl", "solid"},
      {".stl", nested},
      {".stl", "solid x\nfacet\nvertex 0 0 0\nendfacet\n"},
      {".stl", "solid x\nvertex 0 0 0\n"},
      {".stl", "solid x\nfacet\nvertex 0 0"},
      {".stl", "solid x\nfacet\nvertex 1e999 nan x\nvertex 0 0 0\nvertex 0 1 0\nendfacet\n"},
  };
}

std::vector<MeshFile> sound_mesh_files() {
  namespace files = scene::testing;
  files::Random random(files::kMeshSeed);
  std::vector<MeshFile> all;
  for (int i = 0; i < 8; ++i) {
    const files::TriangleSoup soup = files::random_soup(random, files::Numbers::kFloats);
    all.push_back({".obj", write_obj(soup, random)});
    all.push_back({".off", write_off(soup, random)});
    for (const auto encoding : {files::PlyEncoding::kText, files::PlyEncoding::kLittleEndian,
                                files::PlyEncoding::kBigEndian}) {
      all.push_back({".ply", write_ply(soup, files::Numbers::kFloats, encoding, random)});
    }
    all.push_back({".stl", write_text_stl(soup, random)});
    all.push_back({".stl", write_binary_stl(soup)});
  }
  all.push_back({".obj",
                 "v 0 0 0\nv 2 0 0\nv 1 1 0\nv 2 2 0\nv 0 2 0\no a\nusemtl b\nf 1 2 3 4 5\n"
                 "usemtl c\nl 1 2\np 1\nf -1 -2 -3\\\n -4\n"});
  return all;
}

}  // namespace camway::testing
