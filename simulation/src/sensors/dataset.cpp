// SPDX-License-Identifier: BSD-3-Clause
#include "sensors/rgbd_walk.h"
#include "sensors/sparse.h"
#include <filesystem>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/io/colmap.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_io.h>
#include <fresco/io/pose_file.h>
#include <fresco/simulation/scene/labels.h>
#include <fresco/simulation/sensors/dataset.h>
#include <fresco/simulation/sensors/random.h>
#include <fresco/simulation/sensors/survey.h>
#include <fresco/simulation/sensors/views.h>
#include <iomanip>
#include <optional>
namespace fresco::simulation {
using Eigen::Vector3f;

namespace {
void validate(const DatasetOptions& o)
{
  require(o.stations >= 1 && o.stations <= 1000, "stations ", o.stations, " is not in 1..1000");
  require(o.views >= 0 && o.views <= 100000, "views ", o.views, " is not in 0..100000");
  require(o.width >= 16 && o.width <= 20000 && o.height >= 16 && o.height <= 20000, "image size ", o.width, "x",
          o.height, " is not in 16..20000");
  require(o.panorama_height >= 8 && o.panorama_height <= 10000, "panorama height ", o.panorama_height,
          " is not in 8..10000");
  require(o.focal > 0.1 && o.focal < 100.0, "focal length ", o.focal, " is not in 0.1..100 image widths");
  require(o.exposure_spread >= 0.f && o.exposure_spread <= 0.9f, "exposure spread ", o.exposure_spread,
          " is not in 0..0.9");
  require(o.sensor_noise >= 0.f && o.sensor_noise <= 100.f, "sensor noise ", o.sensor_noise, " is not in 0..100");
  require(o.vignetting >= 0.1f && o.vignetting <= 1.f, "vignetting ", o.vignetting, " is not in 0.1..1");
  require(o.response >= 0.f && o.response <= 1.f, "response ", o.response, " is not in 0..1");
  require(o.blur >= 0.f && o.blur <= 20.f, "blur ", o.blur, " is not in 0..20");
  require(o.intruder >= 0, "intruder ", o.intruder, " is negative");
  require(o.pose_noise >= 0 && o.pose_noise <= 1, "pose noise ", o.pose_noise, " is not in 0..1");
  require(o.turn_noise >= 0 && o.turn_noise <= 10, "turn noise ", o.turn_noise, " is not in 0..10");
  require(o.photographed >= 0.05 && o.photographed <= 1, "photographed ", o.photographed, " is not in 0.05..1");
  require(o.sparse >= 0 && o.own_frame >= 0, "sparse ", o.sparse, " or own_frame ", o.own_frame, " is negative");
  require(o.sparse_noise >= 0 && o.sparse_noise <= 1, "sparse noise ", o.sparse_noise, " is not in 0..1");
  require(o.sparse_outliers >= 0 && o.sparse_outliers <= 1, "outliers ", o.sparse_outliers, " are not in 0..1");
  require(o.rgbd_frames >= 0 && o.rgbd_frames <= 100000, "RGB-D frames ", o.rgbd_frames, " is not in 0..100000");
  require(o.rgbd_width >= 16 && o.rgbd_width <= 20000 && o.rgbd_height >= 16 && o.rgbd_height <= 20000,
          "RGB-D image size ", o.rgbd_width, "x", o.rgbd_height, " is not in 16..20000");
  require(o.jpeg_quality >= 1 && o.jpeg_quality <= 100, "JPEG quality ", o.jpeg_quality, " is not in 1..100");
}

/// One run: the scene with its light, and where its files go.
struct Run {
  const LitScene& lit;
  std::string folder;
  const DatasetOptions& options;
};

/// Turns the frame of a scan arbitrarily: any rotation is as likely. World from scan, as turned.
Eigen::Matrix4d turnFrame(LaserScan& scan, const Eigen::Matrix4d& T_world_scan, CounterRandom random)
{
  const double w = random.gaussian(), x = random.gaussian(), y = random.gaussian(), z = random.gaussian();
  const Eigen::Matrix3d R = Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
  scan.points.points = (R.transpose() * scan.points.points.cast<double>()).cast<float>().eval();
  Eigen::Matrix4d T = T_world_scan;
  T.topLeftCorner<3, 3>() *= R;
  return T;
}

/// Scans from all stations; counts returns per face.
std::vector<Pose> writeScans(const Run& run, const Points& stations, std::vector<int>& returns,
                             const Progress& progress)
{
  const std::string folder = run.folder + "/scans";
  makeFolder(folder);
  std::vector<Pose> poses;
  std::optional<TriangleTree> surfaces;
  if (run.options.labels)
    surfaces.emplace(run.lit.scene.mesh, run.options.threads);
  for (int k = 0; k < stations.cols(); ++k) {
    report(progress, "scan " + std::to_string(k + 1) + " of " + std::to_string(stations.cols()),
           static_cast<double>(k) / stations.cols());
    const Eigen::Vector3d station = stations.col(k).cast<double>() + run.lit.scene.mesh.origin;
    Eigen::Matrix4d pose = randomPose(station, run.options.seed, k);
    LaserOptions laser = run.options.laser;
    laser.seed = run.options.seed;
    laser.threads = run.options.threads;
    LaserScan scan = scanScene(run.lit, pose, laser, k);
    if (scan.points.size() == 0)
      throw std::runtime_error("scan " + std::to_string(k) +
                               " has no point: nothing sends enough light back within the range");
    if (run.options.turned)
      pose = turnFrame(scan, pose, CounterRandom(run.options.seed, 82, k));
    for (const int face : scan.faces)
      ++returns[face];
    const std::string file = concat(folder, "/scan_", std::setfill('0'), std::setw(2), k, ".pcd");
    if (surfaces) {
      Eigen::Matrix4d T_truth_scan = pose;
      T_truth_scan.topRightCorner<3, 1>() -= run.lit.scene.mesh.origin;
      writeLabelledScan(file, scan.points, labelPoints(scan, *surfaces, T_truth_scan));
    } else {
      writePoints(file, scan.points);
    }
    poses.emplace_back(pose);
  }
  return poses;
}

/// The scene's triangles with mean colours and counts of laser points.
void writeTruth(const Run& run, const std::vector<int>& returns)
{
  const Scene& scene = run.lit.scene;
  TriangleMesh mesh = scene.mesh;
  Eigen::Matrix3Xf sum = Eigen::Matrix3Xf::Zero(3, mesh.vertexCount());
  Eigen::VectorXf weight = Eigen::VectorXf::Zero(mesh.vertexCount()), seen = Eigen::VectorXf::Zero(mesh.vertexCount());
  for (Index f = 0; f < mesh.faceCount(); ++f)
    for (int k = 0; k < 3; ++k) {
      const RayHit corner{static_cast<int>(f), 0.f, k == 1 ? 1.f : 0.f, k == 2 ? 1.f : 0.f};
      sum.col(mesh.faces(k, f)) += surfaceColor(run.lit, corner, 0.02f);
      weight[mesh.faces(k, f)] += 1.f;
      seen[mesh.faces(k, f)] += returns[f];
    }
  mesh.colors.resize(3, mesh.vertexCount());
  for (Index v = 0; v < mesh.vertexCount(); ++v)
    mesh.colors.col(v) = (255.f * sum.col(v) / std::max(weight[v], 1.f)).array().round().cast<std::uint8_t>();
  mesh.fields["returns"] = seen;
  writeMesh(run.folder + "/truth.ply", mesh);
}

void writePhotographs(const Run& run, const CameraSet& set, const Progress& progress)
{
  const DatasetOptions& o = run.options;
  makeFolder(run.folder + "/images");
  if (o.truth_images)
    makeFolder(run.folder + "/truth_images");
  OutputFile gains(run.folder + "/exposures.txt");
  gains.write("# image, factors of red, green and blue on the true display values\n");
  for (std::size_t k = 0; k < set.views.size(); ++k) {
    report(progress, "photograph " + std::to_string(k + 1) + " of " + std::to_string(set.views.size()),
           static_cast<double>(k) / set.views.size());
    const View& view = set.views[k];
    Exposure exposure = randomExposure(o.seed, k, o.exposure_spread);
    exposure.noise = o.sensor_noise;
    exposure.corner = o.vignetting;
    exposure.blur = o.blur;
    exposure.response = o.response;
    Shot shot{set.cameras[0], view, exposure};
    if (o.intruder > 0 && (k + 1) % o.intruder == 0)
      shot.intruder = intruderBefore(run.lit, view);
    writeImage(run.folder + "/images/" + view.image, takePhotograph(run.lit, shot, o.threads), o.jpeg_quality);
    if (o.truth_images) {
      Exposure exact;
      exact.response = o.response;
      writeImage(run.folder + "/truth_images/" + std::filesystem::path(view.image).replace_extension(".png").string(),
                 takePhotograph(run.lit, {set.cameras[0], view, exact}, o.threads));
    }
    gains.write(concat(view.image, ' ', exposure.gain[0], ' ', exposure.gain[1], ' ', exposure.gain[2], '\n'));
  }
  gains.commit();
}

/// Cameras as somebody measured them who was a little wrong.
CameraSet misplaced(CameraSet set, const DatasetOptions& o)
{
  for (std::size_t k = 0; k < set.views.size(); ++k) {
    CounterRandom random(o.seed, 67, k);
    const auto vector = [&](double deviation) {
      const double x = random.gaussian(), y = random.gaussian(), z = random.gaussian();
      return Eigen::Vector3d(deviation * Eigen::Vector3d(x, y, z));
    };
    const Eigen::Vector3d shift = vector(o.pose_noise), turn = vector(o.turn_noise * pi / 180);
    Eigen::Isometry3d& T = set.views[k].T_camera_world;
    T = T * Eigen::Translation3d(shift);
    if (turn.norm() > 0)
      T = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * T;
  }
  return set;
}

/// From the places of the laser; the middle looks along the x axis of the scan, its z axis is up.
void writePanoramas(const Run& run, const std::vector<Pose>& poses, const Progress& progress)
{
  constexpr int exposures_of_photographs = 100000; // numbers that photographs may have
  const DatasetOptions& o = run.options;
  makeFolder(run.folder + "/panoramas");
  const CameraModel camera = sphericalCamera(2 * o.panorama_height, o.panorama_height);
  Eigen::Matrix3d R_camera_scan;
  R_camera_scan << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    report(progress, concat("panorama ", k + 1, " of ", poses.size()), double(k) / poses.size());
    View view;
    view.T_camera_world = Eigen::Isometry3d(R_camera_scan) * Eigen::Isometry3d(*poses[k]).inverse();
    Exposure exposure = randomExposure(o.seed, exposures_of_photographs + k, o.exposure_spread);
    exposure.noise = o.sensor_noise;
    writeImage(concat(run.folder, "/panoramas/scan_", std::setfill('0'), std::setw(2), k, ".jpg"),
               takePhotograph(run.lit, {camera, view, exposure}, o.threads), o.jpeg_quality);
  }
}

/// Whether `name` is PREFIX, a number and an extension: a file that an earlier run may have written.
bool isNumbered(const std::filesystem::path& name, const std::string& prefix)
{
  const std::string stem = name.stem().string();
  return stem.size() > prefix.size() && stem.rfind(prefix, 0) == 0 &&
         stem.find_first_not_of("0123456789", prefix.size()) == std::string::npos;
}

/// Takes away what an earlier run wrote, so that no scan or photograph of it is left among the new ones.
void removeOld(const std::string& folder)
{
  namespace fs = std::filesystem;
  fs::remove(folder + "/poses.txt");
  fs::remove(folder + "/survey.e57");
  fs::remove(folder + "/own_frame.txt");
  for (const char* file : {"cameras.txt", "images.txt", "points3D.txt"})
    fs::remove(folder + "/cameras/" + file);
  std::vector<fs::path> frames;
  if (fs::is_directory(folder + "/rgbd"))
    for (const auto& entry : fs::directory_iterator(folder + "/rgbd"))
      if (entry.is_regular_file() && isNumbered(entry.path().stem(), "frame-"))
        frames.push_back(entry.path());
  for (const fs::path& path : frames)
    fs::remove(path);
  const std::pair<const char*, const char*> numbered_files[] = {
      {"scans", "scan_"}, {"panoramas", "scan_"}, {"images", "view_"}, {"truth_images", "view_"}};
  for (const auto& [sub, prefix] : numbered_files) {
    std::vector<fs::path> old;
    if (fs::is_directory(folder + "/" + sub))
      for (const auto& entry : fs::directory_iterator(folder + "/" + sub))
        if (entry.is_regular_file() && isNumbered(entry.path().filename(), prefix))
          old.push_back(entry.path());
    for (const fs::path& path : old)
      fs::remove(path);
  }
}

CameraModel pinhole(const DatasetOptions& o)
{
  CameraModel camera;
  camera.width = o.width, camera.height = o.height;
  camera.fx = camera.fy = o.focal * o.width;
  camera.cx = 0.5 * o.width, camera.cy = 0.5 * o.height;
  return camera;
}
} // namespace

