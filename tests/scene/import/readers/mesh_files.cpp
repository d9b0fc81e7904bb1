// SPDX-License-Identifier: MIT
#include "tests/scene/import/readers/mesh_files.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <string_view>

namespace camway::scene::testing {
namespace {

double random_double(Random& random) {
  const double unit = static_cast<double>(random() >> 11) * 0x1p-53 - 0.5;
  switch (below(random, 5)) {
    case 0:
      return below(random, 2) == 0 ? 0.0 : -0.0;
    case 1:
      return 1e6 + unit * 1e-2;
    case 2:
      return std::ldexp(unit, static_cast<int>(below(random, 300)) - 150);
    default:
      return 20.0 * unit;
  }
}

double random_number(Random& random, Numbers numbers) {
  switch (numbers) {
    case Numbers::kDoubles:
      return random_double(random);
    case Numbers::kFloats:
      return double{static_cast<float>(random_double(random))};
    case Numbers::kSmallIntegers:
      break;
  }
  return static_cast<double>(below(random, 128));
}

/// Returns one of `choices`; a choice that is listed twice is twice as likely.
std::string_view one_of(Random& random, std::initializer_list<std::string_view> choices) {
  return *(choices.begin() + below(random, choices.size()));
}

std::string coordinates(const std::array<double, 3>& v, std::string_view blank) {
  return decimal(v[0]) + std::string(blank) + decimal(v[1]) + std::string(blank) + decimal(v[2]);
}

/// Writes numbers as bytes or as words of text.
class Values {
 public:
  explicit Values(PlyEncoding encoding) : encoding_(encoding) {}

  void put(std::string_view type, double value) {
    if (encoding_ == PlyEncoding::kText) {
      text_ += decimal(value) + " ";
    } else if (type == "double" || type == "float64") {
      put_bits(std::bit_cast<std::uint64_t>(value), 8);
    } else if (type == "float" || type == "float32") {
      put_bits(std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4);
    } else {
      put_bits(static_cast<std::uint64_t>(static_cast<std::int64_t>(value)), integer_bytes(type));
    }
  }
  void end_line() {
    if (encoding_ == PlyEncoding::kText) text_ += "\n";
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  static std::size_t integer_bytes(std::string_view type) {
    if (type.ends_with("char") || type.ends_with("int8")) return 1;
    if (type.ends_with("short") || type.ends_with("int16")) return 2;
    return 4;
  }
  void put_bits(std::uint64_t bits, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t byte = encoding_ == PlyEncoding::kBigEndian ? size - 1 - i : i;
      text_ += static_cast<char>(bits >> (8 * byte));
    }
  }

  PlyEncoding encoding_;
  std::string text_;
};

struct PlyWriter {
  const TriangleSoup& soup;
  Numbers numbers;
  Random& random;
  std::string header;
  Values body;

