// SPDX-License-Identifier: BSD-3-Clause
// Local registration of a pair from a disturbed pose, beside PCL's methods and small_gicp.
#include "experiments/registration_input.h"
#include "support/tool.h"
#include <iomanip>
#include <iostream>
#include <pcl/features/normal_3d.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/registration/gicp.h>
#include <pcl/registration/icp.h>
#ifdef FRESCO_SMALL_GICP
#include <small_gicp/registration/registration_helper.hpp>
#endif
namespace {
using fresco::Index;
using fresco::benchmark::errorOf;
using fresco::benchmark::PoseError;
using fresco::benchmark::processorSeconds;
using fresco::benchmark::RegistrationInput;
using Cloud = pcl::PointCloud<pcl::PointNormal>;

using Align = std::function<Eigen::Isometry3d(const Eigen::Isometry3d&, double)>; ///< from a guess, with a reach

/// Seconds of a stage.
struct Seconds {
  double processor = 0.0, wall = 0.0;
};

struct Method {
  std::string name;
  std::function<Align()> prepare; ///< both scans: thinning, normals, search trees
  Seconds preparing{}, aligning{};
  int right = 0;
  double sum = 0.0, worst = 0.0; ///< errors of the starts that ended right, metres
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

template <typename Body>
auto timed(Seconds& seconds, const Body& body)
{
  const double processor = processorSeconds();
  const auto wall = std::chrono::steady_clock::now();
  auto result = body();
  seconds.processor += processorSeconds() - processor;
  seconds.wall += std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count();
  return result;
}

void tryMethod(const RegistrationInput& input, const Eigen::Isometry3d& guess, double reach, Method& method)
{
  const Align align = timed(method.preparing, method.prepare);
  const Eigen::Isometry3d found = timed(method.aligning, [&] { return align(guess, reach); });
  const PoseError error = errorOf(found, input.relative(0, 1), input.middles[1]);
  if (!(error.distance < 0.05 && error.degrees < 1.0))
    return;
  ++method.right;
  method.sum += error.distance;
  method.worst = std::max(method.worst, error.distance);
}

void print(const Method& method, int count)
{
  std::cout << std::left << std::setw(36) << method.name << std::right;
  for (const Seconds& s : {method.preparing, method.aligning})
    std::cout << std::setw(9) << s.processor / count << std::setw(9) << s.wall / count;
  std::cout << std::setw(9) << (method.preparing.processor + method.aligning.processor) / count << std::setw(6)
            << method.right << " of " << count << std::setw(10)
            << (method.right > 0 ? 1000.0 * method.sum / method.right : NAN) << std::setw(9) << 1000.0 * method.worst
            << '\n'
            << std::flush;
}

/// All methods from each start, every other time in reverse order.
void measure(const RegistrationInput& input, std::vector<Method> methods, const Start& start)
{
  fresco::benchmark::Disturbances disturbances(start.distance, start.degrees);
  for (int k = 0; k < start.count; ++k) {
    const Eigen::Isometry3d guess = input.relative(0, 1) * disturbances.next();
    for (std::size_t m = 0; m < methods.size(); ++m)
      tryMethod(input, guess, start.reach, methods[k % 2 == 0 ? m : methods.size() - 1 - m]);
  }
  for (const Method& method : methods)
    print(method, start.count);
}

Method frescoMethod(const RegistrationInput& input, int threads)
{
  return {"fresco point-to-plane", [&input, threads]() -> Align {
            const auto target = fresco::prepareForRegistration(input.scans[0], input.voxel, threads),
                       source = fresco::prepareForRegistration(input.scans[1], input.voxel, threads);
            return [=](const Eigen::Isometry3d& guess, double reach) {
              fresco::PointToPlaneOptions options;
              options.max_distance = static_cast<float>(reach);
              options.threads = threads;
              const auto result = fresco::alignPointToPlane(*source, *target, guess.matrix(), options);
              return Eigen::Isometry3d(result.T_target_source);
            };
          }};
}

template <typename Registration>
Method pclMethod(const std::string& name, const RegistrationInput& input, float voxel)
{
  return {name + (voxel > 0.f ? ", thinned alike" : ", all points"), [&input, voxel]() -> Align {
            const Cloud::Ptr target = toCloud(input.scans[0], voxel), source = toCloud(input.scans[1], voxel);
            return [=](const Eigen::Isometry3d& guess, double reach) {
              Registration registration;
              registration.setInputSource(source);
              registration.setInputTarget(target);
              registration.setMaxCorrespondenceDistance(reach);
              registration.setMaximumIterations(50);
              Cloud aligned;
              registration.align(aligned, guess.matrix().cast<float>());
              return Eigen::Isometry3d(registration.getFinalTransformation().template cast<double>());
            };
          }};
}

#ifdef FRESCO_SMALL_GICP
/// GICP with the library's own criteria.
/// @param voxel edge of the thinning cells
Method smallGicpMethod(const RegistrationInput& input, float voxel, int threads)
{
  const auto prepared = [voxel, threads](const fresco::PointSet& scan) {
    std::vector<Eigen::Vector3f> points;
    for (Index i = 0; i < scan.size(); ++i)
      if (scan.points.col(i).allFinite())
        points.push_back(scan.points.col(i));
    return small_gicp::preprocess_points(points, voxel, 10, threads);
  };
  return {fresco::concat("small_gicp, cells of ", voxel), [=, &input]() -> Align {
            const auto target = prepared(input.scans[0]), source = prepared(input.scans[1]);
            return [=](const Eigen::Isometry3d& guess, double reach) {
              small_gicp::RegistrationSetting setting;
              setting.max_correspondence_distance = reach;
              setting.num_threads = threads;
              setting.max_iterations = 50;
              return small_gicp::align(*target.first, *source.first, *target.second, guess, setting).T_target_source;
            };
          }};
}
#endif

std::vector<Method> methodsFor(const RegistrationInput& input, bool all_points, int threads)
{
  std::vector<Method> list = {frescoMethod(input, threads)};
#ifdef FRESCO_SMALL_GICP
  for (const float voxel : {input.voxel, 0.1f, 0.25f}) // 0.25: its default
    list.push_back(smallGicpMethod(input, voxel, threads));
#endif
  using PointToPlane = pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal>;
  using PointToPoint = pcl::IterativeClosestPoint<pcl::PointNormal, pcl::PointNormal>;
  using Generalized = pcl::GeneralizedIterativeClosestPoint<pcl::PointNormal, pcl::PointNormal>;
  for (const float voxel : {input.voxel, 0.f}) {
    if (!(voxel > 0.f) && !all_points)
      break;
    list.push_back(pclMethod<PointToPlane>("PCL ICP, point-to-plane", input, voxel));
    list.push_back(pclMethod<PointToPoint>("PCL ICP, point-to-point", input, voxel));
    list.push_back(pclMethod<Generalized>("PCL GICP", input, voxel));
  }
  return list;
}

void run(int argc, char** argv)
{
  fresco::Args args("fresco_benchmark_registration_local TRUTH.txt SCAN SCAN",
                    "Aligns two scans from disturbed poses, beside PCL's methods and small_gicp where it was found. "
                    "Processor and wall\n"
                    "seconds of a start; preparation is that of both scans (thinning, normals, search trees), errors "
                    "are those of the\n"
                    "starts that ended right. TRUTH.txt: world from scan, one pose for each SCAN.");
  int count = 5, threads = 1;
  bool all_points = false;
  std::string only;
  args.option("starts", count, fresco::Range::atLeast(1), "disturbed poses");
  args.option("threads", threads, fresco::Range::atLeast(1), "of fresco and small_gicp; PCL's methods have one");
  args.option("only", only, "methods whose names begin so; empty = all");
  args.flag("all_points", all_points, "PCL's methods also on all points");
  const RegistrationInput input = fresco::benchmark::readRegistrationInput(args.parse(argc, argv, 3, 3));
  std::cout << std::setprecision(3) << input.scans[0].size() << " and " << input.scans[1].size() << " points, cells of "
            << input.voxel << " m\n";
  std::vector<Method> methods = methodsFor(input, all_points, threads);
  methods.erase(
      std::remove_if(methods.begin(), methods.end(), [&](const Method& m) { return m.name.rfind(only, 0) != 0; }),
      methods.end());
  for (const Start& start : {Start{0.3, 15.0, 0.5, count}, Start{0.05, 3.0, 0.2, count}}) {
    std::cout << "from " << start.distance << " m and " << start.degrees << " degrees off\n"
              << std::left << std::setw(36) << "method" << std::right << std::setw(18) << "prepare: cpu wall"
              << std::setw(18) << "align: cpu wall" << std::setw(9) << "cpu" << std::setw(11) << "right" << std::setw(9)
              << "mean mm" << std::setw(9) << "worst\n";
    measure(input, methods, start);
  }
}
} // namespace

int main(int argc, char** argv)
{
  return fresco::runTool("fresco_benchmark_registration_local", [&] { run(argc, argv); });
}
