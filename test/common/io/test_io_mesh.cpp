// SPDX-License-Identifier: BSD-3-Clause
#include "common/io/test_io_data.h"
#include <algorithm>
#include <cstring>
#include <fresco/core/require.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_io.h>
#include <vtkCellArray.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataReader.h>
#include <vtkPolyDataWriter.h>
#include <vtkSmartPointer.h>
#include <vtkXMLPolyDataReader.h>
namespace {
using namespace fresco;
using test::fullMesh;
using test::sameValues;

void expectSame(const TriangleMesh& a, const TriangleMesh& b, const std::string& what)
{
  EXPECT_TRUE(sameValues(a.vertices, b.vertices)) << what;
  EXPECT_TRUE(sameValues(a.normals, b.normals)) << what;
  EXPECT_TRUE(a.faces.cols() == b.faces.cols() && a.faces == b.faces) << what;
  EXPECT_TRUE(a.colors.cols() == b.colors.cols() && a.colors == b.colors) << what;
  EXPECT_EQ(a.origin, b.origin) << what;
  ASSERT_EQ(a.fields.size(), b.fields.size()) << what;
  for (const auto& [name, values] : a.fields)
    EXPECT_TRUE(b.fields.count(name) && sameValues(values, b.fields.at(name))) << what << ' ' << name;
}

template <typename T>
void put(std::string& bytes, T value, bool swap)
{
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (swap)
    std::reverse(raw, raw + sizeof(T));
  bytes.append(raw, sizeof(T));
}

TEST(MeshIo, EveryAttributeSurvives)
{
  const std::string folder = test::scratchFolder();
  for (const char* type : {"ply", "vtk", "obj"}) {
    TriangleMesh mesh = fullMesh(12);
    if (type == std::string("obj"))
      mesh.fields.clear(); // the format has no place for them
    writeMesh(folder + "/mesh." + type, mesh);
    expectSame(readMesh(folder + "/mesh." + type), mesh, type);
    TriangleMesh plain;
    plain.vertices = mesh.vertices;
    plain.faces = mesh.faces;
    writeMesh(folder + "/plain." + type, plain);
    expectSame(readMesh(folder + "/plain." + type), plain, type);
    plain.faces.resize(3, 0);
    writeMesh(folder + "/points." + type, plain);
    expectSame(readMesh(folder + "/points." + type), plain, type);
  }
}

TEST(MeshIo, LargeCoordinatesKeepTheirAccuracy)
{
  const std::string folder = test::scratchFolder();
  TriangleMesh mesh = fullMesh(12);
  mesh.origin = Eigen::Vector3d(691245.125, 5335001.5, 512.25);
  for (const char* type : {"ply", "vtk", "obj"}) {
    const std::string path = folder + "/utm." + type;
    writeMesh(path, mesh);
    const TriangleMesh back = readMesh(path);
    EXPECT_LT(test::worldDistance(mesh, mesh.vertices, back, back.vertices), 2e-6) << type; // float over 12 m
    EXPECT_EQ(back.faces, mesh.faces) << type;
  }
}

/// A square of four vertices as one polygon, a triangle strip and elements that nobody knows.
std::string oddPly(const std::string& format)
{
  const bool ascii = format == "ascii", swap = format == "binary_big_endian";
  std::string text = "ply\nformat " + format + " 1.0\ncomment odd\nobj_info odd\nelement odd 2\n" +
                     "property list uchar double stuff\nproperty short tag\nelement vertex 4\nproperty float x\n" +
                     "property double y\nproperty float z\nproperty list ushort short ring\nproperty uchar quality\n" +
                     "property float nx\nproperty float ny\nproperty float nz\nproperty ushort red\n" +
                     "property ushort green\nproperty ushort blue\nelement face 1\nproperty float weight\n" +
                     "property list int uint vertex_index\nelement tristrips 1\n" +
                     "property list uint int vertex_indices\nelement nothing 5\nend_header\n";
  const auto add = [&](auto value) {
    if (ascii)
      text += std::to_string(value) + " ";
    else
      put(text, value, swap);
  };
  for (int i = 0; i < 2; ++i) {
    add(std::uint8_t(2));
    add(1.5);
    add(2.5);
    add(std::int16_t(-7));
  }
  for (int i = 0; i < 4; ++i) {
    add(float(i % 2));
    add(double(i / 2));
    add(0.25f);
    add(std::uint16_t(1));
    add(std::int16_t(i));
    add(std::uint8_t(10 * i));
    for (const float n : {0.f, 0.f, 1.f})
      add(n);
    for (const int c : {0x1234, 0x5678, 0x9abc})
      add(std::uint16_t(c));
    text += ascii ? "\n" : "";
  }
  add(0.5f);
  add(std::int32_t(4));
  for (const std::uint32_t v : {0U, 1U, 3U, 2U})
    add(v);
  add(std::uint32_t(8));
  for (const std::int32_t v : {0, 1, 2, 3, -1, 3, 1, 0})
    add(v);
  return text;
}

TEST(MeshIo, PlyOfAllKinds)
{
  const std::string path = test::scratchFolder() + "/odd.ply";
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    test::writeText(path, oddPly(format));
    const TriangleMesh mesh = readMesh(path);
    ASSERT_EQ(mesh.vertexCount(), 4) << format;
    EXPECT_EQ(mesh.vertices.col(3), Eigen::Vector3f(1, 1, 0.25f)) << format;
    EXPECT_EQ(mesh.normals.col(2), Eigen::Vector3f(0, 0, 1)) << format;
    EXPECT_EQ(mesh.colors(1, 0), 0x56) << format;
    ASSERT_EQ(mesh.fields.size(), 1U) << format;
    EXPECT_EQ(mesh.fields.at("quality")[2], 20.f) << format;
    Faces expected(3, 5);
    expected << 0, 0, 0, 2, 3, 1, 3, 1, 1, 1, 3, 2, 2, 3, 0;
    EXPECT_EQ(mesh.faces, expected) << format;
  }
}

