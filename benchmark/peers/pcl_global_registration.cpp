// SPDX-License-Identifier: BSD-3-Clause
// Peer: PCL's classes for scans without start poses. Each pair by FPFH, pcl::SampleConsensusPrerejective and
// point-to-plane ICP; pairs that overlap hold scans together; errors of loops by pcl::registration::LUM or ELCH.
#include "support/tool.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <boost/graph/dijkstra_shortest_paths.hpp> // elch.h forgets it
#include <filesystem>
#include <fresco/io/pose_file.h>
#include <numeric>
#include <pcl/common/transforms.h>
#include <pcl/console/print.h>
#include <pcl/features/fpfh.h>
#include <pcl/features/normal_3d.h>
#include <pcl/filters/filter.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/io/pcd_io.h>
#include <pcl/registration/correspondence_estimation.h>
#include <pcl/registration/elch.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/lum.h>
#include <pcl/registration/sample_consensus_prerejective.h>
#include <stdexcept>
namespace {
using Cloud = pcl::PointCloud<pcl::PointNormal>;
using Features = pcl::PointCloud<pcl::FPFHSignature33>;

struct Options {
  std::string folder, output, graph = "lum";
  float voxel = 0.1f, min_overlap = 0.3f;
  int iterations = 50000;
  float reach() const { return 1.5f * voxel; } ///< of correspondences
};

struct Scan {
  Cloud::Ptr cloud;
  Features::Ptr features;
  pcl::search::KdTree<pcl::PointNormal>::Ptr tree;
  Eigen::Affine3f pose = Eigen::Affine3f::Identity(); ///< world from scan
};

struct Pair {
  std::size_t a, b;
  Eigen::Affine3f T_a_b;
  double overlap; ///< share of b's points
};

Options parse(int argc, char** argv)
{
  Options options;
  fresco::Args args("fresco_benchmark_peer_pcl_global_registration FOLDER POSES.txt [options]",
                    "PCL's registration of the scans FOLDER/*.pcd without start poses, for comparison.");
  args.option("voxel", options.voxel, fresco::Range::above(0), "edge of the cells that keep one point, metres");
  args.option("iterations", options.iterations, fresco::Range::atLeast(1), "of the sample consensus per pair");
  args.option("min_overlap", options.min_overlap, fresco::Range::within(0, 1),
              "share of points with a counterpart from which a pair holds");
  args.option("graph", options.graph, "errors of loops: lum, elch or none");
  const std::vector<std::string> words = args.parse(argc, argv, 2);
  if (options.graph != "lum" && options.graph != "elch" && options.graph != "none")
    throw fresco::UsageError("-graph is lum, elch or none");
  options.folder = words[0];
  options.output = words[1];
  return options;
}

Scan prepare(const std::string& path, const Options& options)
{
  Scan scan{pcl::make_shared<Cloud>(), pcl::make_shared<Features>(),
            pcl::make_shared<pcl::search::KdTree<pcl::PointNormal>>()};
  const auto all = pcl::make_shared<Cloud>();
  if (pcl::io::loadPCDFile(path, *all) < 0)
    throw std::runtime_error(path + ": cannot be read");
  pcl::Indices kept;
  pcl::removeNaNFromPointCloud(*all, *all, kept);
  pcl::VoxelGrid<pcl::PointNormal> grid;
  grid.setInputCloud(all);
  grid.setLeafSize(options.voxel, options.voxel, options.voxel);
  grid.filter(*scan.cloud);
  pcl::NormalEstimation<pcl::PointNormal, pcl::PointNormal> normals;
  normals.setInputCloud(scan.cloud);
  normals.setRadiusSearch(2.0 * options.voxel);
  normals.compute(*scan.cloud);
  pcl::removeNaNNormalsFromPointCloud(*scan.cloud, *scan.cloud, kept);
  pcl::FPFHEstimation<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33> features;
  features.setInputCloud(scan.cloud);
  features.setInputNormals(scan.cloud);
  features.setRadiusSearch(5.0 * options.voxel);
  features.compute(*scan.features);
  scan.tree->setInputCloud(scan.cloud);
  return scan;
}

std::vector<Scan> prepareAll(const Options& options)
{
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(options.folder))
    if (entry.path().extension() == ".pcd")
      paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end());
  std::vector<Scan> scans;
  for (const std::string& path : paths)
    scans.push_back(prepare(path, options));
  if (scans.size() < 2)
    throw std::runtime_error(options.folder + ": fewer than two scans");
  return scans;
}

