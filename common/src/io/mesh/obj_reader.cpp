// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/remarks.h"
#include "io/mesh/obj.h"
#include "io/points/text_numbers.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/polygon_fans.h>
#include <limits>
#include <unordered_map>
namespace fresco::io {
namespace {
/// Next word of a statement, empty at its end; a backslash at the end of a line continues it, '#' begins a comment.
std::string_view nextWord(TextScanner& scanner)
{
  std::string_view word = scanner.word();
  while (word == "\\" && scanner.atLineEnd() && !scanner.done()) {
    scanner.nextLine();
    word = scanner.word();
  }
  return word.substr(0, 1) == "#" ? std::string_view() : word;
}

struct Corner {
  int vertex = -1, texcoord = -1, normal = -1;
};

class ObjParser {
public:
  explicit ObjParser(std::string_view text) : scanner_(text) {}

  ObjContent parse()
  {
    try {
      for (; !scanner_.done(); scanner_.nextLine())
        parseStatement();
    } catch (const std::exception& error) {
      throw std::runtime_error(concat("line ", scanner_.line(), ": ", error.what()));
    }
    expect(!content_.vertices.empty(), "no vertices");
    if (has_lines_)
      remark("lines, points and faces of fewer than 3 corners are left out");
    finishColors();
    forgetMissing();
    checkIndices();
    return std::move(content_);
  }

private:
  void parseStatement()
  {
    const std::string_view keyword = nextWord(scanner_);
    if (keyword == "v")
      parseVertex();
    else if (keyword == "vn")
      append(content_.normals, 3);
    else if (keyword == "vt")
      parseTexcoord();
    else if (keyword == "f" || keyword == "fo")
      parseFace();
    else if (keyword == "usemtl")
      useMaterial(std::string(restOfStatement()));
    else if (keyword == "mtllib")
      parseLibraries();
    else if (keyword == "l" || keyword == "p")
      has_lines_ = true;
  }

  template <typename T>
  void append(std::vector<T>& values, int count)
  {
    for (int i = 0; i < count; ++i)
      values.push_back(parseNumber<T>(nextWord(scanner_)));
  }

  /// u [v [w]]
  void parseTexcoord()
  {
    append(content_.texcoords, 1);
    const std::string_view v = nextWord(scanner_);
    content_.texcoords.push_back(v.empty() ? 0.f : parseNumber<float>(v));
  }

  void parseVertex()
  {
    append(content_.vertices, 3);
    double extra[4];
    std::size_t count = 0;
    for (std::string_view word = nextWord(scanner_); !word.empty() && count < 4; word = nextWord(scanner_))
      extra[count++] = parseNumber<double>(word);
    if (count < 3)
      return;
    const auto row = content_.vertices.size() / 3 - 1;
    content_.colors.resize(3 * row, no_color);
    content_.colors.insert(content_.colors.end(), extra + count - 3, extra + count);
  }

  Corner parseCorner(std::string_view word) const
  {
    Corner corner;
    int* const slots[3] = {&corner.vertex, &corner.texcoord, &corner.normal};
    const std::size_t counts[3] = {content_.vertices.size() / 3, content_.texcoords.size() / 2,
                                   content_.normals.size() / 3};
    for (int k = 0; k < 3 && !word.empty(); ++k) {
      const std::size_t slash = std::min(word.find('/'), word.size());
      if (slash > 0)
        *slots[k] = absolute(parseNumber<std::int64_t>(word.substr(0, slash)), counts[k]);
      word.remove_prefix(std::min(slash + 1, word.size()));
    }
    return corner;
  }

  /// From 1, or negative counted from the end so far. The upper end is checked when all of the file is known.
  static int absolute(std::int64_t index, std::size_t count)
  {
    const std::int64_t from_zero = index > 0 ? index - 1 : static_cast<std::int64_t>(count) + index;
    expect(index != 0 && from_zero >= 0 && from_zero <= std::numeric_limits<int>::max(), "index ", index,
           " is out of range");
    return from_zero;
  }

  void parseFace()
  {
    corners_.clear();
    for (std::string_view word = nextWord(scanner_); !word.empty(); word = nextWord(scanner_))
      corners_.push_back(parseCorner(word));
    has_lines_ = has_lines_ || corners_.size() < 3;
    triangulate(corners_.size(), [&](std::size_t i, std::size_t k, std::size_t l) {
      const Corner &a = corners_[i], &b = corners_[k], &c = corners_[l];
      content_.triangles.push_back({{a.vertex, b.vertex, c.vertex},
                                    {a.texcoord, b.texcoord, c.texcoord},
                                    {a.normal, b.normal, c.normal},
                                    material_});
    });
  }

  void useMaterial(const std::string& name)
  {
    const auto [known, is_new] = materials_.emplace(name, content_.materials.size());
    material_ = known->second;
    if (is_new)
      content_.materials.push_back(name);
  }

  void parseLibraries()
  {
    const std::string_view rest = restOfStatement();
    if (!rest.empty())
      content_.libraries.emplace_back(rest);
  }

  /// Names may hold blanks.
  std::string_view restOfStatement()
  {
    const std::string_view first = nextWord(scanner_);
    std::string_view last = first;
    for (std::string_view word = nextWord(scanner_); !word.empty(); word = nextWord(scanner_))
      last = word;
    return {first.data(), static_cast<std::size_t>(last.data() + last.size() - first.data())};
  }