TEST(MeshIo, ObjOfAllKinds)
{
  const std::string path = test::scratchFolder() + "/odd.obj";
  test::writeText(path,
                  "# comment\r\no thing\r\nv 0 0 0 1 0 0.2\r\nv +1 0 0\nv 1 1 0 0 1 0 \nvn 0 0 2\nvt 0 0\nv 0 1 0\n"
                  "f 1/1/1 2/1/1 \\\n 3/1/1 4/1/1\ns off\nusemtl x\nf -4//1 -2 -1\nv 5 5 5\nl 1 2\n");
  const TriangleMesh mesh = readMesh(path);
  ASSERT_EQ(mesh.vertexCount(), 5);
  Faces expected(3, 3);
  expected << 0, 0, 0, 1, 2, 2, 2, 3, 3;
  EXPECT_EQ(mesh.faces, expected);
  EXPECT_EQ(mesh.normals.col(1), Eigen::Vector3f(0, 0, 2));
  EXPECT_EQ(mesh.colors(2, 0), 51);
  EXPECT_EQ(mesh.colors.col(1).cast<int>(), Eigen::Vector3i(255, 255, 255));
  const auto error = [&](const char* text) {
    test::writeText(path, text);
    return test::errorOf([&] { readMesh(path); });
  };
  EXPECT_NE(error("v 0 0\n").find("line 1"), std::string::npos);
  EXPECT_NE(error("v 0 0 0\nf 1 2 3\n").find("names element 2"), std::string::npos);
  EXPECT_NE(error("v 0 0 0\nf -2 1 1\n").find("out of range"), std::string::npos);
  EXPECT_NE(error("v 0 0 x\n").find("'x' is not a number"), std::string::npos);
  EXPECT_NE(error("hello\n").find("no vertices"), std::string::npos);
}

