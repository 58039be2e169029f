// SPDX-License-Identifier: BSD-3-Clause
#include "common/io/memory_limit.h"
#include "common/io/test_io_data.h"
#include <fresco/io/cloud_file.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_io.h>
#include <fstream>
namespace {
using namespace fresco;

using Reader = std::function<void(const std::string&)>;

struct Sample {
  std::string name, content;
  std::vector<Reader> readers;
  bool cut_is_an_error; ///< no part of the file is a file of its own
};

void readAsPoints(const std::string& path)
{
  const PointSet set = readPoints(path);
  EXPECT_GT(set.size(), 0) << path;
  validatePointSet(set);
  EXPECT_EQ(toPointSet(readCloud(path)).size(), set.size()) << path;
}

void expectFacesInRange(const TriangleMesh& mesh, const std::string& path)
{
  EXPECT_GT(mesh.vertexCount(), 0) << path;
  if (mesh.faceCount() == 0)
    return;
  EXPECT_GE(mesh.faces.minCoeff(), 0) << path;
  EXPECT_LT(mesh.faces.maxCoeff(), mesh.vertexCount()) << path;
}

void readAsMesh(const std::string& path) { expectFacesInRange(readMesh(path), path); }

void readAsModel(const std::string& path)
{
  const TexturedMesh model = readTexturedMesh(path);
  expectFacesInRange(model.mesh, path);
  EXPECT_EQ(model.face_atlas.size(), model.mesh.faceCount()) << path;
  for (Index i = 0; i < model.mesh.faces.size(); ++i)
    EXPECT_LT(model.texcoord_faces.data()[i], model.texcoords.cols()) << path;
}

std::string asciiPcd()
{
  std::string text =
      "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb _\nSIZE 4 4 4 4 1\nTYPE F F F U U\nCOUNT 1 1 1 1 2\nWIDTH 3\n"
      "HEIGHT 2\nVIEWPOINT 0 0 1 1 0 0 0\nPOINTS 6\nDATA ascii\n";
  for (int i = 0; i < 6; ++i)
    text += std::to_string(i) + ".5 nan -1e-3 1671100" + std::to_string(i) + " 0 0\n";
  return text;
}

std::vector<Sample> samples(const std::string& folder)
{
  std::vector<Sample> result;
  const auto take = [&](const std::string& name, std::vector<Reader> readers, bool cut_is_an_error) {
    result.push_back({name, readFile(folder + "/" + name), std::move(readers), cut_is_an_error});
  };
  const PointSet set = test::fullPointSet(6);
  const TriangleMesh mesh = test::fullMesh(3);
  writePoints(folder + "/cloud.pcd", set);
  take("cloud.pcd", {readAsPoints}, true);
  CloudFile even = toCloudFile(set);
  std::fill(even.cloud.data.begin(), even.cloud.data.end(), std::uint8_t{1});
  writeCloud(folder + "/small.pcd", even, true);
  take("small.pcd", {readAsPoints}, true);
  test::writeText(folder + "/ascii.pcd", asciiPcd());
  take("ascii.pcd", {readAsPoints}, false);
  writePoints(folder + "/cloud.ply", set);
  take("cloud.ply", {readAsPoints, readAsMesh}, true);
  writePoints(folder + "/cloud.xyz", set);
  take("cloud.xyz", {readAsPoints}, false);
  for (const char* name : {"mesh.ply", "mesh.vtk", "mesh.stl", "mesh.obj"}) {
    writeMesh(folder + "/" + name, mesh);
    take(name, {readAsPoints, readAsMesh}, name == std::string("mesh.ply"));
  }
  test::writeText(folder + "/ascii.ply",
                  "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                  "property double z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
                  "element tristrips 1\nproperty list int int vertex_indices\nelement odd 2\n"
                  "property list uchar float f\nend_header\n0 0 0 1 2 3\n1 0 0 4 5 6\n0 1 0 7 8 9\n"
                  "4 0 1 2 -1\n1 0.5\n2 1 1\n");
  take("ascii.ply", {readAsPoints, readAsMesh}, false);
  test::writeText(folder + "/ascii.vtk",
                  "# vtk DataFile Version 5.1\nt\nASCII\nDATASET POLYDATA\nPOINTS 3 double\n0 0 0 1 0 0 0 "
                  "1 0\nMETADATA\nINFORMATION 0\n\nTRIANGLE_STRIPS 2 3\nOFFSETS vtktypeint64\n0 3\n"
                  "CONNECTIVITY vtktypeint64\n0 1 2\nPOINT_DATA 3\nSCALARS i short 1\nLOOKUP_TABLE "
                  "default\n1 2 3\nFIELD FieldData 1\na%20b 2 3 float\n1 2 3 4 5 6\n");
  take("ascii.vtk", {readAsPoints, readAsMesh}, false);
  writeTexturedMesh(folder + "/model.glb", test::fullTexturedMesh(3, 1));
  take("model.glb", {readAsModel}, true);
  writeTexturedMesh(folder + "/model.obj", test::fullTexturedMesh(3, 1));
  take("model.obj", {readAsModel, readAsMesh}, false);
  return result;
}

void store(const std::string& path, std::string_view content)
{
  std::filesystem::remove(path); // some file systems flush a file that is cut and written again
  std::ofstream(path, std::ios::binary).write(content.data(), static_cast<std::streamsize>(content.size()));
}

/// Every error must name the file (or one that it names), and none may be that of an allocation without measure.
void expectErrorOrResult(const Sample& sample, const std::string& path, bool error_expected)
{
  for (const Reader& reader : sample.readers) {
    const std::string error = test::errorOf([&] { reader(path); });
    EXPECT_EQ(error.find("not enough memory"), std::string::npos) << error;
    EXPECT_EQ(error.find("bad_alloc"), std::string::npos) << error;
    EXPECT_TRUE(error.empty() || error.find(std::filesystem::path(path).parent_path()) != std::string::npos) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    EXPECT_TRUE(!error_expected || !error.empty()) << path;
  }
}

TEST(DamagedFiles, CutAtEveryByte)
{
  const std::string folder = test::scratchFolder();
  const std::vector<Sample> all = samples(folder);
  std::filesystem::create_directory(folder + "/cut");
  std::filesystem::copy(folder + "/model.mtl", folder + "/cut/model.mtl");
  std::filesystem::copy(folder + "/model.png", folder + "/cut/model.png");
  const test::MemoryLimit limit;
  for (const Sample& sample : all) {
    const std::string path = folder + "/cut/" + sample.name;
    for (std::size_t length = 0; length < sample.content.size(); ++length) {
      store(path, std::string_view(sample.content).substr(0, length));
      SCOPED_TRACE(sample.name + " cut at " + std::to_string(length));
      expectErrorOrResult(sample, path, sample.cut_is_an_error || length == 0);
    }
  }
}

TEST(DamagedFiles, ChangedBytes)
{
  const std::string folder = test::scratchFolder();
  const std::vector<Sample> all = samples(folder);
  std::filesystem::create_directory(folder + "/changed");
  std::filesystem::copy(folder + "/model.mtl", folder + "/changed/model.mtl");
  std::filesystem::copy(folder + "/model.png", folder + "/changed/model.png");
  const test::MemoryLimit limit;
  std::mt19937 generator(99);
  const char likely[] = "0123456789-+.eE \n\xff\x7f\x80";
  for (const Sample& sample : all) {
    const std::string path = folder + "/changed/" + sample.name;
    for (int round = 0; round < 1000; ++round) {
      std::string content = sample.content;
      for (unsigned changes = 1 + generator() % 3; changes > 0; --changes) {
        char& byte = content[generator() % content.size()];
        byte = generator() % 2 ? static_cast<char>(generator()) : likely[generator() % (sizeof(likely) - 1)];
      }
      store(path, content);
      SCOPED_TRACE(sample.name + " round " + std::to_string(round));
      expectErrorOrResult(sample, path, false);
    }
  }
}

TEST(DamagedFiles, WrongExtension)
{
  const std::string folder = test::scratchFolder();
  for (const Sample& sample : samples(folder))
    for (const char* type : {"pcd", "ply", "obj", "vtk", "vtp", "stl", "xyz", "glb"}) {
      const std::string path = folder + "/renamed." + type;
      store(path, sample.content);
      for (const Reader& reader : {Reader(readAsPoints), Reader(readAsMesh), Reader(readAsModel)}) {
        const std::string error = test::errorOf([&] { reader(path); });
        EXPECT_TRUE(error.empty() || error.find("renamed") != std::string::npos) << error;
      }
    }
}

TEST(DamagedFiles, StlWhoseCountIsLetters)
{
  const std::string path = test::scratchFolder() + "/letters.stl";
  writeFile(path, std::string(40, 'h') + std::string(104, '\x16'));
  const std::string error = test::errorOf([&] { readMesh(path); });
  EXPECT_NE(error.find("the triangles do not fit into the file"), std::string::npos) << error;
}
} // namespace
