// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/vtk_polydata.h"
#include "io/mesh/vtk_arrays.h"
#include <algorithm>
#include <fresco/core/polygon_fans.h>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <mutex>
#include <new>
#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkOutputWindow.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSTLReader.h>
#include <vtkSTLWriter.h>
#include <vtkSmartPointer.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtksys/SystemTools.hxx>
namespace fresco::io {
namespace {
/// Takes what VTK says instead of the terminal.
class Listener : public vtkOutputWindow {
public:
  static Listener* New()
  {
    auto* const made = new Listener;
    made->InitializeObjectBase();
    return made;
  }
  void DisplayText(const char* text) override
  {
    if (first_.empty() && GetCurrentMessageType() == MESSAGE_TYPE_ERROR)
      first_ = text;
  }
  /// The first error in one line without the place in VTK's source, "" if there was none.
  std::string reason() const
  {
    const std::size_t address = first_.find("): "), begin = address == std::string::npos ? 0 : address + 3;
    return first_.substr(begin, first_.find('\n', begin) - begin);
  }

private:
  std::string first_;
};

/// While it lives VTK talks to a Listener, and its log not to the terminal. VTK knows one of each for the whole program,
/// so that one file is read at a time. It cannot be asked what its log showed before: afterwards that is VTK's default.
class Conversation {
public:
  Conversation() : lock_(mutex()), previous_(vtkOutputWindow::GetInstance())
  {
    vtkOutputWindow::SetInstance(heard_);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  }
  ~Conversation()
  {
    vtkOutputWindow::SetInstance(previous_);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_INFO);
  }
  Conversation(const Conversation&) = delete;
  Conversation& operator=(const Conversation&) = delete;

