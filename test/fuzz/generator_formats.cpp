// SPDX-License-Identifier: BSD-3-Clause
#include "generator_scans.h"
#include "layouts.h"
#include "targets.h"
#include <algorithm>
#include <fresco/core/require.h>
#include <functional>
#include <map>
namespace fresco::fuzz {
namespace {
/// A value as text or binary.
struct Encoding {
  bool binary = false, swapped = false;

  template <typename T>
  std::string operator()(T value) const
  {
    return binary ? raw(value, swapped) : concat(+value, ' ');
  }
  std::string line() const { return binary ? "" : "\n"; }
};

GeneratedFile ply(Dice& dice)
{
  const std::string format = dice.of<std::string>({"ascii", "binary_little_endian", "binary_big_endian"});
  const Encoding put{format != "ascii", format == "binary_big_endian"};
  const int vertices = dice.between(3, 9), faces = dice.between(0, 5);
  const bool colors = dice.chance(), normals = dice.chance(), lists = dice.chance(), strips = dice.chance();
  Parts parts{"ply\n", "format " + format + " 1.0\n", "comment c\n", "comment TextureFile t.png\n"}, data;
  parts.push_back(concat("element vertex ", vertices, "\n"));
  for (const std::string name : {"x", "y", "z"})
    parts.push_back("property float " + name + "\n");
  for (const std::string name : {"nx", "ny", "nz"})
    if (normals)
      parts.push_back("property double " + name + "\n");
  const std::string color_type = dice.of<std::string>({"uchar", "ushort", "float", "char"});
  for (const std::string name : {"red", "green", "blue"})
    if (colors)
      parts.push_back("property " + color_type + " " + name + "\n");
  if (lists)
    parts.push_back("property list uchar short ids\n");
  for (int v = 0; v < vertices; ++v) {
    std::string row = put(dice.value()) + put(dice.value()) + put(dice.value());
    for (int k = 0; k < 3 && normals; ++k)
      row += put(double(k == 2));
    for (int k = 0; k < 3 && colors; ++k)
      row += color_type == "ushort"  ? put(std::uint16_t(dice.below(65536)))
             : color_type == "float" ? put(dice.value())
             : color_type == "char"  ? put(std::int8_t(dice.below(128)))
                                     : put(std::uint8_t(dice.below(256)));
    const int items = dice.below(4);
    if (lists)
      row += put(std::uint8_t(items));
    for (int k = 0; k < items && lists; ++k)
      row += put(std::int16_t(k));
    data.push_back(row + put.line());
  }
  parts.push_back(concat("element ", strips ? "tristrips " : "face ", faces, "\n"));
  parts.push_back("property list uchar int vertex_indices\n");
  const bool texture = dice.chance();
  if (texture)
    parts.insert(parts.end(), {"property list uchar float texcoord\n", "property int texnumber\n"});
  for (int f = 0; f < faces; ++f) {
    const int corners = dice.between(3, 6);
    std::string row = put(std::uint8_t(corners));
    for (int k = 0; k < corners; ++k)
      row += put(std::int32_t(strips && k == 3 ? -1 : dice.below(std::size_t(vertices))));
    if (texture) {
      row += put(std::uint8_t(2 * corners));
      for (int k = 0; k < 2 * corners; ++k)
        row += put(dice.value());
      row += put(std::int32_t(dice.below(3)) - 1);
    }
    data.push_back(row + put.line());
  }
  parts.push_back("end_header\n");
  parts.insert(parts.end(), data.begin(), data.end());
  return {parts};
}

/// LZF without any repetition: runs of up to 32 bytes, each behind its length less one.
std::string literalLzf(const std::string& bytes)
{
  std::string packed;
  for (std::size_t at = 0; at < bytes.size(); at += 32) {
    const std::string run = bytes.substr(at, 32);
    packed += static_cast<char>(run.size() - 1) + run;
  }
  return packed;
}

GeneratedFile pcd(Dice& dice)
{
  const std::string storage = dice.of<std::string>({"ascii", "binary", "binary_compressed"});
  const Encoding put{storage != "ascii"};
  const int width = dice.between(1, 4), height = dice.between(1, 3), rows = width * height;
  std::vector<std::string> names{"x", "y", "z"};
  for (const std::string name : {"rgb", "normal_x", "intensity", "_", "label", "a"})
    if (dice.chance())
      names.push_back(name);
  std::string fields, sizes, types, counts, rows_first, columns_first;
  std::vector<std::string> cells(names.size() * std::size_t(rows));
  for (std::size_t c = 0; c < names.size(); ++c) {
    const int count = names[c] == "_" || names[c] == "a" ? dice.between(1, 3) : 1;
    const bool byte = names[c] == "_" || names[c] == "label";
    fields += " " + names[c], sizes += byte ? " 1" : " 4", types += byte ? " U" : " F", counts += concat(' ', count);
    for (int row = 0; row < rows; ++row)
      for (int k = 0; k < count; ++k)
        cells[std::size_t(row) * names.size() + c] += byte ? put(std::uint8_t(dice.below(256))) : put(dice.value());
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    rows_first += cells[i] + ((i + 1) % names.size() == 0 ? put.line() : "");
    columns_first += cells[i % std::size_t(rows) * names.size() + i / std::size_t(rows)];
  }
  Parts parts{"VERSION .7\n",
              "FIELDS" + fields + "\n",
              "SIZE" + sizes + "\n",
              "TYPE" + types + "\n",
              "COUNT" + counts + "\n",
              concat("WIDTH ", width, "\n"),
              concat("HEIGHT ", height, "\n"),
              "VIEWPOINT 0 0 1 1 0 0 0\n",
              concat("POINTS ", rows, "\n"),
              "DATA " + storage + "\n"};
  if (storage == "binary_compressed") {
    const std::string packed = literalLzf(columns_first);
    parts.insert(parts.end(), {raw(std::uint32_t(packed.size())), raw(std::uint32_t(columns_first.size())), packed});
  } else {
    parts.push_back(rows_first);
  }
  return {parts};
}

GeneratedFile vtk(Dice& dice)
{
  const Encoding put{dice.chance(), true};
  const int points = dice.between(3, 8), cells = dice.between(0, 4);
  Parts parts{"# vtk DataFile Version 3.0\n", "title\n", put.binary ? "BINARY\n" : "ASCII\n", "DATASET POLYDATA\n"};
  const auto values = [&](int count) {
    std::string text;
    for (int i = 0; i < count; ++i)
      text += put(dice.value());
    return text + "\n";
  };
  parts.push_back(concat("POINTS ", points, " float\n") + values(3 * points));
  std::string list;
  int size = 0;
  for (int c = 0; c < cells; ++c) {
    const int corners = dice.between(3, 5);
    list += put(std::int32_t(corners));
    for (int k = 0; k < corners; ++k)
      list += put(std::int32_t(dice.below(std::size_t(points))));
    size += corners + 1;
  }
  parts.push_back(concat(dice.of<std::string>({"POLYGONS ", "TRIANGLE_STRIPS ", "LINES "}), cells, ' ', size, "\n") +
                  list + "\n");
  parts.push_back(concat("POINT_DATA ", points, "\n"));
  parts.push_back("SCALARS s float 2\nLOOKUP_TABLE default\n" + values(2 * points));
  if (dice.chance())
    parts.push_back("NORMALS n float\n" + values(3 * points));
  if (dice.chance())
    parts.push_back(concat("FIELD FieldData 1\na 3 ", points, " float\n") + values(3 * points));
  return {parts};
}

GeneratedFile obj(Dice& dice)
{
  const int vertices = dice.between(3, 8), faces = dice.between(1, 5);
  Parts parts{dice.of<std::string>({"mtllib input.mtl\n", "mtllib .\\input.mtl input.mtl # both\n"})};
  for (int v = 0; v < vertices; ++v)
    parts.push_back(concat("v ", dice.value(), ' ', dice.value(), ' ', dice.value(), "\n"));
  for (int v = 0; v < vertices; ++v)
    parts.push_back(dice.chance() ? concat("vt ", dice.value(), ' ', dice.value(), "\n")
                                  : concat("vt ", dice.value(), "\n"));
  parts.push_back("vn 0 0 1\n");
  for (int f = 0; f < faces; ++f) {
    std::string line = "f";
    for (int k = dice.between(3, 6); k > 0; --k) {
      const int v = dice.between(1, vertices);
      line += concat(' ', v, '/', v, "/1");
    }
    parts.push_back(concat("usemtl m", dice.below(2), "\n"));
    parts.push_back(line + "\n");
  }
  parts.insert(parts.end(), {std::string(separator), "newmtl m0\n", "Kd 1 0 0\n", "newmtl m1\n", "Kd 0 0 1\n"});
  return {parts};
}

GeneratedFile glb(Dice& dice)
{
  const int vertices = 3 * dice.between(1, 3), nodes = dice.between(1, 4);
  std::string buffer;
  for (int i = 0; i < 3 * vertices; ++i)
    buffer += raw(dice.value());
  for (int i = 0; i < vertices; ++i)
    buffer += raw(std::uint16_t(i));
  const int positions = 12 * vertices, size = positions + 2 * vertices;
  Parts parts{R"({"asset":{"version":"2.0"})", R"(,"scene":0)", R"(,"scenes":[{"nodes":[0]}])", R"(,"nodes":[)"};
  for (int n = 0; n < nodes; ++n)
    parts.push_back(concat(n > 0 ? "," : "", R"({"mesh":0,"translation":[)", dice.value(), ",0,1]",
                           n + 1 < nodes ? concat(R"(,"children":[)", n + 1, "]}") : "}"));
  parts.push_back("]");
  parts.push_back(R"(,"meshes":[{"primitives":[)");
  parts.push_back(dice.chance() ? R"({"attributes":{"POSITION":0},"indices":1})" : R"({"attributes":{"POSITION":0}})");
  parts.push_back("]}]");
  parts.push_back(
      concat(R"(,"accessors":[{"bufferView":0,"componentType":5126,"count":)", vertices, R"(,"type":"VEC3"})"));
  parts.push_back(concat(R"(,{"bufferView":1,"componentType":5123,"count":)", vertices, R"(,"type":"SCALAR"}])"));
  parts.push_back(concat(R"(,"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":)", positions, "}"));
  parts.push_back(concat(R"(,{"buffer":0,"byteOffset":)", positions, R"(,"byteLength":)", 2 * vertices, "}]"));
  parts.push_back(concat(R"(,"buffers":[{"byteLength":)", size, "}]"));
  parts.push_back("}");
  parts.push_back(buffer);
  return {parts, GeneratedFile::Kind::glb};
}

GeneratedFile stl(Dice& dice)
{
  const int triangles = dice.between(1, 5);
  Parts parts{std::string(80, 'h'), raw(std::uint32_t(triangles))};
  for (int t = 0; t < triangles; ++t) {
    std::string row;
    for (int i = 0; i < 12; ++i)
      row += raw(dice.value());
    parts.push_back(row + std::string(2, '\0'));
  }
  parts[0][0] = '\xff'; // no text
  return {parts};
}

GeneratedFile xyz(Dice& dice)
{
  const std::vector<std::string> names{"x", "y", "\"z\"", "Intensity", "r [8 bit]", "G", "blue", "nx", "ny", "nz"};
  const std::string separator = dice.of<std::string>({" ", ",", ";", "\t", ", ", " | "});
  const bool decimal_comma = separator != "," && separator != ", " && dice.chance(), whole = dice.chance();
  const bool header = dice.chance(); // without it, what more columns mean may be refused
  const int columns = header ? dice.of<int>({3, 4, 6, 7, 9, 10}) : dice.of<int>({3, 4});
  const auto row = [&](const auto& cell) {
    std::string line;
    for (int c = 0; c < columns; ++c)
      line += (c > 0 ? separator : "") + cell(c);
    return line + dice.of<std::string>({"\n", "\r\n", " # comment\n", separator + "\n"});
  };
  Parts parts;
  if (header)
    parts.push_back(dice.of<std::string>({"", "# ", "//"}) + row([&](int c) { return names[std::size_t(c)]; }));
  for (int r = dice.between(1, 6); r > 0; --r)
    parts.push_back(row([&](int c) {
      std::string number = whole && c > 2 ? concat(dice.below(256)) : concat(dice.value());
      if (decimal_comma)
        std::replace(number.begin(), number.end(), '.', ',');
      return number;
    }));
  return {parts};
}

GeneratedFile poses(Dice& dice)
{
  Parts parts;
  for (int p = dice.between(1, 4); p > 0; --p)
    parts.push_back(dice.chance() ? "none\n" : concat("1 0 0 ", dice.value(), " 0 1 0 0 0 0 1 0 0 0 0 1\n"));
  return {parts};
}

GeneratedFile colmapText(Dice& dice)
{
  Parts parts{"# cameras\n", "1 PINHOLE 64 48 60 60 32 24\n", "2 SIMPLE_RADIAL 64 48 60 32 24 0.1\n",
              std::string(separator), "# images\n"};
  for (int i = dice.between(1, 4); i > 0; --i)
    parts.insert(parts.end(), {concat(i, " 1 0 0 0 ", dice.value(), " 0 1 ", dice.between(1, 2), " a.jpg\n"), "\n"});
  return {parts};
}

GeneratedFile colmapBinary(Dice& dice)
{
  Parts parts{raw(std::uint64_t(1)),  raw(std::uint32_t(1)),  raw(std::int32_t(1)),
              raw(std::uint64_t(64)), raw(std::uint64_t(48)), raw(60.) + raw(60.) + raw(32.) + raw(24.),
              std::string(separator)};
  const int images = dice.between(1, 3);
  parts.push_back(raw(std::uint64_t(images)));
  for (int i = 0; i < images; ++i)
    parts.insert(parts.end(), {raw(std::uint32_t(i)), raw(1.) + raw(0.) + raw(0.) + raw(0.),
                               raw(double(dice.value())) + raw(0.) + raw(1.), raw(std::uint32_t(1)),
                               std::string("a.jpg\0", 6), raw(std::uint64_t(0))});
  return {parts};
}
} // namespace

GeneratedFile generated(const std::string& target, std::uint32_t seed)
{
  static const std::map<std::string, std::function<GeneratedFile(Dice&)>> all = {{"ply", ply},
                                                                                 {"pcd", pcd},
                                                                                 {"vtk", vtk},
                                                                                 {"obj", obj},
                                                                                 {"glb", glb},
                                                                                 {"stl", stl},
                                                                                 {"xyz", xyz},
                                                                                 {"ptx", ptx},
                                                                                 {"pts", pts},
                                                                                 {"las", las},
                                                                                 {"e57", e57},
                                                                                 {"points3d_text", points3dText},
                                                                                 {"points3d_binary", points3dBinary},
                                                                                 {"cameras", cameras},
                                                                                 {"poses", poses},
                                                                                 {"layout", layout},
                                                                                 {"colmap_text", colmapText},
                                                                                 {"colmap_binary", colmapBinary}};
  const auto found = all.find(target);
  Dice dice(seed);
  return found == all.end() ? GeneratedFile{} : found->second(dice);
}
} // namespace fresco::fuzz
