// SPDX-License-Identifier: BSD-3-Clause
// Peer: pcl::Poisson. Reads a PLY cloud with normals, writes a PLY mesh.
#include "support/tool.h"
#include <pcl/console/print.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>
#include <pcl/surface/poisson.h>
#include <stdexcept>
#include <thread>
namespace {
struct Options {
  std::string input, output;
  int depth = 8, threads = 0;
  float point_weight = 4.f, samples_per_node = 1.f;
};

Options parse(int argc, char** argv)
{
  Options options;
  fresco::Args args("fresco_benchmark_peer_pcl_poisson IN.ply OUT.ply [options]", "pcl::Poisson, for comparison.");
  args.option("depth", options.depth, fresco::Range::within(1, 16), "octree depth");
  args.option("threads", options.threads, fresco::Range::atLeast(1).zero("all cores"), "number of threads");
  args.option("point_weight", options.point_weight, fresco::Range::atLeast(0), "weight of interpolation");
  args.option("samples_per_node", options.samples_per_node, fresco::Range::above(0), "least points per node");
  const std::vector<std::string> files = args.parse(argc, argv, 2);
  options.input = files[0];
  options.output = files[1];
  return options;
}

void run(const Options& options)
{
  pcl::console::setVerbosityLevel(pcl::console::L_ERROR); // fields that a cloud does not have are no news
  const auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  if (pcl::io::loadPLYFile(options.input, *cloud) < 0)
    throw std::runtime_error(options.input + ": cannot be read");
  pcl::Poisson<pcl::PointNormal> poisson;
  poisson.setInputCloud(cloud);
  poisson.setDepth(options.depth);
  poisson.setPointWeight(options.point_weight);
  poisson.setSamplesPerNode(options.samples_per_node);
  poisson.setThreads(options.threads > 0 ? options.threads : static_cast<int>(std::thread::hardware_concurrency()));
  pcl::PolygonMesh mesh;
  poisson.reconstruct(mesh);
  if (mesh.polygons.empty() || pcl::io::savePLYFileBinary(options.output, mesh) < 0)
    throw std::runtime_error(options.output + ": no mesh, or it cannot be written");
}
} // namespace

int main(int argc, char** argv)
{
  return fresco::runTool("fresco_benchmark_peer_pcl_poisson", [&] { run(parse(argc, argv)); });
}
