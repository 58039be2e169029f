// SPDX-License-Identifier: BSD-3-Clause
#include "support/scan_option.h"
#include "support/tool.h"
#include <fresco/alignment/core/camera_alignment.h>
#include <fresco/core/constants.h>
#include <fresco/core/require.h>
#include <fresco/io/camera_files.h>
#include <fresco/io/colmap.h>
#include <fresco/io/formats.h>
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_io.h>
#include <fresco/surface/core/surface_samples.h>
namespace {
using namespace fresco;

/// Points of a cloud, or spread over a mesh.
PointSet readSurface(const std::string& path, int threads)
{
  constexpr Index samples = 400000; // finer than what the sparse points are compared with
  if (!isReadable(path, FileKind::mesh))
    return readPoints(path);
  const TriangleMesh mesh = readMesh(path);
  if (mesh.faceCount() == 0)
    return readPoints(path);
  const SurfaceSamples spread = sampleSurface(mesh, samples, 1, threads);
  PointSet set;
  set.origin = mesh.origin;
  set.points = spread.points.cast<float>();
  if (mesh.colors.cols() > 0) {
    set.colors.resize(3, spread.faces.size());
    for (Index i = 0; i < spread.faces.size(); ++i)
      set.colors.col(i) = mesh.colors.col(mesh.faces(0, spread.faces[i]));
  }
  return set;
}

void run(int argc, char** argv)
{
  CameraAlignmentOptions options;
  CommonOptions common;
  std::string images;
  Args args("fresco_align CAMERAS MESH_OR_CLOUD OUT_CAMERAS_DIR [options]",
            "Brings the cameras of photographs, in a frame and scale of their own, into the frame of scans.\n"
            "CAMERAS, with points: " +
                cameraFormats() +
                ".\nOUT_CAMERAS_DIR gets a COLMAP model as text.\n"
                "Cameras that stand in the frame of the scans already are written as they are.");
  args.option("images", images,
              "folder of the photographs: they are matched with the colours or intensities of the cloud, which finds "
              "places that shape alone does not tell");
  args.option("min_support", options.min_support, Range::above(0).atMost(1),
              "least share of the sparse points on the surface and in sight of their cameras");
  args.option("max_alias", options.max_alias, Range::above(0).atMost(1),
              "most that a second place may reach of the score of the best, else it is ambiguous");
  declareColumns(args);
  common.declare(args);
  args.note("Example: fresco_align room/cameras mesh.ply aligned");
  const auto files = args.parse(argc, argv, 3);
  requireDistinct({files[2]}, {files[0], files[1]});
  options.threads = common.threads;
  CameraFile cameras = readCameraFile(files[0], images);
  CameraSet& set = cameras.set;
  SparsePoints& points = cameras.points;
  if (points.empty())
    throw std::runtime_error(files[0] + ": no sparse points in it (of COLMAP: points3D.txt or points3D.bin)");
  const PointSet surface = readSurface(files[1], common.threads);
  if (!images.empty())
    options.photograph = [&](Index view) {
      return readImage(images + "/" + set.views[view].image, set.cameras[set.views[view].camera]);
    };
  CameraAlignmentResult result;
  try {
    result = alignCameras(set, points, surface, options, printProgress(common.quiet));
  } catch (const Cancelled&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(files[0] + ": " + error.what());
  }
  const Similarity& T = result.T_scans_cameras;
  transformCameras(T, set, points);
  writeOutputs([&] { writeColmap(files[2], set, points); });
  if (result.already_aligned)
    inform(common.quiet, "the cameras stand in the frame of the scans already");
  else
    inform(common.quiet, format("scale %.6g, turned by %.2f degrees, shifted by %.6g", T.scale,
                                Eigen::AngleAxisd(T.R).angle() * degrees_per_radian, T.t.norm()));
  if (result.matches > 0)
    inform(common.quiet, concat(result.matches, " matches between photographs and scans agree"));
  inform(
      common.quiet,
      format(
          "%.1f %% of the sparse points on the surface (rms %.3g), %.1f %% behind it; next best place: %.0f %% of that",
          100 * result.support, result.rms, 100 * result.blocked, 100 * result.alias));
}
} // namespace

int main(int argc, char** argv)
{
  return fresco::runTool("fresco_align", [&] { run(argc, argv); });
}
