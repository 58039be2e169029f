// SPDX-License-Identifier: BSD-3-Clause
#include "surface/distance/distance_meshes.h"
#include "test_data.h"
#include <algorithm>
#include <cstdlib>
#include <fresco/io/file.h>
#include <fresco/io/mesh_io.h>
#include <fresco/surface/core/mesh_distance.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
namespace fresco {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

struct Outcome {
  int status;
  std::string out, error;
};

// Runs `program` with `arguments` (quoted by the caller).
Outcome runProgram(const std::string& program, const std::string& arguments, const std::string& folder)
{
  const std::string out = folder + "/stdout.txt", error = folder + "/stderr.txt";
  const int code = std::system((program + " " + arguments + " >" + out + " 2>" + error).c_str());
  const auto content = [](const std::string& path) { return fs::file_size(path) > 0 ? readFile(path) : std::string(); };
  return {WIFEXITED(code) ? WEXITSTATUS(code) : -1, content(out), content(error)};
}

class Compare : public testing::Test {
protected:
  Outcome compare(const std::string& arguments) const
  {
    return runProgram(test::buildFolder() + "/bin/fresco_compare", arguments, folder);
  }
  std::string path(const std::string& name) const { return folder + "/" + name; }
  std::string write(const std::string& name, const TriangleMesh& mesh) const
  {
    writeMesh(path(name), mesh);
    return path(name);
  }
  std::string writeText(const std::string& name, const std::string& text) const
  {
    std::ofstream(path(name)) << text;
    return path(name);
  }
  void expectFailure(const std::string& arguments, int status, const std::string& word) const
  {
    const Outcome run = compare(arguments + " -quiet");
    EXPECT_EQ(run.status, status) << arguments << run.error;
    EXPECT_NE(run.error.find(word), std::string::npos) << run.error;
    EXPECT_EQ(std::count(run.error.begin(), run.error.end(), '\n'), 1) << run.error;
    EXPECT_EQ(run.out, "");
  }