TEST(MeshIo, VtkReadsWhatWeWrite)
{
  const std::string path = test::scratchFolder() + "/mesh.vtk";
  const TriangleMesh mesh = fullMesh(9);
  writeMesh(path, mesh);
  const auto reader = vtkSmartPointer<vtkPolyDataReader>::New();
  reader->SetFileName(path.c_str());
  reader->ReadAllScalarsOn();
  reader->Update();
  vtkPolyData* data = reader->GetOutput();
  ASSERT_EQ(data->GetNumberOfPoints(), mesh.vertexCount());
  ASSERT_EQ(data->GetNumberOfPolys(), mesh.faceCount());
  for (Index v = 0; v < mesh.vertexCount(); ++v)
    for (int k = 0; k < 3; ++k)
      EXPECT_EQ(data->GetPoint(v)[k], static_cast<double>(mesh.vertices(k, v)));
  ASSERT_NE(data->GetPointData()->GetNormals(), nullptr);
  EXPECT_EQ(data->GetPointData()->GetNormals()->GetComponent(5, 1), static_cast<double>(mesh.normals(1, 5)));
  ASSERT_NE(data->GetPointData()->GetArray("rgb"), nullptr);
  EXPECT_EQ(data->GetPointData()->GetArray("rgb")->GetComponent(7, 2), static_cast<double>(mesh.colors(2, 7)));
  ASSERT_NE(data->GetPointData()->GetArray("curvature"), nullptr);
  EXPECT_EQ(data->GetPointData()->GetArray("density")->GetComponent(3, 0),
            static_cast<double>(mesh.fields.at("density")[3]));
}

TEST(MeshIo, ReadsWhatVtkWrites)
{
  const std::string folder = test::scratchFolder();
  const TriangleMesh mesh = fullMesh(9);
  writeMesh(folder + "/ours.vtk", mesh);
  const auto reader = vtkSmartPointer<vtkPolyDataReader>::New();
  reader->SetFileName((folder + "/ours.vtk").c_str());
  reader->ReadAllScalarsOn();
  reader->Update();
  for (const int version :
       {vtkPolyDataWriter::VTK_LEGACY_READER_VERSION_4_2, vtkPolyDataWriter::VTK_LEGACY_READER_VERSION_5_1})
    for (const bool binary : {false, true}) {
      const std::string path = folder + "/theirs.vtk";
      const auto writer = vtkSmartPointer<vtkPolyDataWriter>::New();
      writer->SetInputData(reader->GetOutput());
      writer->SetFileVersion(version);
      writer->SetFileName(path.c_str());
      binary ? writer->SetFileTypeToBinary() : writer->SetFileTypeToASCII();
      ASSERT_EQ(writer->Write(), 1);
      const TriangleMesh back = readMesh(path);
      EXPECT_EQ(back.faces, mesh.faces) << version << binary;
      const float tolerance = binary ? 0.f : 1e-5f; // VTK's ASCII keeps 6 digits
      ASSERT_EQ(back.vertexCount(), mesh.vertexCount());
      EXPECT_LE((back.vertices - mesh.vertices).cwiseAbs().maxCoeff(), 12 * tolerance) << version << binary;
      ASSERT_EQ(back.normals.cols(), mesh.vertexCount()) << version << binary;
      EXPECT_LE((back.normals - mesh.normals).cwiseAbs().maxCoeff(), tolerance) << version << binary;
      ASSERT_EQ(back.colors.cols(), mesh.vertexCount()) << version << binary;
      EXPECT_LE((back.colors.cast<int>() - mesh.colors.cast<int>()).cwiseAbs().maxCoeff(), binary ? 0 : 1);
      ASSERT_EQ(back.fields.count("curvature"), 1U) << version << binary;
    }
}