Scene loadScene(const std::string& scene, float max_edge)
{
  if (scene == "conference_room" || scene == "apartment")
    return makeScene(scene, max_edge);
  const TriangleMesh mesh = readMesh(scene);
  try {
    return meshScene(mesh);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(scene + ": " + error.what());
  }
}

void writeDataset(const std::string& name, const std::string& folder, const DatasetOptions& options,
                  const Progress& progress)
{
  validate(options);
  report(progress, "scene", 0.0);
  const Scene scene = name == "office" ? makeOffice({options.rooms, options.seed, options.storeys}, options.max_edge)
                                       : loadScene(name, options.max_edge);
  makeFolder(folder);
  const FolderLock lock(folder, "fresco_scan");
  removeOld(folder);
  const RayScene rays(scene.mesh);
  LightingOptions lighting;
  lighting.threads = options.threads;
  lighting.spacing /= scene.detail;
  report(progress, "light", 0.02);
  const Lightmap light = bakeLight(scene, rays, lighting, subProgress(progress, 0.02, 0.3));
  const LitScene lit{scene, rays, light};
  const Run run{lit, folder, options};
  const ScenePlaces samples = sampleSurface(scene, 4000, options.seed);
  const PlanningInput planning{scene, rays, samples, options.seed, options.threads};
  report(progress, "stations", 0.3);
  const Points stations = chooseStations(planning, options.stations);
  std::vector<int> returns(scene.mesh.faceCount(), 0);
  const std::vector<Pose> poses = writeScans(run, stations, returns, subProgress(progress, 0.32, 0.4));
  writeTruth(run, returns);
  if (options.panoramas)
    writePanoramas(run, poses, subProgress(progress, 0.4, 0.45));
  CameraSet photographs;
  if (options.views > 0) {
    report(progress, "views", 0.45);
    const ScenePlaces part = partAlongX(samples, options.photographed);
    photographs = chooseViews({scene, rays, part, options.seed, options.threads}, pinhole(options), options.views);
    writePhotographs(run, photographs, subProgress(progress, 0.5, 1.0));
    SparsePoints sparse = sparsePoints(lit, photographs, options);
    photographs = misplaced(photographs, options);
    if (options.own_frame > 0)
      writeFile(folder + "/own_frame.txt", intoOwnFrame(photographs, sparse, options.own_frame));
    writeColmap(folder + "/cameras", photographs, sparse);
  }
  if (options.rgbd_frames > 0) {
    const RgbdWalkOptions walk{options.rgbd_frames,  options.rgbd_width, options.rgbd_height,
                               options.jpeg_quality, options.seed,       options.threads};
    writeRgbdWalk(lit, folder + "/rgbd", planWalk(planning, walk.frames), walk, subProgress(progress, 0.5, 1.0));
  }
  if (options.survey)
    writeSurvey(folder, poses, photographs);
  writePoses(folder + "/poses.txt", poses);
}
} // namespace fresco::simulation
