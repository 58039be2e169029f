// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/mesh_formats.h"
#include "io/mesh/vtk_arrays.h"
#include "io/points/text_numbers.h"
#include <algorithm>
#include <fresco/core/polygon_fans.h>
namespace fresco::io {
namespace {
Scalar vtkType(std::string_view word)
{
  static constexpr std::pair<const char*, Scalar> others[] = {{"signed_char", Scalar::int8},
                                                              {"long", Scalar::int64},
                                                              {"unsigned_long", Scalar::uint64},
                                                              {"vtkidtype", Scalar::int32}};
  const std::string name = lowerCase(word);
  for (const VtkType& known : vtk_types)
    if (name == known.legacy)
      return known.type;
  for (const auto& [known, type] : others)
    if (name == known)
      return type;
  throw std::runtime_error(concat("VTK: values of type '", word.substr(0, 40), "' are not supported"));
}

/// Names are written with %XX for blanks and special characters.
std::string decodeName(std::string_view word)
{
  std::string name;
  for (std::size_t i = 0; i < word.size(); ++i) {
    unsigned code = 0;
    if (word[i] == '%' && i + 2 < word.size() &&
        std::from_chars(word.data() + i + 1, word.data() + i + 3, code, 16).ptr == word.data() + i + 3) {
      name += static_cast<char>(code);
      i += 2;
    } else {
      name += word[i];
    }
  }
  return name;
}

class VtkParser {
public:
  explicit VtkParser(std::string_view text) : scanner_(text) {}

  MeshTable parse()
  {
    parseHeader();
    for (std::string_view word = nextKeyword(); !word.empty(); word = nextKeyword())
      parseSection(lowerCase(word));
    expect(!points_.bytes.empty(), "no points");
    MeshTable mesh{tableOfArrays(points_, arrays_), {}};
    mesh.faces = collector_.faces(mesh.vertices.rows);
    return mesh;
  }

private:
  void parseHeader()
  {
    expect(lowerCase(scanner_.restOfLine()).rfind("# vtk datafile version", 0) == 0, "not a legacy VTK file");
    scanner_.restOfLine(); // title
    const std::string storage = lowerCase(scanner_.restOfLine());
    expect(storage == "ascii" || storage == "binary", "VTK: neither ASCII nor BINARY");
    binary_ = storage == "binary";
    expect(lowerCase(nextKeyword()) == "dataset" && lowerCase(scanner_.wordAcrossLines()) == "polydata",
           "VTK: the dataset is not POLYDATA");
  }

  /// Next word on whatever line, empty at the end of the file.
  std::string_view nextKeyword()
  {
    while (scanner_.atLineEnd()) {
      if (scanner_.done())
        return {};
      scanner_.nextLine();
    }
    return scanner_.word();
  }

  std::size_t nextCount()
  {
    const auto count = parseNumber<std::int64_t>(scanner_.wordAcrossLines());
    expect(count >= 0, "VTK: negative count ", count);
    return count;
  }

  void parseSection(const std::string& keyword)
  {
    if (keyword == "points") {
      expect(points_.bytes.empty(), "VTK: two sections POINTS");
      const std::size_t count = nextCount();
      const Scalar type = vtkType(scanner_.wordAcrossLines());
      points_ = readArray("points", type, 3, count);
    } else if (keyword == "vertices" || keyword == "lines") {
      readCells([](const std::int64_t*, std::size_t) {});
    } else if (keyword == "polygons") {
      readCells([&](const std::int64_t* corners, std::size_t count) { collector_.addPolygon(corners, count); });
    } else if (keyword == "triangle_strips") {
      readCells([&](const std::int64_t* corners, std::size_t count) { collector_.addStrip(corners, count); });
    } else if (keyword == "point_data" || keyword == "cell_data") {
      tuples_ = nextCount();
      is_point_data_ = keyword == "point_data";
      expect(!is_point_data_ || tuples_ == points_.tuples(), "VTK: POINT_DATA has ", tuples_,
             " tuples, which is not the number of points");
    } else if (keyword == "metadata") {
      scanner_.nextLine();
      while (!scanner_.restOfLine().empty()) {
      }
    } else {
      parseAttribute(keyword);
    }
  }

  void parseAttribute(const std::string& keyword)
  {
    if (keyword == "field") {
      parseField();
      return;
    }
    const std::string name = decodeName(scanner_.wordAcrossLines());
    if (keyword == "lookup_table") {
      readArray(name, binary_ ? Scalar::uint8 : Scalar::float32, 4, nextCount());
      return;
    }
    if (keyword == "color_scalars") {
      const std::size_t components = nextCount();
      keep(readArray("colors", binary_ ? Scalar::uint8 : Scalar::float32, components, tuples_));
      return;
    }
    std::size_t components = keyword == "normals" || keyword == "vectors" ? 3 : keyword == "tensors" ? 9 : 1;
    if (keyword == "texture_coordinates")
      components = nextCount();
    else if (keyword != "scalars" && keyword != "normals" && keyword != "vectors" && keyword != "tensors")
      throw std::runtime_error(concat("VTK: unknown section '", keyword.substr(0, 40), "'"));
    const Scalar type = vtkType(scanner_.wordAcrossLines());
    if (keyword == "scalars")
      components = parseScalarsRest();
    keep(readArray(keyword == "normals" ? "normals" : name, type, components, tuples_));
  }