  /// @throws std::runtime_error "PATH: reason" if VTK said that something is wrong
  void check(const std::string& path, vtkAlgorithm& algorithm, unsigned long code) const
  {
    const std::string reason = heard_->reason();
    if (!reason.empty() || code != 0)
      throw std::runtime_error(path + ": " + (reason.empty() ? algorithm.GetClassName() : reason));
  }

private:
  static std::mutex& mutex()
  {
    static std::mutex one;
    return one;
  }
  std::lock_guard<std::mutex> lock_;
  vtkSmartPointer<vtkOutputWindow> previous_;
  vtkNew<Listener> heard_;
};

constexpr std::pair<int, Scalar> types[] = {
    {VTK_CHAR, Scalar::int8},
    {VTK_SIGNED_CHAR, Scalar::int8},
    {VTK_UNSIGNED_CHAR, Scalar::uint8},
    {VTK_SHORT, Scalar::int16},
    {VTK_UNSIGNED_SHORT, Scalar::uint16},
    {VTK_INT, Scalar::int32},
    {VTK_UNSIGNED_INT, Scalar::uint32},
    {VTK_LONG, Scalar::int64},
    {VTK_LONG_LONG, Scalar::int64},
    {VTK_ID_TYPE, Scalar::int64},
    {VTK_UNSIGNED_LONG, Scalar::uint64},
    {VTK_UNSIGNED_LONG_LONG, Scalar::uint64},
    {VTK_FLOAT, Scalar::float32},
    {VTK_DOUBLE, Scalar::float64},
};

/// Nothing for bits, which have no place in a table.
std::optional<VtkArray> copyArray(vtkDataArray& source, const std::string& name)
{
  for (const auto& [theirs, ours] : types)
    if (source.GetDataType() == theirs) {
      VtkArray array{name, ours, std::size_t(source.GetNumberOfComponents()), {}};
      const auto* begin = static_cast<const std::uint8_t*>(source.GetVoidPointer(0));
      array.bytes.assign(begin, begin + source.GetNumberOfValues() * scalarSize(ours));
      return array;
    }
  return {};
}

/// add(corners, count) of each cell.
template <typename Add>
void forEachCell(vtkCellArray& cells, const Add& add)
{
  const auto integers = [](vtkDataArray& array) {
    const std::optional<VtkArray> copied = copyArray(array, "");
    if (!copied || copied->components != 1)
      throw std::runtime_error("VTK: cell indices are no integers");
    return copied->integers();
  };
  const std::vector<std::int64_t> offsets = integers(*cells.GetOffsetsArray());
  const std::vector<std::int64_t> corners = integers(*cells.GetConnectivityArray());
  const std::int64_t size = corners.size();
  for (std::size_t i = 1; i < offsets.size(); ++i) {
    const std::int64_t begin = offsets[i - 1], end = offsets[i];
    if (begin < 0 || end < begin || end > size)
      throw std::runtime_error("VTK: a cell does not fit into its list");
    add(corners.data() + begin, end - begin);
  }
}

VtkContent contentOf(vtkPolyData& data)
{
  const vtkIdType count = data.GetNumberOfPoints();
  if (count == 0)
    throw std::runtime_error("no points");
  vtkPointData& attributes = *data.GetPointData();
  std::vector<VtkArray> arrays;
  for (int i = 0; i < attributes.GetNumberOfArrays(); ++i) {
    vtkDataArray* const array = attributes.GetArray(i);
    if (!array || array->GetNumberOfTuples() != count)
      continue;
    const std::string name = array->GetName() ? array->GetName() : "";
    if (std::optional<VtkArray> copied = copyArray(*array, array == attributes.GetNormals() ? "normals" : name))
      arrays.push_back(std::move(*copied));
  }
  FaceCollector collector;
  forEachCell(*data.GetPolys(), [&](const std::int64_t* c, std::size_t size) { collector.addPolygon(c, size); });
  forEachCell(*data.GetStrips(), [&](const std::int64_t* c, std::size_t size) { collector.addStrip(c, size); });
  return {tableOfArrays(*copyArray(*data.GetPoints()->GetData(), "points"), arrays), collector.faces(count)};
}

template <typename Reader>
VtkContent readByVtk(const std::string& path)
try {
  const Conversation conversation;
  const vtkNew<Reader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  conversation.check(path, *reader, reader->GetErrorCode());
  try {
    return contentOf(*reader->GetOutput());
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
} catch (const std::bad_alloc&) {
  throw std::runtime_error(path + ": not enough memory");
}

/// Columns of equal type as one array.
vtkSmartPointer<vtkDataArray> arrayOf(const PointTable& table, const std::vector<Column>& columns,
                                      const std::string& name)
{
  std::size_t components = 0;
  for (const Column& column : columns)
    components += column.count;
  const auto type =
      std::find_if(std::begin(types), std::end(types), [&](auto& t) { return t.second == columns[0].type; });
  const auto array = vtk::TakeSmartPointer(vtkDataArray::CreateDataArray(type->first));
  array->SetName(name.c_str());
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(table.rows);
  auto* at = static_cast<std::uint8_t*>(array->GetVoidPointer(0));
  for (Index row = 0; row < table.rows; ++row)
    for (const Column& column : columns)
      at = std::copy_n(table.cell(row, column), column.bytes(), at);
  return array;
}

vtkSmartPointer<vtkPolyData> polyDataOf(const std::string& path, PointTable table, const Faces& faces)
{
  unpackColors(table);
  const auto xyz = findTriple(table, xyz_names);
  require(xyz.has_value(), path, ": no coordinates x y z");
  auto data = vtkSmartPointer<vtkPolyData>::New();
  const vtkNew<vtkPoints> points;
  points->SetData(arrayOf(table, {xyz->begin(), xyz->end()}, "Points"));
  data->SetPoints(points);
  const vtkNew<vtkCellArray> polygons;
  polygons->AllocateExact(faces.cols(), faces.size());
  for (Index f = 0; f < faces.cols(); ++f)
    polygons->InsertNextCell({faces(0, f), faces(1, f), faces(2, f)});
  data->SetPolys(polygons);
  std::vector<std::string> used(std::begin(xyz_names), std::end(xyz_names));
  if (const auto normals = findTriple(table, normal_names)) {
    data->GetPointData()->SetNormals(arrayOf(table, {normals->begin(), normals->end()}, "Normals"));
    used.insert(used.end(), std::begin(normal_names), std::end(normal_names));
  }
  if (const auto colors = findTriple(table, color_names)) {
    data->GetPointData()->SetScalars(arrayOf(table, {colors->begin(), colors->end()}, "rgb"));
    used.insert(used.end(), std::begin(color_names), std::end(color_names));
  }
  for (const Column& column : table.columns)
    if (std::find(used.begin(), used.end(), column.name) == used.end())
      data->GetPointData()->AddArray(arrayOf(table, {column}, column.name));
  return data;
}

template <typename Writer>
void writeByVtk(const std::string& path, vtkPolyData& data, Writer& writer)
{
  OutputFile file(path);
  const Conversation conversation;
  writer.SetFileName(file.temporaryPath().c_str());
  writer.SetInputData(&data);
  const bool written = writer.Write() != 0;
  conversation.check(path, writer, written ? writer.GetErrorCode() : 1);
  file.commit();
}
} // namespace

VtkContent readStl(const std::string& path)
{
  const std::string content = readFile(path);
  constexpr std::size_t header = 84, triangle = 50; // bytes in a binary file; the header ends with the count
  // The question that VTK's reader asks: what it takes for binary it gives the memory that the count asks for.
  const bool is_text = vtksys::SystemTools::DetectFileType(path.c_str()) == vtksys::SystemTools::FileTypeText;
  if (!is_text && (content.size() < header ||
                   (content.size() - header) / triangle < loadScalar<std::uint32_t>(content.data() + header - 4)))
    throw std::runtime_error(path + ": truncated: the triangles do not fit into the file");
  return readByVtk<vtkSTLReader>(path);
}

void writeVtp(const std::string& path, const PointTable& vertices, const Faces& faces)
{
  const vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetCompressorTypeToNone();
  writer->SetHeaderTypeToUInt64();
  writeByVtk(path, *polyDataOf(path, vertices, faces), *writer);
}

void writeStl(const std::string& path, const PointTable& vertices, const Faces& faces)
{
  const vtkNew<vtkSTLWriter> writer;
  writer->SetFileTypeToBinary();
  writeByVtk(path, *polyDataOf(path, vertices, faces), *writer);
}
} // namespace fresco::io
