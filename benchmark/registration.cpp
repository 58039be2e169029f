// SPDX-License-Identifier: BSD-3-Clause
// Registration of pairs against known poses: from features (pairs), and from a disturbed pose beside PCL (local).
#include "pair_alignment.h"
#include "support/tool.h"
#include <chrono>
#include <ctime>
#include <fresco/common/point_io.h>
#include <fresco/common/poses.h>
#include <fresco/common/require.h>
#include <fresco/registration/core/point_to_plane_registration.h>
#include <iomanip>
#include <iostream>
#include <pcl/features/normal_3d.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/registration/gicp.h>
#include <pcl/registration/icp.h>
#include <random>
namespace {
using fresco::Index;
using Cloud = pcl::PointCloud<pcl::PointNormal>;

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

double processorSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct PoseError {
  double distance = 0.0, degrees = 0.0;
};

/// @param middle point of the moved scan at which the distance is taken
PoseError errorOf(const Eigen::Isometry3d& found, const Eigen::Isometry3d& truth, const Eigen::Vector3d& middle)
{
  return {(found * middle - truth * middle).norm(),
          Eigen::AngleAxisd(truth.linear().transpose() * found.linear()).angle() * 180.0 / M_PI};
}

struct Input {
  std::vector<fresco::PointSet> scans;
  std::vector<Eigen::Isometry3d, Eigen::aligned_allocator<Eigen::Isometry3d>> truth;
  std::vector<Eigen::Vector3d> middles;
  float voxel = 0.f;
};

Input readInput(const std::vector<std::string>& words)
{
  Input input;
  const auto poses = fresco::readPoses(words[1]);
  for (std::size_t i = 2; i < words.size(); ++i) {
    input.scans.push_back(fresco::readPoints(words[i]));
    input.truth.emplace_back(*poses.at(i - 2));
    input.voxel = std::max(input.voxel, fresco::registrationVoxel(input.scans.back()));
    input.middles.push_back(input.scans.back().points.cast<double>().rowwise().mean());
  }
  return input;
}

/// Counts of one class of overlap.
struct Class {
  double least = 0.0;
  int pairs = 0, right = 0, certain_right = 0, certain_wrong = 0;
};

void measurePairs(const Input& input)
{
  const double start = processorSeconds();
  std::vector<fresco::PreparedScan> scans;
  std::vector<fresco::ScanFeatures> features;
  for (const fresco::PointSet& scan : input.scans) {
    scans.push_back(fresco::prepareScan(scan, input.voxel, 0));
    features.push_back(fresco::describeScan(scans.back(), {}));
  }
  const double prepared = processorSeconds();
  std::vector<Class> classes = {{0.5}, {0.3}, {0.1}, {0.0}};
  int tried = 0;
  double aligning = 0.0;
  for (std::size_t a = 0; a < scans.size(); ++a)
    for (std::size_t b = a + 1; b < scans.size(); ++b, ++tried) {
      const double before = processorSeconds();
      const auto pair = fresco::alignPair(scans[a], scans[b], features[a], features[b], {});
      aligning += processorSeconds() - before;
      const Eigen::Isometry3d truth = input.truth[a].inverse() * input.truth[b];
      const Eigen::Isometry3d T_a(Eigen::Translation3d(scans[a].center)), T_b(Eigen::Translation3d(scans[b].center));
      const double overlap =
          fresco::checkPair(scans[a], scans[b], T_a.inverse() * truth * T_b, fresco::check_level).overlap;
      Class& own = *std::find_if(classes.begin(), classes.end(), [&](const Class& c) { return overlap >= c.least; });
      ++own.pairs;
      if (pair.modes.empty())
        continue;
      const PoseError error = errorOf(T_a * pair.modes[0].T_a_b * T_b.inverse(), truth, input.middles[b]);
      const bool right = error.distance < 0.2 && error.degrees < 6.0, certain = !pair.ambiguous;
      own.right += right ? 1 : 0;
      own.certain_right += right && certain ? 1 : 0;
      own.certain_wrong += !right && certain ? 1 : 0;
    }
  std::cout << "overlap  pairs  right  held certain: right  wrong\n";
  for (const Class& c : classes)
    std::cout << "> " << std::setw(3) << 100.0 * c.least << " %  " << std::setw(5) << c.pairs << "  " << std::setw(5)
              << c.right << "  " << std::setw(19) << c.certain_right << "  " << std::setw(5) << c.certain_wrong << '\n';
  std::cout << "processor time: preparation " << (prepared - start) / static_cast<double>(scans.size())
            << " s a scan, alignment " << aligning / tried << " s a pair\n";
}

Cloud::Ptr toCloud(const fresco::PointSet& scan, float voxel)
{
  Cloud::Ptr cloud(new Cloud);
  for (Index i = 0; i < scan.size(); ++i)
    if (scan.points.col(i).allFinite()) {
      pcl::PointNormal point;
      point.getVector3fMap() = scan.points.col(i);
      cloud->push_back(point);
    }
  if (voxel > 0.f) {
    Cloud::Ptr thinned(new Cloud);
    pcl::VoxelGrid<pcl::PointNormal> grid;
    grid.setInputCloud(cloud);
    grid.setLeafSize(voxel, voxel, voxel);
    grid.filter(*thinned);
    cloud = thinned;
  }
  pcl::NormalEstimation<pcl::PointNormal, pcl::PointNormal> normals;
  normals.setInputCloud(cloud);
  normals.setKSearch(16);
  normals.compute(*cloud);
  return cloud;
}

/// What one method makes of the disturbed poses.
struct Trial {
  std::string name;
  std::function<Eigen::Isometry3d(const Eigen::Isometry3d&)> align;
};

void measureTrial(const Input& input, const Trial& trial, int count)
{
  std::mt19937 random(1);
  const auto unit = [&] {
    Eigen::Vector3d v;
    do
      v = Eigen::Vector3d(random() / 2147483648.0 - 1.0, random() / 2147483648.0 - 1.0, random() / 2147483648.0 - 1.0);
    while (v.norm() > 1.0 || v.norm() < 0.1);
    return Eigen::Vector3d(v.normalized());
  };
  const Eigen::Isometry3d truth = input.truth[0].inverse() * input.truth[1];
  double wall = 0.0, worst = 0.0;
  int good = 0;
  for (int k = 0; k < count; ++k) {
    const Eigen::Vector3d shift = unit(), axis = unit();
    const Eigen::Isometry3d guess =
        truth * Eigen::Translation3d(0.3 * shift) * Eigen::AngleAxisd(15.0 * M_PI / 180.0, axis);
    const double before = seconds();
    const PoseError error = errorOf(trial.align(guess), truth, input.middles[1]);
    wall += seconds() - before;
    const bool ok = error.distance < 0.05 && error.degrees < 1.0;
    good += ok ? 1 : 0;
    worst = ok ? std::max(worst, error.distance) : worst;
  }
  std::cout << std::left << std::setw(34) << trial.name << std::right << std::setw(8) << wall / count << " s  " << good
            << " of " << count << " right, worst of them " << 1000.0 * worst << " mm\n";
}

template <typename Method>
Trial pclTrial(const std::string& name, const Cloud::Ptr& source, const Cloud::Ptr& target)
{
  return {name, [=](const Eigen::Isometry3d& guess) {
            Method method;
            method.setInputSource(source);
            method.setInputTarget(target);
            method.setMaxCorrespondenceDistance(0.5);
            method.setMaximumIterations(50);
            Cloud aligned;
            method.align(aligned, guess.matrix().cast<float>());
            return Eigen::Isometry3d(method.getFinalTransformation().template cast<double>());
          }};
}

void measureLocal(const Input& input)
{
  const double before = seconds();
  const auto target = fresco::prepareForRegistration(input.scans[0], input.voxel),
             source = fresco::prepareForRegistration(input.scans[1], input.voxel);
  std::cout << input.scans[0].size() << " and " << input.scans[1].size() << " points, preparation "
            << (seconds() - before) / 2.0 << " s a scan; wall time a pair:\n";
  measureTrial(input,
               {"fresco point-to-plane",
                [&](const Eigen::Isometry3d& guess) {
                  return Eigen::Isometry3d(fresco::alignPointToPlane(*source, *target, guess.matrix()).T_target_source);
                }},
               40);
  for (const float voxel : {input.voxel, 0.f}) {
    const Cloud::Ptr a = toCloud(input.scans[0], voxel), b = toCloud(input.scans[1], voxel);
    const std::string points = voxel > 0.f ? " (thinned)" : " (all points)";
    const int count = voxel > 0.f ? 5 : 1;
    using PointToPlane = pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal>;
    using PointToPoint = pcl::IterativeClosestPoint<pcl::PointNormal, pcl::PointNormal>;
    using Generalized = pcl::GeneralizedIterativeClosestPoint<pcl::PointNormal, pcl::PointNormal>;
    measureTrial(input, pclTrial<PointToPlane>("PCL ICP point-to-plane" + points, b, a), count);
    measureTrial(input, pclTrial<PointToPoint>("PCL ICP point-to-point" + points, b, a), count);
    measureTrial(input, pclTrial<Generalized>("PCL GICP" + points, b, a), count);
  }
}

void run(int argc, char** argv)
{
  fresco::Args args("bench_registration pairs|local TRUTH.txt SCAN SCAN...",
                    "pairs: aligns each pair of scans from features; counts by overlap how many are right.\n"
                    "local: aligns the first two from 0.3 m and 15 degrees off, beside PCL's methods.\n"
                    "TRUTH.txt: world from scan, one pose for each SCAN, in their order.");
  const std::vector<std::string> words = args.parse(argc, argv, 4, 100000);
  const Input input = readInput(words);
  std::cout << std::setprecision(3);
  if (words[0] == "pairs")
    measurePairs(input);
  else if (words[0] == "local")
    measureLocal(input);
  else
    throw fresco::UsageError("the first word is pairs or local");
}
} // namespace

int main(int argc, char** argv)
{
  return fresco::runTool("bench_registration", [&] { run(argc, argv); });
}