  const std::string folder = test::scratchFolder();
  const TriangleMesh cube = test::gridCube(6), rounded = test::roundedCube(9, 0.4f);
};

TEST_F(Compare, JsonHoldsTheFiguresOfTheCore)
{
  const std::string mesh = write("rounded.ply", rounded), reference = write("cube.obj", cube);
  const Outcome run = compare(mesh + " " + reference + " -samples 5000 -seed 3 -json " + path("out.json"));
  ASSERT_EQ(run.status, 0) << run.error;
  MeshDistanceOptions options;
  options.samples = 5000;
  options.seed = 3;
  const MeshDistanceResult expected = measureMeshDistance(readMesh(mesh), readMesh(reference), options);
  const json found = json::parse(readFile(path("out.json")));
  EXPECT_EQ(found["reference_diagonal"], expected.reference_diagonal);
  EXPECT_EQ(found["vertices"]["mesh_to_reference"]["max"], expected.vertices.to_reference.max);
  EXPECT_EQ(found["vertices"]["reference_to_mesh"]["mean"], expected.vertices.from_reference.mean);
  EXPECT_EQ(found["surface"]["symmetric"]["rms"], expected.surface.symmetric.rms);
  EXPECT_NEAR(found["vertices"]["symmetric"]["rms_percent"].get<double>(),
              100 * expected.vertices.symmetric.rms / expected.reference_diagonal, 1e-12);
  EXPECT_EQ(found["normals"]["mesh_to_reference"]["percentile95"], expected.normals_to_reference.percentile95);
  EXPECT_EQ(found["mesh"]["boundary_edges"], expected.mesh_topology.boundary_edges);
  EXPECT_EQ(found["reference"]["watertight"], false); // the cube's sides are separate grids
  for (const char* word : {"max", "mean", "RMS", "symmetric", "absolute distance", "b-box diagonal", "watertight"})
    EXPECT_NE(run.out.find(word), std::string::npos) << word;
}

TEST_F(Compare, ColoredMeshCarriesTheDistances)
{
  const Outcome run =
      compare(write("a.ply", rounded) + " " + write("b.vtk", cube) + " -quiet -colored " + path("c.ply"));
  ASSERT_EQ(run.status, 0) << run.error;
  EXPECT_EQ(run.error, "");
  const TriangleMesh colored = readMesh(path("c.ply"));
  const Eigen::VectorXf expected = vertexDistances(rounded, cube);
  ASSERT_EQ(colored.fields.count("distance"), 1U);
  EXPECT_EQ(colored.fields.at("distance"), expected);
  EXPECT_EQ(colored.faces, rounded.faces);
  Index farthest;
  expected.maxCoeff(&farthest);
  EXPECT_EQ(int(colored.colors(0, farthest)), 0);
  EXPECT_EQ(int(colored.colors(2, farthest)), 255);
}

TEST_F(Compare, PolygonsAreTriangulated)
{
  const std::string quad = writeText("quad.obj", "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4\n");
  const std::string above = writeText("above.obj", "v 0 0 1\nv 2 0 1\nv 2 2 1\nv 0 2 1\nf 1 2 3 4\n");
  ASSERT_EQ(compare(above + " " + quad + " -json " + path("o.json")).status, 0);
  const json found = json::parse(readFile(path("o.json")));
  EXPECT_EQ(found["mesh"]["faces"], 2);
  EXPECT_EQ(found["vertices"]["symmetric"]["mean"], 1.0);
}

TEST_F(Compare, VerticesOption)
{
  const std::string a = writeText("a.obj", "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nf 1 2 3 4\n");
  const std::string b = writeText("b.obj", "v 2 2 0\nv 3 2 0\nv 2 3 0\nf 1 2 3\n");
  ASSERT_EQ(compare(b + " " + a + " -vertices -json " + path("o.json")).status, 0);
  const json found = json::parse(readFile(path("o.json")));
  EXPECT_NEAR(found["vertices"]["mesh_to_reference"]["max"].get<double>(), std::sqrt(8.0), 1e-12);
}

TEST_F(Compare, BadInput)
{
  const std::string good = write("good.ply", cube);
  TriangleMesh bad = cube;
  bad.faces.resize(3, 0);
  const std::string cloud = write("cloud.ply", bad);
  expectFailure(cloud + " " + good, 1, cloud + ": no faces");
  expectFailure(good + " " + cloud, 1, cloud + ": no faces");
  const std::string header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                             "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const std::string nan_file = writeText("nan.ply", header + "0 0 0\nnan 1 0\n1 0 0\n3 0 1 2\n");
  expectFailure(nan_file + " " + good, 1, nan_file);
  expectFailure(good + " " + nan_file, 1, nan_file);
  const std::string huge = writeText("huge.obj", "v 0 0 0\nv 1e30 0 0\nv 0 1e30 0\nf 1 2 3\n");
  expectFailure(huge + " " + good, 1, huge);
  const std::string flat = writeText("flat.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n");
  expectFailure(good + " " + flat, 1, flat);
  expectFailure(good + " " + path("missing.ply"), 1, "missing.ply");
  expectFailure(good + " " + writeText("empty.ply", ""), 1, "empty.ply");
  const std::string half = writeText("half.ply", readFile(good).substr(0, 700));
  expectFailure(half + " " + good, 1, half);
  expectFailure(good + " " + good + " -json /proc/nothing/x.json", 1, "x.json");
  expectFailure(good + " " + good + " -colored /proc/nothing/x.ply", 1, "x.ply");
}

TEST_F(Compare, WrongUsage)
{
  const std::string good = write("good.ply", cube);
  expectFailure(good, 2, "-h");
  expectFailure(good + " " + good + " -nonsense", 2, "nonsense");
  expectFailure(good + " " + good + " -samples many", 2, "samples");
  expectFailure(good + " " + good + " -samples -4", 2, "samples");
  expectFailure(good + " " + good + " -colored x.obj", 2, "colored");
  const Outcome help = compare("-h");
  EXPECT_EQ(help.status, 0);
  for (const char* option : {"-json", "-colored", "-samples", "-vertices", "-threads", "-quiet", "-seed"})
    EXPECT_NE(help.out.find(option), std::string::npos) << option;
}

TEST_F(Compare, IndependentProgramAgrees)
{
  const std::string judge = test::projectFolder() + "/../shared/measure/meshdist.py";
  if (!fs::exists(judge) || std::system("/usr/bin/python3 -c 'import open3d' >/dev/null 2>&1") != 0) {
    std::cout << "*** SKIPPED: needs " << judge << " and Python's open3d ***\n";
    GTEST_SKIP();
  }
  const std::string mesh = write("mesh.ply", test::roundedCube(20, 0.4f)), reference = write("reference.ply", cube);
  const Outcome theirs =
      runProgram("/usr/bin/python3 " + judge, mesh + " " + reference + " --json --samples 1000", folder);
  ASSERT_EQ(theirs.status, 0) << theirs.error;
  ASSERT_EQ(compare(mesh + " " + reference + " -json " + path("o.json")).status, 0);
  const json a = json::parse(theirs.out)["vertex"], b = json::parse(readFile(path("o.json")))["vertices"];
  for (const char* figure : {"max", "mean", "rms"}) {
    const double to = a["recon_to_ref"][figure], from = a["ref_to_recon"][figure];
    EXPECT_NEAR(b["mesh_to_reference"][figure].get<double>(), to, 5e-5 * to) << figure;
    EXPECT_NEAR(b["reference_to_mesh"][figure].get<double>(), from, 5e-5 * from) << figure;
  }
}
} // namespace
} // namespace fresco
