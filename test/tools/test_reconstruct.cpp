// SPDX-License-Identifier: BSD-3-Clause
#include "surface/poisson/volumetric_shapes.h"
#include "test_data.h"
#include <cstdlib>
#include <fresco/io/file.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_io.h>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <sys/wait.h>
namespace fresco::test {
namespace {
class ReconstructTool : public testing::Test {
protected:
  void SetUp() override { writePoints(path("in.ply"), sphere(8000)); }

  std::string path(const std::string& name) const { return folder_ + "/" + name; }

  /// Exit status of `fresco_reconstruct IN OUT OPTIONS`; -1 after a signal.
  int run(const std::string& in, const std::string& out, const std::string& options) const
  {
    const std::string command = buildFolder() + "/bin/fresco_reconstruct " + path(in) + " " + path(out) + " " +
                                options + " >" + path("log.out") + " 2>" + path("log.err");
    const int code = std::system(command.c_str());
    return WIFEXITED(code) ? WEXITSTATUS(code) : -1;
  }

  TriangleMesh mesh(const std::string& options, const std::string& in = "in.ply") const
  {
    EXPECT_EQ(run(in, "out.ply", "-quiet " + options), 0) << options << readFile(path("log.err"));
    return readMesh(path("out.ply"));
  }

  /// What the core makes of the file.
  TriangleMesh expected(const VolumetricOptions& options) const
  {
    return reconstructVolumetric(readPoints(path("in.ply")), options).mesh;
  }

