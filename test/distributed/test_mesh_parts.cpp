// SPDX-License-Identifier: BSD-3-Clause
#include "common/shapes.h"
#include "mesh_parts.h"
#include "mesh_parts/open_file.h"
#include "test_data.h"
#include "thread_ranks.h"
#include <fresco/distributed/mesh_part.h>
#include <fresco/io/file.h>
#include <random>
namespace {
using namespace fresco;

/// A ball with all attributes and, last, a vertex that no face uses.
TriangleMesh fullBall()
{
  TriangleMesh mesh = test::sphere(1.f, 3);
  mesh.vertices.conservativeResize(3, mesh.vertexCount() + 1);
  mesh.vertices.rightCols<1>() = Eigen::Vector3f(0.5f, 0.f, 0.25f);
  mesh.normals = mesh.vertices.colwise().normalized();
  mesh.colors = (100.f * (mesh.vertices.array() + 1.f)).cast<std::uint8_t>();
  mesh.fields["height"] = mesh.vertices.row(2).transpose();
  mesh.fields["support"] = Eigen::VectorXf::LinSpaced(mesh.vertexCount(), 3.f, 9.f);
  return mesh;
}

/// Runs of random length, dealt out at random.
std::vector<std::vector<MeshPart::Run>> deal(Index count, int ranks, std::mt19937& random)
{
  std::vector<std::vector<MeshPart::Run>> runs(ranks);
  for (Index first = 0; first < count;) {
    const Index length = std::min<Index>(random() % 60, count - first);
    runs[random() % ranks].push_back({first, length});
    first += length;
  }
  return runs;
}

template <typename Matrix>
Matrix taken(const Matrix& whole, const std::vector<MeshPart::Run>& runs)
{
  Matrix part(whole.rows(), 0);
  for (const MeshPart::Run& run : runs) {
    part.conservativeResize(whole.rows(), part.cols() + run.count);
    part.rightCols(run.count) = whole.middleCols(run.first, run.count);
  }
  return part;
}

TriangleMesh partOf(const TriangleMesh& whole, const std::vector<MeshPart::Run>& vertices,
                    const std::vector<MeshPart::Run>& faces)
{
  TriangleMesh part;
  part.vertices = taken(whole.vertices, vertices);
  part.normals = taken(whole.normals, vertices);
  part.colors = taken(whole.colors, vertices);
  for (const auto& [name, values] : whole.fields)
    part.fields[name] = taken(Eigen::RowVectorXf(values.transpose()), vertices).transpose();
  part.faces = taken(whole.faces, faces);
  return part;
}

void writeAll(const std::string& path, const TriangleMesh& mesh, int count, std::mt19937& random)
{
  const auto vertices = deal(mesh.vertexCount(), count, random), faces = deal(mesh.faceCount(), count, random);
  test::ThreadRanks::run(count, [&](Exchange& ranks) {
    const int r = ranks.rank();
    const TriangleMesh own = partOf(mesh, vertices[r], faces[r]);
    writeMeshParts(path, {own, vertices[r], faces[r], mesh.vertexCount(), mesh.faceCount()}, ranks);
  });
}

TEST(MeshParts, MakeUpTheWholeAgain)
{
  const TriangleMesh mesh = fullBall();
  std::mt19937 random(4);
  for (const int count : {1, 2, 3, 7}) {
    const std::string folder = test::scratchFolder();
    writeAll(folder + "/all.ply", mesh, count, random);
    const TriangleMesh again = test::joinedParts(folder, "all.json");
    EXPECT_TRUE(again.vertices == mesh.vertices);
    EXPECT_TRUE(again.faces == mesh.faces);
    EXPECT_TRUE(again.normals.isApprox(mesh.normals));
    EXPECT_TRUE(again.colors == mesh.colors);
    EXPECT_TRUE(again.fields == mesh.fields);
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      EXPECT_NE(entry.path().filename().string()[0], '.') << entry.path();
  }
}

// A part has no vertex that its faces do not use, but those that no face of any rank uses.
TEST(MeshParts, HaveWhatTheirFacesUse)
{
  const std::string folder = test::scratchFolder();
  std::mt19937 random(5);
  const TriangleMesh mesh = fullBall();
  writeAll(folder + "/all.ply", mesh, 3, random);
  Index unused = 0;
  for (const char* name : {"/all_0000.ply", "/all_0001.ply", "/all_0002.ply"}) {
    const TriangleMesh part = readMesh(folder + name);
    unused += part.vertexCount() - removeUnreferencedVertices(part).vertexCount();
  }
  EXPECT_EQ(unused, mesh.vertexCount() - removeUnreferencedVertices(mesh).vertexCount());
}

// One rank cannot write: the others' files do not get their names, and older ones stay.
TEST(MeshParts, LargePiecesLieWhereTheyBelong)
{
  const std::string path = test::scratchFolder() + "/file", begin = "begin";
  std::string large(20u << 20, ' ');
  for (std::size_t i = 0; i < large.size(); ++i)
    large[i] = static_cast<char>(i * i >> 7);
  writeFile(path, begin);
  io::OpenFile(path, path).write(begin.size(), large.data(), large.size());
  EXPECT_TRUE(readFile(path) == begin + large);
}

TEST(MeshParts, AllOrNone)
{
  const std::string folder = test::scratchFolder();
  std::mt19937 random(6);
  writeFile(folder + "/all_0000.ply", "older");
  std::filesystem::create_directory(folder + "/all_0001.ply");
  EXPECT_THROW(writeAll(folder + "/all.ply", fullBall(), 2, random), std::runtime_error);
  EXPECT_EQ(readFile(folder + "/all_0000.ply"), "older");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 2);
}
} // namespace