TEST(MeshIo, VtkReadsOurXml)
{
  const std::string path = test::scratchFolder() + "/mesh.vtp";
  TriangleMesh mesh = fullMesh(9);
  mesh.fields["a <\"b\"> & c"] = mesh.fields.at("curvature");
  writeMesh(path, mesh);
  const auto reader = vtkSmartPointer<vtkXMLPolyDataReader>::New();
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkPolyData& data = *reader->GetOutput();
  ASSERT_EQ(data.GetNumberOfPoints(), mesh.vertexCount());
  ASSERT_EQ(data.GetNumberOfPolys(), mesh.faceCount());
  vtkPointData& attributes = *data.GetPointData();
  for (const auto& [name, values] : mesh.fields)
    ASSERT_NE(attributes.GetArray(name.c_str()), nullptr) << name;
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(data.GetPoint(v)[k], static_cast<double>(mesh.vertices(k, v)));
      EXPECT_EQ(attributes.GetNormals()->GetComponent(v, k), static_cast<double>(mesh.normals(k, v)));
      EXPECT_EQ(attributes.GetScalars()->GetComponent(v, k), mesh.colors(k, v));
    }
    for (const auto& [name, values] : mesh.fields)
      EXPECT_EQ(attributes.GetArray(name.c_str())->GetComponent(v, 0), static_cast<double>(values[v]));
  }
  for (Index f = 0; f < mesh.faceCount(); ++f)
    for (int k = 0; k < 3; ++k)
      EXPECT_EQ(data.GetCell(f)->GetPointId(k), mesh.faces(k, f));
}

TEST(MeshIo, StlKeepsTheSurface)
{
  const std::string path = test::scratchFolder() + "/mesh.stl";
  const TriangleMesh mesh = fullMesh(12);
  writeMesh(path, mesh);
  for (const char* title : {"", "solid of another program"}) { // which some begin binary files with
    std::string bytes = readFile(path);
    writeFile(path, bytes.replace(0, std::string_view(title).size(), title));
    const TriangleMesh back = readMesh(path);
    EXPECT_EQ(back.vertexCount(), mesh.vertexCount());
    ASSERT_EQ(back.faceCount(), mesh.faceCount());
    for (Index i = 0; i < mesh.faces.size(); ++i)
      EXPECT_EQ(back.vertices.col(back.faces.data()[i]), mesh.vertices.col(mesh.faces.data()[i])) << i;
  }
  EXPECT_EQ(readPoints(path).size(), mesh.vertexCount());
  TriangleMesh empty = mesh;
  empty.faces.resize(3, 0);
  EXPECT_THROW(writeMesh(path, empty), std::runtime_error);
}

TEST(MeshIo, StlAsText)
{
  const std::string path = test::scratchFolder() + "/mesh.stl";
  const auto facet = [](const char* a, const char* b, const char* c) {
    return concat("  facet normal 0 0 nan\r\n outer loop\nvertex ", a, "\n\tVERTEX ", b, "\nvertex ", c,
                  "\nendloop\nendfacet\n");
  };
  const std::string first = facet("0 0 0", "1 0 0", "0 1e0 0.5"), second = facet("1 0 0", "1 1 0", "0 1 0.5");
  test::writeText(path, "solid vertex facet\n" + first + "endsolid vertex facet\nSolid\n" + second +
                            facet("0 0 0", "0 0 0", "1 0 0") + "endsolid\n");
  const TriangleMesh mesh = readMesh(path);
  EXPECT_EQ(mesh.vertexCount(), 4); // two are shared
  ASSERT_EQ(mesh.faceCount(), 2);   // the third has no area
  EXPECT_EQ(mesh.vertices.col(mesh.faces(2, 0)), Eigen::Vector3f(0, 1, 0.5f));
  EXPECT_EQ(mesh.faces(2, 0), mesh.faces(2, 1));

  test::writeText(path,
                  "solid\n" + facet("500000 5400000.001 0", "500000 5400000.002 0", "500001 5400000 0") + "endsolid\n");
  const TriangleMesh far = readMesh(path);
  EXPECT_NEAR(far.origin.y() + faceCorner(far, 0, 1).y(), 5400000.002, 1e-4);

  for (const std::string& wrong : std::vector<std::string>{
           "solid\n" + first, std::string("solid\nendsolid\n"),
           "solid\n" + facet("0 0 0", "1 0", "0 1 0") + "endsolid\n",
           "solid\n" + facet("0 0 0", "1 0 inf", "0 1 0") + "endsolid\n",
           std::string("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\nendfacet\nendsolid\n"),
           "solid\ncircle\n" + first + "endsolid\n"}) {
    test::writeText(path, wrong);
    EXPECT_THROW(readMesh(path), std::runtime_error) << wrong;
  }
}