  /// Vertices without a colour are white.
  void finishColors()
  {
    std::vector<double>& colors = content_.colors;
    if (colors.empty())
      return;
    colors.resize(content_.vertices.size(), no_color);
    double largest = 0;
    for (const double value : colors)
      largest = std::max(largest, std::isfinite(value) ? value : 0);
    for (double& value : colors)
      value = std::isnan(value) ? fullColor(Scalar::float64, largest) : value;
  }

  /// Faces that name texture coordinates or normals of a file that has none.
  void forgetMissing()
  {
    bool any = false;
    const auto forget = [&](std::array<int, 3>& indices, bool missing) {
      any = any || (missing && indices != std::array{-1, -1, -1});
      if (missing)
        indices.fill(-1);
    };
    for (ObjTriangle& triangle : content_.triangles) {
      forget(triangle.texcoords, content_.texcoords.empty());
      forget(triangle.normals, content_.normals.empty());
    }
    if (any)
      remark("faces name texture coordinates or normals, of which there are none");
  }

  void checkIndices() const
  {
    const Index counts[3] = {content_.vertexCount(), static_cast<Index>(content_.texcoords.size() / 2),
                             static_cast<Index>(content_.normals.size() / 3)};
    for (const ObjTriangle& triangle : content_.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const int indices[3] = {triangle.vertices[k], triangle.texcoords[k], triangle.normals[k]};
        for (int kind = 0; kind < 3; ++kind)
          expect(indices[kind] < counts[kind] && (kind != 0 || indices[kind] >= 0), "a face names element ",
                 Index{indices[kind]} + 1, ", there are ", counts[kind]);
      }
  }

  static constexpr double no_color = std::numeric_limits<double>::quiet_NaN();
  TextScanner scanner_;
  ObjContent content_;
  std::vector<Corner> corners_;
  std::unordered_map<std::string, int> materials_; ///< their numbers
  int material_ = -1;
  bool has_lines_ = false;
};

/// 3 values per vertex; empty if the file's normals belong to no vertex.
std::vector<double> normalsPerVertex(const ObjContent& content)
{
  const auto count = static_cast<std::size_t>(content.vertexCount());
  std::vector<double> sums(3 * count, 0.0);
  std::vector<int> sole(count, -1); // the one normal of a vertex so far, -2: several
  bool any = false;
  const auto add = [&](std::size_t vertex, int normal) {
    for (std::size_t k = 0; k < 3; ++k)
      sums[3 * vertex + k] += content.normals[3 * static_cast<std::size_t>(normal) + k];
  };
  for (const ObjTriangle& triangle : content.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto vertex = static_cast<std::size_t>(triangle.vertices[k]);
      const int normal = triangle.normals[k];
      if (normal < 0 || sole[vertex] == normal)
        continue;
      any = true;
      add(vertex, normal);
      sole[vertex] = sole[vertex] == -1 ? normal : -2;
    }
  if (!any)
    return content.normals.size() == sums.size() ? content.normals : std::vector<double>();
  for (std::size_t vertex = 0; vertex < count; ++vertex)
    if (sole[vertex] == -2)
      Eigen::Map<Eigen::Vector3d>(sums.data() + 3 * vertex).normalize();
  return sums;
}
} // namespace

ObjContent parseObj(std::string_view content) { return ObjParser(content).parse(); }

MeshTable objMesh(const ObjContent& content)
{
  const std::vector<double> normals = normalsPerVertex(content);
  std::vector<std::string> names;
  std::vector<const double*> values; ///< of vertices, three each
  const auto add = [&](NameTriple triple, const std::vector<double>& of_vertices) {
    if (of_vertices.empty())
      return;
    names.insert(names.end(), std::begin(triple), std::end(triple));
    values.push_back(of_vertices.data());
  };
  add(xyz_names, content.vertices);
  add(color_names, content.colors);
  add(normal_names, normals);
  std::vector<double> rows;
  for (Index i = 0; values.size() > 1 && i < content.vertexCount(); ++i)
    for (const double* const of_vertices : values)
      rows.insert(rows.end(), of_vertices + 3 * i, of_vertices + 3 * (i + 1));
  MeshTable mesh{tableOfRows(names, values.size() > 1 ? rows : content.vertices), {}};
  mesh.faces.resize(3, content.triangles.size());
  for (Index f = 0; f < mesh.faces.cols(); ++f)
    mesh.faces.col(f) = Eigen::Vector3i::Map(content.triangles[f].vertices.data());
  return mesh;
}

MeshTable parseObjMesh(std::string_view content) { return objMesh(parseObj(content)); }

std::vector<std::pair<std::string, std::string>> parseMtl(std::string_view content)
{
  std::vector<std::pair<std::string, std::string>> materials;
  TextScanner scanner(content);
  while (!scanner.done()) {
    const std::string_view keyword = scanner.word();
    std::string_view rest = scanner.restOfLine();
    rest = rest.substr(0, std::min(rest.find(" #"), rest.size()));
    rest = rest.substr(0, rest.find_last_not_of(" \t") + 1);
    if (keyword == "newmtl")
      materials.emplace_back(rest, "");
    else if (keyword == "map_Kd" && !materials.empty())
      materials.back().second = rest;
  }
  return materials;
}
} // namespace fresco::io