  void write_vertices() {
    std::string_view type = one_of(random, {"double", "float64"});
    if (numbers == Numbers::kFloats) type = one_of(random, {"float", "float32", "double"});
    if (numbers == Numbers::kSmallIntegers) {
      type = one_of(random, {"char", "uchar", "short", "ushort", "int", "uint", "int8", "uint16"});
    }
    const std::string t(type);
    header += "element vertex " + std::to_string(soup.vertices.size()) + "\n";
    header += "property uchar red\nproperty " + t + " y\nproperty list uchar short tags\n";
    header += "property " + t + " x\nproperty " + t + " z\nproperty double quality\n";
    for (const auto& v : soup.vertices) {
      body.put("uchar", 200);
      body.put(type, v[1]);
      const auto tags = static_cast<double>(below(random, 3));
      body.put("uchar", tags);
      for (double i = 0; i < tags; ++i) body.put("short", -7);
      body.put(type, v[0]);
      body.put(type, v[2]);
      body.put("double", 0.5);
      body.end_line();
    }
  }
  void write_faces() {
    const std::string_view count = one_of(random, {"uchar", "char", "ushort", "int", "uint32"});
    const std::string_view index = one_of(random, {"int", "uint", "int32", "double", "float32"});
    header += "element face " + std::to_string(soup.triangles.size()) + "\n";
    header += "property float weight\nproperty list " + std::string(count) + " " +
              std::string(index) + " " +
              std::string(one_of(random, {"vertex_indices", "vertex_index"})) +
              "\nproperty uchar flag\n";
    for (const auto& triangle : soup.triangles) {
      body.put("float", 0.25);
      body.put(count, 3);
      for (const std::uint32_t corner : triangle) body.put(index, corner);
      body.put("uchar", 1);
      body.end_line();
    }
  }
  void write_unknown() {
    header += "element camera 2\nproperty list uint8 double view\nproperty int id\n";
    for (int i = 0; i < 2; ++i) {
      body.put("uint8", 2);
      body.put("double", 0.5);
      body.put("double", -1.0);
      body.put("int", -5);
      body.end_line();
    }
  }
};

}  // namespace

std::uint64_t below(Random& random, std::uint64_t below) { return random() % below; }

TriangleSoup random_soup(Random& random, Numbers numbers) {
  TriangleSoup soup;
  soup.vertices.resize(3 + below(random, 40));
  for (auto& vertex : soup.vertices) {
    for (double& x : vertex) x = random_number(random, numbers);
  }
  soup.triangles.resize(1 + below(random, 60));
  for (auto& triangle : soup.triangles) {
    for (std::uint32_t& corner : triangle) {
      corner = static_cast<std::uint32_t>(below(random, soup.vertices.size()));
    }
  }
  return soup;
}

std::string decimal(double value) {
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

std::string write_obj(const TriangleSoup& soup, Random& random) {
  const std::string end(one_of(random, {"\n", "\r\n", "\r"}));
  std::string file =
      "# a comment" + end + "mtllib none.mtl" + end + "vt 0 0" + end + "vn 0 0 1" + end;
  const std::int64_t count = static_cast<std::int64_t>(soup.vertices.size());
  for (const auto& v : soup.vertices) {
    const std::string blank(one_of(random, {" ", "  ", "\t"}));
    file += "v" + blank + coordinates(v, blank);
    file += std::string(one_of(random, {"", " ", " 1", " 0.5 0.25 1", " # red"})) + end;
  }
  for (const auto& triangle : soup.triangles) {
    file += below(random, 4) == 0 ? "f \\" + end : "f ";
    const std::string tail(one_of(random, {"", "/1", "//1", "/1/1"}));
    for (const std::uint32_t corner : triangle) {
      const bool from_end = below(random, 2) == 0;
      file += std::to_string(from_end ? std::int64_t{corner} - count : std::int64_t{corner} + 1);
      file += tail + " ";
    }
    file += end;
  }
  return file;
}

std::string write_off(const TriangleSoup& soup, Random& random) {
  const std::string end(one_of(random, {"\n", "\r\n"}));
  const std::string_view kind = one_of(random, {"OFF", "COFF", "NOFF", "STOFF", "4OFF", "STCNOFF"});
  std::string file(kind);
  file += std::string(one_of(random, {" ", "\n", "\n# a comment\n\n"}));
  file += std::to_string(soup.vertices.size()) + " " + std::to_string(soup.triangles.size());
  file += std::string(one_of(random, {" 0", ""})) + end;
  for (const auto& v : soup.vertices) {
    file += coordinates(v, " ") + (kind == "4OFF" ? " 1" : "");
    if (kind.find('N') != std::string_view::npos) file += " 0 0 1";
    if (kind.find('C') != std::string_view::npos) {
      file += std::string(one_of(random, {" 255 0 0 255", " 0.5 1 0", " 3"}));
    }
    if (kind.starts_with("ST")) file += " 0 1";
    file += std::string(one_of(random, {"", " # a comment"})) + end;
  }
  for (const auto& t : soup.triangles) {
    file += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + "  " + std::to_string(t[2]);
    file += std::string(one_of(random, {"", " 255 0 0", " 0.5 0.5 0.5 1"})) + end;
  }
  return file;
}

std::string write_ply(const TriangleSoup& soup, Numbers numbers, PlyEncoding encoding,
                      Random& random) {
  constexpr std::array<std::string_view, 3> kNames = {"ascii", "binary_little_endian",
                                                      "binary_big_endian"};
  PlyWriter writer{soup, numbers, random, "", Values(encoding)};
  writer.header = "ply\nformat " + std::string(kNames[static_cast<std::size_t>(encoding)]) +
                  " 1.0\ncomment by hand\nobj_info x\n";
  const bool faces_first = below(random, 3) == 0;
  if (below(random, 2) == 0) writer.write_unknown();
  faces_first ? writer.write_faces() : writer.write_vertices();
  if (below(random, 2) == 0) writer.write_unknown();
  faces_first ? writer.write_vertices() : writer.write_faces();
  std::string header = writer.header + "end_header\n";
  const std::string end(one_of(random, {"\n", "\r\n"}));
  for (std::size_t at = header.find('\n'); at != std::string::npos;
       at = header.find('\n', at + end.size())) {
    header.replace(at, 1, end);
  }
  return header + writer.body.text();
}

std::string write_text_stl(const TriangleSoup& soup, Random& random) {
  const std::string end(one_of(random, {"\n", "\r\n"}));
  std::string file = "solid first" + end;
  for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
    if (i > 0 && below(random, 10) == 0) file += "endsolid solid" + end + "solid" + end;
    file += "facet normal 0 0 1" + end + "  outer loop" + end;
    for (const std::uint32_t corner : soup.triangles[i]) {
      file += "    vertex " + coordinates(soup.vertices[corner], " ") + end;
    }
    file += "  endloop" + end + "endfacet" + end;
  }
  return file + "endsolid" + end;
}

std::string write_binary_stl(const TriangleSoup& soup) {
  std::string header = "solid as many begin";
  header.resize(80);
  Values values(PlyEncoding::kLittleEndian);
  values.put("uint", static_cast<double>(soup.triangles.size()));
  for (const auto& triangle : soup.triangles) {
    for (int i = 0; i < 3; ++i) values.put("float", 0.5);
    for (const std::uint32_t corner : triangle) {
      for (const double x : soup.vertices[corner]) values.put("float", x);
    }
    values.put("ushort", 9);
  }
  return header + values.text();
}

}  // namespace camway::scene::testing