Eigen::Matrix4f fromFeatures(const Scan& target, const Scan& source, const Options& options)
{
  pcl::SampleConsensusPrerejective<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33> consensus;
  consensus.setInputSource(source.cloud);
  consensus.setInputTarget(target.cloud);
  consensus.setSourceFeatures(source.features);
  consensus.setTargetFeatures(target.features);
  consensus.setMaximumIterations(options.iterations);
  consensus.setNumberOfSamples(3);
  consensus.setCorrespondenceRandomness(5);
  consensus.setSimilarityThreshold(0.9f);
  consensus.setMaxCorrespondenceDistance(options.reach());
  consensus.setInlierFraction(options.min_overlap);
  Cloud aligned;
  consensus.align(aligned);
  return consensus.getFinalTransformation();
}

Pair alignPair(const std::vector<Scan>& scans, std::size_t a, std::size_t b, const Options& options)
{
  const Eigen::Matrix4f guess = fromFeatures(scans[a], scans[b], options);
  pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal> icp;
  icp.setInputSource(scans[b].cloud);
  icp.setInputTarget(scans[a].cloud);
  icp.setMaxCorrespondenceDistance(options.reach());
  icp.setMaximumIterations(30);
  Cloud aligned;
  icp.align(aligned, guess);
  pcl::Indices nearest(1);
  std::vector<float> squared(1);
  double matches = 0.0;
  for (const pcl::PointNormal& point : aligned)
    if (scans[a].tree->nearestKSearch(point, 1, nearest, squared) && squared[0] < options.reach() * options.reach())
      ++matches;
  return {a, b, Eigen::Affine3f(icp.getFinalTransformation()), matches / static_cast<double>(aligned.size())};
}

std::vector<Pair> alignPairs(const std::vector<Scan>& scans, const Options& options)
{
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < scans.size(); ++a)
    for (std::size_t b = a + 1; b < scans.size(); ++b)
      if (const Pair pair = alignPair(scans, a, b, options); pair.overlap > options.min_overlap)
        pairs.push_back(pair);
  std::sort(pairs.begin(), pairs.end(), [](const Pair& p, const Pair& q) { return p.overlap > q.overlap; });
  return pairs;
}

/// Poses by the tree of the best pairs.
/// @return the scans of the largest tree; the first one holds the frame
/// @param tree whether a pair belongs to it
std::vector<std::size_t> spanTree(std::vector<Scan>& scans, const std::vector<Pair>& pairs, std::vector<bool>& tree)
{
  std::vector<std::size_t> root(scans.size());
  std::iota(root.begin(), root.end(), std::size_t{0});
  for (const Pair& pair : pairs) {
    tree.push_back(root[pair.a] != root[pair.b]);
    const Eigen::Affine3f move = scans[pair.a].pose * pair.T_a_b * scans[pair.b].pose.inverse();
    const std::size_t to = root[pair.a], from = root[pair.b];
    for (std::size_t i = 0; tree.back() && i < scans.size(); ++i)
      if (root[i] == from) {
        scans[i].pose = move * scans[i].pose;
        root[i] = to;
      }
  }
  const auto count = [&](std::size_t r) { return std::count(root.begin(), root.end(), r); };
  const auto largest = *std::max_element(root.begin(), root.end(), [&](auto r, auto s) { return count(r) < count(s); });
  std::vector<std::size_t> placed;
  for (std::size_t i = 0; i < scans.size(); ++i)
    if (root[i] == largest)
      placed.push_back(i);
  const Eigen::Affine3f frame = scans[placed[0]].pose.inverse();
  for (const std::size_t i : placed)
    scans[i].pose = frame * scans[i].pose;
  return placed;
}