TEST(MeshIo, ErrorsNameFileAndReason)
{
  const std::string folder = test::scratchFolder();
  const auto expectError = [](const std::string& path, const char* reason) {
    const std::string error = test::errorOf([&] { readMesh(path); });
    EXPECT_NE(error.find(path), std::string::npos) << error;
    EXPECT_NE(error.find(reason), std::string::npos) << error;
  };
  expectError(folder + "/missing.ply", "no such file");
  expectError(folder + "/mesh.pcd", "not a mesh file: expected .ply, .vtk, .stl or .obj");
  test::writeText(folder + "/a.ply",
                  "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty "
                  "float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                  "0 0 0\n3 0 0 1\n");
  expectError(folder + "/a.ply", "names vertex 1");
  test::writeText(folder + "/b.ply",
                  "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n"
                  "end_header\nabcdefgh");
  expectError(folder + "/b.ply", "truncated");
  test::writeText(folder + "/c.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\n");
  expectError(folder + "/c.vtk", "POLYDATA");
  test::writeText(folder + "/d.ply", "solid stl");
  expectError(folder + "/d.ply", "not a PLY file");
  EXPECT_THROW(writeMesh(folder + "/mesh.pcd", fullMesh(3)), std::runtime_error);
}

TEST(MeshIo, NamesOfFieldsMayHoldBlanks)
{
  const std::string folder = test::scratchFolder();
  TriangleMesh mesh = fullMesh(4);
  mesh.fields = {{"mean curvature", mesh.fields.at("curvature")}};
  for (const char* type : {"ply", "vtk"}) {
    writeMesh(folder + "/mesh." + type, mesh);
    const TriangleMesh back = readMesh(folder + "/mesh." + type);
    ASSERT_EQ(back.fields.size(), 1U) << type;
    EXPECT_EQ(back.fields.begin()->first, type == std::string("ply") ? "mean_curvature" : "mean curvature");
    EXPECT_TRUE(sameValues(back.fields.begin()->second, mesh.fields.begin()->second)) << type;
  }
}

TEST(MeshIo, FailedWritesLeaveNothingAndTouchNothing)
{
  const std::string folder = test::scratchFolder();
  for (const char* type : {"ply", "obj", "vtk", "stl"}) {
    const std::string path = folder + "/mesh." + type;
    EXPECT_THROW(writeMesh(folder + "/none/mesh." + type, fullMesh(3)), std::runtime_error);
    writeMesh(path, fullMesh(3));
    TriangleMesh broken = fullMesh(4);
    broken.faces(0, 0) = 99;
    EXPECT_THROW(writeMesh(path, broken), std::invalid_argument);
    EXPECT_EQ(readMesh(path).vertexCount(), 9);
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 4);
}

TEST(MeshIo, Fandisk)
{
  FRESCO_NEED_DATA("fandisk.obj");
  const TriangleMesh mesh = readMesh(test::dataFolder() + "/fandisk.obj");
  EXPECT_EQ(mesh.vertexCount(), 6475);
  EXPECT_EQ(mesh.faceCount(), 12946);
  EXPECT_TRUE(meshTopology(mesh).watertight);
  EXPECT_GT(signedVolume(mesh), 0);
  EXPECT_EQ(mesh.origin, Eigen::Vector3d::Zero());
}

TEST(MeshIo, IgeaFromTriangleStrips)
{
  FRESCO_NEED_DATA("igea.ply");
  const TriangleMesh mesh = readMesh(test::dataFolder() + "/igea.ply");
  EXPECT_EQ(mesh.vertexCount(), 134345);
  EXPECT_EQ(mesh.faceCount(), 268686);
  const MeshTopology topology = meshTopology(mesh);
  EXPECT_TRUE(topology.watertight);
  EXPECT_EQ(topology.euler, 2);
  EXPECT_GT(signedVolume(mesh), 0);
}
} // namespace
