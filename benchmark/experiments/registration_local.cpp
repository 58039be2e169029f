// SPDX-License-Identifier: BSD-3-Clause
// Local registration of a pair from a disturbed pose, beside PCL's methods.
#include "experiments/registration_input.h"
#include "support/tool.h"
#include <iomanip>
#include <iostream>
#include <pcl/features/normal_3d.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/registration/gicp.h>
#include <pcl/registration/icp.h>
namespace {
using fresco::Index;
using fresco::benchmark::errorOf;
using fresco::benchmark::PoseError;
using fresco::benchmark::processorSeconds;
using fresco::benchmark::RegistrationInput;
using Cloud = pcl::PointCloud<pcl::PointNormal>;

/// What one method makes of disturbed poses.
struct Trial {
  std::string name;
  double preparation = 0.0;                                                 ///< processor seconds, of both scans
  std::function<Eigen::Isometry3d(const Eigen::Isometry3d&, double)> align; ///< from a guess, with a reach
};

struct Start {
  double distance, degrees; ///< off the true pose
  double reach;             ///< of correspondences, metres
  int count;                ///< of starts
};

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

void measureTrial(const RegistrationInput& input, const Trial& trial, const Start& start)
{
  fresco::benchmark::Disturbances disturbances(start.distance, start.degrees);
  double spent = 0.0, worst = 0.0, sum = 0.0;
  int good = 0;
  for (int k = 0; k < start.count; ++k) {
    const Eigen::Isometry3d guess = input.relative(0, 1) * disturbances.next();
    const double before = processorSeconds();
    const Eigen::Isometry3d found = trial.align(guess, start.reach);
    spent += processorSeconds() - before;
    const PoseError error = errorOf(found, input.relative(0, 1), input.middles[1]);
    const bool ok = error.distance < 0.05 && error.degrees < 1.0;
    good += ok ? 1 : 0;
    sum += ok ? error.distance : 0.0;
    worst = ok ? std::max(worst, error.distance) : worst;
  }
  spent /= start.count;
  std::cout << std::left << std::setw(38) << trial.name << std::right << std::setw(9) << trial.preparation
            << std::setw(9) << spent << std::setw(9) << trial.preparation + spent << std::setw(6) << good << " of "
            << start.count << std::setw(10) << (good > 0 ? 1000.0 * sum / good : NAN) << std::setw(9) << 1000.0 * worst
            << '\n'
            << std::flush;
}

template <typename Method>
Trial pclTrial(const std::string& name, const RegistrationInput& input, float voxel)
{
  const double before = processorSeconds();
  const Cloud::Ptr target = toCloud(input.scans[0], voxel), source = toCloud(input.scans[1], voxel);
  return {name + (voxel > 0.f ? ", thinned" : ", all points"), processorSeconds() - before,
          [=](const Eigen::Isometry3d& guess, double reach) {
            Method method;
            method.setInputSource(source);
            method.setInputTarget(target);
            method.setMaxCorrespondenceDistance(reach);
            method.setMaximumIterations(50);
            Cloud aligned;
            method.align(aligned, guess.matrix().cast<float>());
            return Eigen::Isometry3d(method.getFinalTransformation().template cast<double>());
          }};
}

std::vector<Trial> trials(const RegistrationInput& input, bool all_points)
{
  const double before = processorSeconds();
  const auto target = fresco::prepareForRegistration(input.scans[0], input.voxel),
             source = fresco::prepareForRegistration(input.scans[1], input.voxel);
  std::vector<Trial> list = {
      {"fresco point-to-plane", processorSeconds() - before, [=](const Eigen::Isometry3d& guess, double reach) {
         fresco::PointToPlaneOptions options;
         options.max_distance = static_cast<float>(reach);
         return Eigen::Isometry3d(fresco::alignPointToPlane(*source, *target, guess.matrix(), options).T_target_source);
       }}};
  using PointToPlane = pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal>;
  using PointToPoint = pcl::IterativeClosestPoint<pcl::PointNormal, pcl::PointNormal>;
  using Generalized = pcl::GeneralizedIterativeClosestPoint<pcl::PointNormal, pcl::PointNormal>;
  for (const float voxel : {input.voxel, 0.f}) {
    if (!(voxel > 0.f) && !all_points)
      break;
    list.push_back(pclTrial<PointToPlane>("PCL ICP, point-to-plane", input, voxel));
    list.push_back(pclTrial<PointToPoint>("PCL ICP, point-to-point", input, voxel));
    list.push_back(pclTrial<Generalized>("PCL GICP", input, voxel));
  }
  return list;
}

void run(int argc, char** argv)
{
  fresco::Args args(
      "fresco_benchmark_registration_local TRUTH.txt SCAN SCAN",
      "Aligns two scans from disturbed poses, beside PCL's methods. Processor seconds; preparation is that\n"
      "of both scans (thinning, normals, search trees), errors are those of the runs that ended right.\n"
      "TRUTH.txt: world from scan, one pose for each SCAN.");
  int count = 5;
  bool all_points = false;
  args.option("starts", count, "disturbed poses, at least 1");
  args.flag("all_points", all_points, "PCL's methods also on all points");
  const RegistrationInput input = fresco::benchmark::readRegistrationInput(args.parse(argc, argv, 3, 3));
  std::cout << std::setprecision(3) << input.scans[0].size() << " and " << input.scans[1].size() << " points\n";
  const std::vector<Trial> list = trials(input, all_points);
  for (const Start& start : {Start{0.3, 15.0, 0.5, count}, Start{0.05, 3.0, 0.2, count}}) {
    std::cout << "from " << start.distance << " m and " << start.degrees << " degrees off\n"
              << std::left << std::setw(38) << "method" << std::right << std::setw(9) << "prepare" << std::setw(9)
              << "align" << std::setw(9) << "total" << std::setw(11) << "right" << std::setw(9) << "mean mm"
              << std::setw(9) << "worst\n";
    for (const Trial& trial : list)
      measureTrial(input, trial, start);
  }
}
} // namespace

int main(int argc, char** argv)
{
  return fresco::runTool("fresco_benchmark_registration_local", [&] { run(argc, argv); });
}