  /// Number of components, and the line with the lookup table. @return components
  std::size_t parseScalarsRest()
  {
    const std::string_view word = scanner_.word();
    const std::size_t components = word.empty() ? 1 : parseNumber<std::uint32_t>(word);
    expect(lowerCase(scanner_.wordAcrossLines()) == "lookup_table" && !scanner_.word().empty(),
           "VTK: SCALARS without LOOKUP_TABLE");
    return components;
  }

  void parseField()
  {
    scanner_.wordAcrossLines();
    const std::size_t arrays = nextCount();
    for (std::size_t i = 0; i < arrays; ++i) {
      std::string_view word = scanner_.wordAcrossLines();
      if (lowerCase(word) == "metadata") {
        parseSection("metadata");
        word = scanner_.wordAcrossLines();
      }
      const std::size_t components = nextCount(), tuples = nextCount();
      const Scalar type = vtkType(scanner_.wordAcrossLines());
      keep(readArray(decodeName(word), type, components, tuples));
    }
  }

  VtkArray readArray(const std::string& name, Scalar type, std::size_t components, std::size_t tuples)
  {
    const std::size_t least = binary_ ? scalarSize(type) : 2; // bytes per value; the last word needs no separator
    expect(components != 0 && components <= 1000 && tuples <= (scanner_.remaining() + 1) / (least * components),
           "truncated: ", tuples, " tuples of '", name.substr(0, 40), "' do not fit");
    VtkArray array{name, type, components, {}};
    const std::size_t count = tuples * components;
    if (binary_)
      scanner_.nextLine();
    visitScalar(type, [&](auto zero) {
      using T = decltype(zero);
      array.bytes.resize(count * sizeof(T));
      if (binary_) {
        const std::string_view raw = scanner_.bytes(count * sizeof(T));
        std::copy(raw.begin(), raw.end(), array.bytes.begin());
        for (std::size_t i = 0; i < array.bytes.size() && sizeof(T) > 1; i += sizeof(T)) // stored big-endian
          std::reverse(array.bytes.data() + i, array.bytes.data() + i + sizeof(T));
        return;
      }
      for (std::size_t i = 0; i < count; ++i) {
        const T value = parseNumber<T>(scanner_.wordAcrossLines());
        std::memcpy(array.bytes.data() + i * sizeof(T), &value, sizeof(T));
      }
    });
    return array;
  }

  /// Until version 4 one list "count corner corner ...", since version 5 offsets and corners apart.
  template <typename Add>
  void readCells(const Add& add)
  {
    const std::size_t cells = nextCount(), size = nextCount();
    TextScanner ahead = scanner_;
    while (ahead.atLineEnd() && !ahead.done())
      ahead.nextLine();
    if (lowerCase(ahead.word()) == "offsets") {
      readOffsetCells(cells, size, add);
      return;
    }
    const std::vector<std::int64_t> list = readArray("cells", Scalar::int32, 1, size).integers();
    std::size_t at = 0;
    for (std::size_t i = 0; i < cells; ++i) {
      expect(at < list.size() && list[at] >= 0 && static_cast<std::size_t>(list[at]) < list.size() - at,
             "VTK: a cell does not fit into its list");
      add(list.data() + at + 1, list[at]);
      at += static_cast<std::size_t>(list[at]) + 1;
    }
  }

  template <typename Add>
  void readOffsetCells(std::size_t count, std::size_t size, const Add& add)
  {
    scanner_.wordAcrossLines();
    const Scalar offset_type = vtkType(scanner_.wordAcrossLines());
    const std::vector<std::int64_t> offsets = readArray("offsets", offset_type, 1, count).integers();
    expect(lowerCase(scanner_.wordAcrossLines()) == "connectivity", "VTK: OFFSETS without CONNECTIVITY");
    const Scalar type = vtkType(scanner_.wordAcrossLines());
    const std::vector<std::int64_t> corners = readArray("connectivity", type, 1, size).integers();
    for (std::size_t i = 1; i < offsets.size(); ++i) {
      const std::int64_t begin = offsets[i - 1], end = offsets[i];
      expect(begin >= 0 && end >= begin && end <= static_cast<std::int64_t>(corners.size()),
             "VTK: a cell does not fit into its list");
      add(corners.data() + begin, end - begin);
    }
  }

  void keep(VtkArray array)
  {
    if (is_point_data_ && array.tuples() == points_.tuples())
      arrays_.push_back(std::move(array));
  }

  TextScanner scanner_;
  bool binary_ = false, is_point_data_ = false;
  std::size_t tuples_ = 0;
  VtkArray points_{"points", Scalar::float32, 3, {}};
  std::vector<VtkArray> arrays_;
  FaceCollector collector_;
};
} // namespace

MeshTable parseVtk(std::string_view content) { return VtkParser(content).parse(); }
} // namespace fresco::io