  std::string folder_ = scratchFolder();
};

TEST_F(ReconstructTool, EachOptionReachesTheCore)
{
  const auto expectSame = [&](const std::string& text, const auto& change) {
    VolumetricOptions options = atDepth(6);
    change(options);
    const TriangleMesh got = mesh("-depth 6 " + text), wanted = expected(options);
    EXPECT_EQ(got.vertices, wanted.vertices) << text;
    EXPECT_EQ(got.faces, wanted.faces) << text;
    EXPECT_EQ(got.fields.at("support"), wanted.fields.at("support")) << text;
  };
  expectSame("", [](VolumetricOptions&) {});
  expectSame("-depth 5", [](VolumetricOptions& o) { o.depth = 5; });
  expectSame("-cell 0.1", [](VolumetricOptions& o) { o.cell_size = 0.1; });
  expectSame("-point_weight 1", [](VolumetricOptions& o) { o.point_weight = 1; });
  expectSame("-samples_per_node 3", [](VolumetricOptions& o) { o.samples_per_node = 3; });
  expectSame("-trim 5.7", [](VolumetricOptions& o) { o.trim = 5.7f; });
  expectSame("-trim_levels 0.1", [](VolumetricOptions& o) { o.trim_levels = 0.1f; });
  expectSame("-scale 1.5", [](VolumetricOptions& o) { o.scale = 1.5; });
  expectSame("-min_depth 3", [](VolumetricOptions& o) { o.min_depth = 3; });
  expectSame("-iterations 2", [](VolumetricOptions& o) { o.iterations = 2; });
  expectSame("-threads 1", [](VolumetricOptions&) {});
  expectSame("-threads 5", [](VolumetricOptions&) {});
}

TEST_F(ReconstructTool, ConfidenceIsTakenFromTheFile)
{
  PointSet points = sphere(8000);
  points.confidences = points.points.row(2).transpose().array() + 1.1f;
  points.points.leftCols(2000) *= 1.02f;
  writePoints(path("in.ply"), points);
  VolumetricOptions options = atDepth(6);
  options.confidence = true;
  const TriangleMesh trusting = expected(options);
  EXPECT_EQ(mesh("-depth 6 -confidence").vertices, trusting.vertices);
  const TriangleMesh usual = expected(atDepth(6));
  EXPECT_FALSE(trusting.vertexCount() == usual.vertexCount() && trusting.vertices == usual.vertices);
}

TEST_F(ReconstructTool, FreeSpaceNeedsViewpoints)
{
  EXPECT_EQ(run("in.ply", "none.ply", "-depth 6 -free_space"), 1);
  EXPECT_NE(readFile(path("log.err")).find("in.ply: free space: the points have no viewpoints"), std::string::npos);
  EXPECT_FALSE(std::ifstream(path("none.ply")).good());
  PointSet room = sphere(8000);
  room.normals *= -1;
  room.viewpoints.setZero(3, 8000);
  writePoints(path("room.ply"), room);
  const TriangleMesh plain = mesh("-depth 6", "room.ply"), asked = mesh("-depth 6 -free_space", "room.ply");
  EXPECT_EQ(plain.vertices, asked.vertices) << "beams agree";
}

TEST_F(ReconstructTool, EstimatePrintsMegabytesAndWritesNothing)
{
  ASSERT_EQ(run("in.ply", "out.ply", "-depth 8 -estimate -quiet"), 0);
  const double coarse = std::stod(readFile(path("log.out")));
  EXPECT_FALSE(std::filesystem::exists(path("out.ply")));
  ASSERT_EQ(run("in.ply", "out.ply", "-depth 10 -estimate -quiet"), 0);
  EXPECT_GT(coarse, 1);
  EXPECT_GT(std::stod(readFile(path("log.out"))), coarse);
}

TEST_F(ReconstructTool, LittleMemoryGivesTheSameBytes)
{
  ASSERT_EQ(run("in.ply", "out.ply", "-depth 8 -quiet"), 0);
  const std::string expected = readFile(path("out.ply"));
  std::filesystem::create_directories(path("scratch"));
  const std::string little = "-depth 8 -quiet -memory 256 -scratch " + path("scratch");
  ASSERT_EQ(run("in.ply", "out.ply", little + " -estimate"), 0);
  double memory = 0, files = 0, seconds = 0;
  std::istringstream(readFile(path("log.out"))) >> memory >> files >> seconds;
  EXPECT_GT(files, 0); // so that something is tested here
  EXPECT_LT(files, memory);
  EXPECT_GT(seconds, 0);
  ASSERT_EQ(run("in.ply", "out.ply", little), 0) << readFile(path("log.err"));
  EXPECT_EQ(readFile(path("out.ply")), expected);
  EXPECT_TRUE(std::filesystem::is_empty(path("scratch")));
  EXPECT_EQ(run("in.ply", "new.ply", "-memory 256 -scratch " + path("none")), 1);
  EXPECT_FALSE(std::filesystem::exists(path("new.ply")));
  EXPECT_EQ(run("in.ply", "new.ply", "-memory 10"), 2);
  EXPECT_EQ(run("in.ply", "new.ply", "-scratch " + path("scratch")), 2);
}

TEST_F(ReconstructTool, SeveralFilesAreOneCloudInAnyOrder)
{
  std::filesystem::create_directories(path("parts"));
  const PointSet whole = readPoints(path("in.ply"));
  std::vector<Index> part[3];
  for (Index i = 0; i < whole.size(); ++i)
    part[i * 7 % 3].push_back(i);
  writePoints(path("parts/a.ply"), selectPoints(whole, part[0]));
  writePoints(path("parts/b.pcd"), selectPoints(whole, part[1]));
  writePoints(path("parts/c.xyz"), selectPoints(whole, part[2]));
  const auto bytes = [&](const std::string& inputs) {
    EXPECT_EQ(run(inputs, "out.ply", "-depth 6"), 0) << readFile(path("log.err"));
    return readFile(path("out.ply"));
  };
  const std::string expected = bytes("in.ply");
  EXPECT_EQ(bytes("parts"), expected);
  EXPECT_EQ(bytes("parts/c.xyz " + path("parts/a.ply") + " " + path("parts/b.pcd")), expected);
  EXPECT_NE(readFile(path("log.err")).find("8000 points used"), std::string::npos);
  EXPECT_EQ(run("parts", "parts/a.ply", "-depth 6"), 2); // an input
  EXPECT_EQ(run("parts", "out.ply", "-scan 1"), 2);
}

TEST_F(ReconstructTool, OptionsOutOfRangeAreWrongUsage)
{
  for (const char* wrong :
       {"-depth 99", "-depth 1", "-depth x", "-depth", "-cell -1", "-point_weight -1", "-samples_per_node 0",
        "-trim -2", "-trim_levels -1", "-scale 0.5", "-min_depth 9", "-iterations 0", "-threads -1", "-nonsense 1"}) {
    EXPECT_EQ(run("in.ply", "out.ply", wrong), 2) << wrong;
    const std::string said = readFile(path("log.err"));
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
    EXPECT_FALSE(std::filesystem::exists(path("out.ply")));
  }
}

TEST_F(ReconstructTool, CellTooSmallForTheOctreeSaysSo)
{
  EXPECT_EQ(run("in.ply", "out.ply", "-cell 1e-7"), 1);
  EXPECT_NE(readFile(path("log.err")).find("in.ply"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(path("out.ply")));
}

TEST_F(ReconstructTool, MapCoordinatesLoseNoAccuracy)
{
  const PointSet points = sphere(8000);
  const Eigen::Vector3d far(448262.125, 5428890.5, 131.25);
  std::ofstream file(path("far.xyz"));
  file << std::setprecision(14);
  for (Index i = 0; i < points.size(); ++i)
    file << (points.points.col(i).cast<double>() + far).transpose() << ' ' << points.normals.col(i).transpose() << '\n';
  file.close();
  const TriangleMesh mesh = this->mesh("-depth 6", "far.xyz");
  ASSERT_GT(mesh.vertexCount(), 1000);
  double worst = 0;
  for (Index v = 0; v < mesh.vertexCount(); ++v)
    worst = std::max(worst, std::abs((mesh.vertices.col(v).cast<double>() + mesh.origin - far).norm() - 1));
  EXPECT_LT(worst, 0.3 * 2.2 / 64);
  EXPECT_LT(maxDistance(expected(atDepth(6)), sphereDistance), 0.3 * 2.2 / 64);
  EXPECT_TRUE(meshTopology(mesh).watertight);
}
} // namespace
} // namespace fresco::test
