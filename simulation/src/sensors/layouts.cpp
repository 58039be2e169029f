// SPDX-License-Identifier: BSD-3-Clause
#include "sensors/layout_copy.h"
#include <fresco/io/colmap.h>
#include <fresco/io/image_io.h>
#include <fresco/io/point_io.h>
#include <fresco/simulation/sensors/layout_files.h>
#include <fresco/simulation/sensors/layouts.h>
namespace fresco::simulation {
namespace {
namespace fs = std::filesystem;

void writeScansAs(const Copy& copy, const std::string& extension)
{
  for (std::size_t k = 0; k < copy.poses().size(); ++k) {
    const PointSet scan = readPoints(copy.scan(k));
    const std::string file = copy.to + "/station" + numbered(k + 1, 1) + extension;
    if (extension == ".las")
      writeFile(file, lasFile(scan));
    else
      writePoints(file, scan);
  }
}

/// With normals to where each point was seen from, roughly: along the beam.
PointSet cloudWithNormals(const Copy& copy)
{
  PointSet all;
  const std::vector<Pose> poses = copy.poses();
  for (std::size_t k = 0; k < poses.size(); ++k) {
    PointSet scan = readPoints(copy.scan(k));
    scan.viewpoints = Points::Zero(3, 1);
    scan.normals = nearbyNormals(scan);
    scan = transformPoints(scan, *poses[k]);
    scan.viewpoints.resize(3, 0);
    appendPoints(all, scan);
  }
  return all;
}

void writeUtmTiles(const Copy& copy)
{
  PointSet cloud = mergedCloud(copy);
  cloud.origin += Eigen::Vector3d(691000, 5334000, 520);
  const float middle = 0.5f * (cloud.points.row(0).minCoeff() + cloud.points.row(0).maxCoeff());
  for (const bool east : {false, true}) {
    std::vector<Index> kept;
    for (Index i = 0; i < cloud.size(); ++i)
      if ((cloud.points(0, i) > middle) == east)
        kept.push_back(i);
    writeFile(copy.to + (east ? "/tile_691_5334_east.las" : "/tile_691_5334_west.las"),
              lasFile(selectPoints(cloud, kept)));
  }
}

void writeTrajectory(const Copy& copy)
{
  writePoints(copy.to + "/cloud.ply", mergedCloud(copy));
  std::string lines = "# time x y z qx qy qz qw\n";
  for (const Pose& pose : copy.poses())
    lines += concat(100 + lines.size(), " ", quaternionText(*pose, " "), "\n");
  writeFile(copy.to + "/trajectory.txt", lines);
}

/// Each point bears the time at which its scan was taken; the sensor goes from one place to the next.
void writeTimedCloud(const Copy& copy)
{
  std::vector<double> times;
  std::string lines;
  const std::vector<Pose> poses = copy.poses();
  for (std::size_t k = 0; k < poses.size(); ++k) {
    times.resize(times.size() + readPoints(copy.scan(k)).size(), 500 + 10.0 * k);
    lines += concat(500 + 10 * k, " ", quaternionText(*poses[k], " "), "\n");
  }
  writeFile(copy.to + "/drive.las", lasFile(mergedCloud(copy), times));
  writeFile(copy.to + "/trajectory.txt", lines);
}

/// As Matterport's MatterPak: a textured mesh, of which a few faces do here, and the cloud.
void writeMatterPak(const Copy& copy)
{
  const PointSet cloud = mergedCloud(copy);
  writePoints(copy.to + "/cloud.xyz", cloud);
  const Eigen::Vector3f far = cloud.points.rowwise().maxCoeff();
  writeFile(copy.to + "/0f37bd07.obj", concat("mtllib 0f37bd07.mtl\nv 0 0 0\nv ", far.x(), " 0 0\nv 0 ", far.y(),
                                              " 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n"));
  writeFile(copy.to + "/0f37bd07.mtl", "newmtl a\nmap_Kd 0f37bd07_000.jpg\n");
  for (const char* name : {"/0f37bd07_000.jpg", "/colorplan_000.jpg"})
    writeImage(copy.to + name, Image(16, 16, 3, 200));
}

void writeColmapProject(const Copy& copy, bool dense)
{
  copy.folder("images", "images");
  writeColmap(copy.to + "/sparse/0", readColmap(copy.from + "/cameras"), readColmapPoints(copy.from + "/cameras"));
  writeFile(copy.to + "/sparse/0/rigs.txt",
            "# RIG_ID, NUM_SENSORS, REF_SENSOR_TYPE, REF_SENSOR_ID, SENSORS[]\n1 1 CAMERA 1\n");
  writeFile(copy.to + "/sparse/0/frames.txt", "# FRAME_ID, RIG_ID, RIG_FROM_WORLD, NUM_DATA_IDS, DATA_IDS[]\n");
  if (!dense)
    return;
  makeFolder(copy.to + "/dense");
  writePoints(copy.to + "/dense/fused.ply", cloudWithNormals(copy));
}

void writeScannerExport(const Copy& copy)
{
  writePoints(copy.to + "/cloud.ply", mergedCloud(copy));
  makeFolder(copy.to + "/pano");
  std::string table =
      "# pano poses v1.0: ID; filename; timestamp; pano_pos_x; pano_pos_y; pano_pos_z; pano_ori_w; pano_ori_x; "
      "pano_ori_y; pano_ori_z\n";
  const std::vector<Pose> poses = copy.poses();
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const std::string name = numbered(k, 5) + "-pano.jpg";
    writeImage(copy.to + "/pano/" + name,
               readImage(concat(copy.from, "/panoramas/scan_", std::setfill('0'), std::setw(2), k, ".jpg")));
    const Eigen::Matrix4d& T = *poses[k];
    const Eigen::Quaterniond q(Eigen::Matrix3d(T.topLeftCorner<3, 3>()));
    table += concat(k, "; ", name, "; ", 1000 + k, "; ", T(0, 3), "; ", T(1, 3), "; ", T(2, 3), "; ", q.w(), "; ",
                    q.x(), "; ", q.y(), "; ", q.z(), "\n");
  }
  writeFile(copy.to + "/pano-poses.csv", table);
}

struct Writer {
  const char* name;
  void (*write)(const Copy&);
};

constexpr Writer writers[] = {
    {"flat_pcd", [](const Copy& copy) { writeScansAs(copy, ".pcd"); }},
    {"flat_ply", [](const Copy& copy) { writeScansAs(copy, ".ply"); }},
    {"flat_las", [](const Copy& copy) { writeScansAs(copy, ".las"); }},
    {"flat_xyz", [](const Copy& copy) { writeScansAs(copy, ".xyz"); }},
    {"one_scan", [](const Copy& copy) { writePoints(copy.to + "/scan.pcd", readPoints(copy.scan(0))); }},
    {"one_cloud", [](const Copy& copy) { writePoints(copy.to + "/cloud.pcd", mergedCloud(copy)); }},
    {"cloud_normals", [](const Copy& copy) { writePoints(copy.to + "/cloud.ply", cloudWithNormals(copy)); }},
    {"cloud_utm", writeUtmTiles},
    {"cloud_trajectory", writeTrajectory},
    {"cloud_times", writeTimedCloud},
    {"matterpak", writeMatterPak},
    {"e57",
     [](const Copy& copy) { fs::copy(copy.from + "/survey.e57", copy.to, fs::copy_options::overwrite_existing); }},
    {"photographs", [](const Copy& copy) { copy.folder("images", "."); }},
    {"images", [](const Copy& copy) { copy.folder("images", "images"); }},
    {"colmap", [](const Copy& copy) { writeColmapProject(copy, true); }},
    {"colmap_sparse", [](const Copy& copy) { writeColmapProject(copy, false); }},
    {"metashape", writeMetashape},
    {"bundler", writeBundler},
    {"nvm", writeNvm},
    {"transforms", writeTransforms},
    {"openmvg", writeOpenMvg},
    {"scanner_export", writeScannerExport},
    {"seven_scenes", writeSevenScenes},
    {"tum", writeTum},
    {"open3d", writeOpen3d},
    {"redwood", writeRedwood},
    {"scannet", writeScanNet},
    {"stray", writeStray},
    {"polycam", writePolycam},
    {"matterport", writeMatterport},
};
} // namespace

PointSet mergedCloud(const Copy& copy)
{
  PointSet all;
  const std::vector<Pose> poses = copy.poses();
  for (std::size_t k = 0; k < poses.size(); ++k) {
    PointSet scan = readPoints(copy.scan(k));
    scan.viewpoints.resize(3, 0);
    appendPoints(all, transformPoints(scan, *poses[k]));
  }
  return all;
}

std::vector<std::string> layoutNames()
{
  std::vector<std::string> names;
  for (const Writer& writer : writers)
    names.emplace_back(writer.name);
  return names;
}

void writeLayout(const std::string& name, const std::string& source, const std::string& folder)
{
  for (const Writer& writer : writers)
    if (name == writer.name) {
      makeFolder(folder);
      writer.write({source, folder});
      return;
    }
  require(false, "layout ", name, " is none of those that are known");
}
} // namespace fresco::simulation