/// As PCL's tool pcl_lum: correspondences anew before each step.
void closeLoopsByLum(std::vector<Scan>& scans, const std::vector<std::size_t>& placed, const std::vector<Pair>& pairs,
                     const Options& options)
{
  for (int round = 0; round < 10; ++round) {
    pcl::registration::LUM<pcl::PointNormal> lum;
    lum.setMaxIterations(1);
    std::vector<Cloud::Ptr> moved;
    for (const std::size_t i : placed) {
      moved.push_back(pcl::make_shared<Cloud>());
      pcl::transformPointCloudWithNormals(*scans[i].cloud, *moved.back(), scans[i].pose);
      lum.addPointCloud(moved.back());
    }
    for (const Pair& pair : pairs) {
      const auto a = std::lower_bound(placed.begin(), placed.end(), pair.a) - placed.begin(),
                 b = std::lower_bound(placed.begin(), placed.end(), pair.b) - placed.begin();
      if (a == static_cast<long>(placed.size()) || placed[a] != pair.a)
        continue;
      pcl::registration::CorrespondenceEstimation<pcl::PointNormal, pcl::PointNormal> estimation;
      estimation.setInputSource(moved[a]);
      estimation.setInputTarget(moved[b]);
      const auto matches = pcl::make_shared<pcl::Correspondences>();
      estimation.determineCorrespondences(*matches, options.reach());
      if (matches->size() > 2)
        lum.setCorrespondences(a, b, matches);
    }
    lum.compute();
    for (std::size_t i = 1; i < placed.size(); ++i)
      scans[placed[i]].pose = lum.getTransformation(i) * scans[placed[i]].pose;
  }
}

/// Closes a loop with each pair that is not in the tree, the best first.
void closeLoopsByElch(std::vector<Scan>& scans, const std::vector<std::size_t>& placed, const std::vector<Pair>& pairs,
                      const std::vector<bool>& tree)
{
  using Elch = pcl::registration::ELCH<pcl::PointNormal>;
  Elch elch;
  const auto graph = pcl::make_shared<Elch::LoopGraph>(scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i)
    (*graph)[i].cloud = pcl::make_shared<Cloud>(); // what ELCH moves; only its transforms are used
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (tree[k])
      boost::add_edge(pairs[k].a, pairs[k].b, *graph);
  elch.setLoopGraph(graph);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (tree[k] || !std::binary_search(placed.begin(), placed.end(), pairs[k].a))
      continue;
    elch.setLoopStart(pairs[k].a);
    elch.setLoopEnd(pairs[k].b);
    elch.setLoopTransform((scans[pairs[k].a].pose * pairs[k].T_a_b * scans[pairs[k].b].pose.inverse()).matrix());
    elch.compute();
    for (const std::size_t i : placed)
      scans[i].pose = (*graph)[i].transform * scans[i].pose;
  }
}

void run(const Options& options)
{
  pcl::console::setVerbosityLevel(pcl::console::L_ERROR); // fields that a cloud does not have are no news
  std::vector<Scan> scans = prepareAll(options);
  const std::vector<Pair> pairs = alignPairs(scans, options);
  std::vector<bool> tree;
  const std::vector<std::size_t> placed = spanTree(scans, pairs, tree);
  if (options.graph == "lum" && placed.size() > 1)
    closeLoopsByLum(scans, placed, pairs, options);
  else if (options.graph == "elch")
    closeLoopsByElch(scans, placed, pairs, tree);
  std::vector<fresco::Pose> poses(scans.size());
  for (const std::size_t i : placed)
    poses[i] = scans[i].pose.matrix().cast<double>();
  fresco::writePoses(options.output, poses);
}
} // namespace

int main(int argc, char** argv)
{
  return fresco::runTool("fresco_benchmark_peer_pcl_global_registration", [&] { run(parse(argc, argv)); });
}
