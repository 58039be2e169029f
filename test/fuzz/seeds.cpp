// SPDX-License-Identifier: BSD-3-Clause
#include "seeds.h"
#include "common/float_files.h"
#include "common/io/e57_file.h"
#include "common/io/las_writer.h"
#include "generator.h"
#include "job/stage_log.h"
#include "layouts.h"
#include "targets.h"
#include <filesystem>
#include <fresco/core/image.h>
#include <fresco/io/cloud_file.h>
#include <fresco/io/colmap.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_io.h>
#include <fresco/io/pose_file.h>
using namespace fresco::model;
namespace fresco::fuzz {
namespace {
PointSet somePoints()
{
  PointSet set;
  set.points = Points::NullaryExpr(3, 6, [](Index i, Index j) { return 0.25f * static_cast<float>(i * i + j); });
  set.normals = Points::Zero(3, 6);
  set.normals.row(2).setOnes();
  set.colors = Colors::Constant(3, 6, 100);
  set.intensities = Eigen::VectorXf::LinSpaced(6, 0.f, 1.f);
  set.viewpoints = Points::Ones(3, 6);
  return set;
}

TexturedMesh someModel()
{
  TexturedMesh model;
  model.mesh.vertices = Points(3, 4);
  model.mesh.vertices << 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 0, 1;
  model.mesh.faces = Faces(3, 2);
  model.mesh.faces << 0, 1, 1, 3, 2, 2;
  model.mesh.normals = vertexNormals(model.mesh);
  model.mesh.colors = Colors::Constant(3, 4, 50);
  model.texcoords = model.mesh.vertices.topRows<2>();
  model.texcoord_faces = model.mesh.faces;
  model.face_atlas = Eigen::VectorXi::Zero(2);
  model.atlases.emplace_back(2, 2);
  return model;
}

const char* const ascii_pcd = "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb _\nSIZE 4 4 4 4 1\nTYPE F F F U U\n"
                              "COUNT 1 1 1 1 2\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 1 1 0 0 0\nPOINTS 2\nDATA ascii\n"
                              "0.5 nan -1e-3 16711000 0 0\n1 2 3 4 5 6\n";
const char* const ascii_ply = "ply\nformat ascii 1.0\ncomment c\nelement vertex 3\nproperty float x\nproperty float y\n"
                              "property double z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
                              "element tristrips 1\nproperty list int int vertex_indices\nelement odd 2\n"
                              "property list uchar float f\nend_header\n0 0 0 1 2 3\n1 0 0 4 5 6\n0 1 0 7 8 9\n"
                              "4 0 1 2 -1\n1 0.5\n2 1 1\n";
const char* const ascii_vtk =
    "# vtk DataFile Version 5.1\nt\nASCII\nDATASET POLYDATA\nPOINTS 3 double\n0 0 0 1 0 0 0 1 0\n"
    "METADATA\nINFORMATION 0\n\nTRIANGLE_STRIPS 2 3\nOFFSETS vtktypeint64\n0 3\n"
    "CONNECTIVITY vtktypeint64\n0 1 2\nPOINT_DATA 3\nSCALARS i short 1\nLOOKUP_TABLE default\n"
    "1 2 3\nFIELD FieldData 1\na%20b 2 3 float\n1 2 3 4 5 6\n";
const char* const quads_obj =
    "mtllib input.mtl\nv 0 0 0 1 0.5 0\nv 1 0 0\nv 1 1 0\nv 0 1 1e-3\nvt 0 0\nvt 1 0 0\nvn 0 0 1\n"
    "usemtl a\nf 1/1/1 2/2/1 3/1/1 -1/-1/-1\nf 1//1 2//1 3//1\nl 1 2\nf 1 2 \\\n3\n";

const char* const two_stations_ptx = "2\n2\n1 2 3\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n1 2 3 1\n"
                                     "1 2 3 0.5\n0 0 0 0.5\n-1e-3 2 3 1\n4 5 6 0\n"
                                     "1\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n5 6 7 1\n"
                                     "1 2 3 .5 1 2 255\n";

/// Without checksums, as the target wants it.
std::string someE57()
{
  using test::e57::Field;
  Field x{"cartesianX"}, range{"sphericalRange"};
  x.reals = {1, 2, 3};
  Field y = x, z{"cartesianZ", "ScaledInteger", false, -5, 500, 0.5, 2, {-5, 7, 500}};
  y.name = "cartesianY";
  y.single = true;
  const Field state{"cartesianInvalidState", "Integer", false, 0, 2, 1, 0, {0, 1, 2}};
  const Field row{"rowIndex", "Integer", false, 0, 9, 1, 0, {0, 1, 2}}, column{"columnIndex", "Integer"};
  Field red{"colorRed", "Integer", false, 0, 65535, 1, 0, {0, 1, 65535}}, green = red, blue = red;
  green.name = "colorGreen";
  blue.name = "colorBlue";
  Field label{"label", "String"};
  label.texts = {"a", "", "bc"};
  range.reals = {1, 2, 3};
  Field azimuth = range, elevation = range;
  azimuth.name = "sphericalAzimuth";
  elevation.name = "sphericalElevation";
  const test::e57::Image picture{"<sphericalRepresentation type=\"Structure\"><jpegImage type=\"Blob\" PICTURE/>"
                                 "</sphericalRepresentation>",
                                 "jpeg", ""};
  const std::string file = test::e57::fileOf(
      {{"a", {x, y, z, state, row, column, red, green, blue, label}, 3, test::e57::poseXml(1, 0, 1, 2, 3)},
       {"b", {range, azimuth, elevation}, 3}},
      {picture});
  std::string logical;
  for (std::size_t at = 0; at < file.size(); at += 1024)
    logical += file.substr(at, 1020);
  return logical;
}

std::string someLas(int minor, int format)
{
  test::las::File file;
  file.minor = minor;
  file.format = format;
  file.points.resize(3);
  file.points[1].stored = {100, -200, 300};
  return test::las::fileOf(file);
}

std::string parts(const std::string& a, const std::string& b) { return a + std::string(separator) + b; }

/// A little-endian number of COLMAP's binary model.
template <typename T>
std::string raw(T value)
{
  return {reinterpret_cast<const char*>(&value), sizeof(value)};
}

std::string binaryColmap()
{
  std::string cameras = raw<std::uint64_t>(1) + raw<std::uint32_t>(7) + raw<std::int32_t>(4) + raw<std::uint64_t>(640) +
                        raw<std::uint64_t>(480);
  for (const double parameter : {500., 510., 320., 240., 0.1, -0.01, 1e-3, 1e-3})
    cameras += raw(parameter);
  std::string images = raw<std::uint64_t>(1) + raw<std::uint32_t>(3);
  for (const double value : {1., 0., 0., 0., 0.5, -1., 2.})
    images += raw(value);
  images += raw<std::uint32_t>(7) + std::string("a.jpg") + '\0' + raw<std::uint64_t>(1) + raw(10.) + raw(20.) +
            raw<std::uint64_t>(5);
  return parts(cameras, images);
}

std::string textColmap(const std::string& scratch)
{
  CameraSet set;
  set.cameras = {{640, 480, 500, 510, 320, 240, 0.1, -0.01, 1e-3, 1e-3}, {640, 480, 500, 500, 320, 240, 0, 0, 0, 0}};
  View view;
  for (const int camera : {0, 1}) {
    view.camera = camera;
    view.image = "photo " + std::to_string(camera) + ".jpg";
    set.views.push_back(view);
  }
  writeColmap(scratch, set);
  return parts(readFile(scratch + "/cameras.txt"), readFile(scratch + "/images.txt"));
}

/// 16-bit PNG of 4 x 3 pixels, 1500 each.
std::string depthImage()
{
  static const unsigned char bytes[] = {
      0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00,
      0x00, 0x04, 0x00, 0x00, 0x00, 0x03, 0x10, 0x00, 0x00, 0x00, 0x00, 0xc1, 0x0f, 0x2d, 0x59, 0x00, 0x00, 0x00,
      0x0f, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0x60, 0xbd, 0x03, 0x81, 0x0c, 0x18, 0x0c, 0x00, 0x89, 0x73,
      0x0a, 0x8d, 0xcf, 0x45, 0xa4, 0x46, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
  return {reinterpret_cast<const char*>(bytes), sizeof(bytes)};
}

/// 2 x 2 grey pixels.
std::string tiff()
{
  std::string bytes = std::string("II*\0", 4) + raw(std::uint32_t{12}) + "abcd" + raw(std::uint16_t{8});
  for (const auto& [tag, value] :
       {std::pair(256, 2), {257, 2}, {258, 8}, {259, 1}, {262, 1}, {273, 8}, {278, 2}, {279, 4}})
    bytes += raw(std::uint16_t(tag)) + raw(std::uint16_t{4}) + raw(std::uint32_t{1}) + raw(std::uint32_t(value));
  return bytes + raw(std::uint32_t{0});
}

/// 2 x 1 pixels.
std::string bmp()
{
  std::string bytes = "BM" + raw(std::uint32_t{62}) + raw(std::uint32_t{0}) + raw(std::uint32_t{54}) +
                      raw(std::uint32_t{40}) + raw(std::int32_t{2}) + raw(std::int32_t{1}) + raw(std::uint16_t{1}) +
                      raw(std::uint16_t{24});
  bytes.resize(54, '\0');
  return bytes + "bgrBGR\1\2";
}

/// 1 x 1 pixel.
std::string webp()
{
  static const unsigned char bytes[] = {0x52, 0x49, 0x46, 0x46, 0x24, 0x00, 0x00, 0x00, 0x57, 0x45, 0x42,
                                        0x50, 0x56, 0x50, 0x38, 0x20, 0x18, 0x00, 0x00, 0x00, 0x30, 0x01,
                                        0x00, 0x9d, 0x01, 0x2a, 0x01, 0x00, 0x01, 0x00, 0x03, 0x00, 0x34,
                                        0x25, 0xa4, 0x00, 0x03, 0x70, 0x00, 0xfe, 0xfb, 0x94, 0x00, 0x00};
  return {reinterpret_cast<const char*>(bytes), sizeof(bytes)};
}

std::string stageLog(const std::string& scratch)
{
  std::filesystem::remove(scratch + "/stage.json");
  StageLog log(scratch, {"input"}, false, {});
  log.run({"stage", "options", {}, [](const Progress&) { return nlohmann::ordered_json{{"answer", 42}}; }});
  return readFile(scratch + "/stage.json");
}
} // namespace

void writeSeeds(const std::string& folder)
{
  const auto put = [&](const std::string& target, const std::string& name, const std::string& content) {
    makeFolder(folder + "/" + target);
    writeFile(folder + "/" + target + "/" + name, content);
  };
  const std::string scratch = folder + "/.scratch";
  makeFolder(scratch);
  const auto written = [&](const std::string& name, const auto& write) {
    write(scratch + "/" + name);
    return readFile(scratch + "/" + name);
  };
  const auto points = [](const std::string& path) { writePoints(path, somePoints()); };
  const auto mesh = [](const std::string& path) { writeMesh(path, someModel().mesh); };
  const auto model = [](const std::string& path) { writeTexturedMesh(path, someModel()); };
  put("pcd", "binary", written("a.pcd", points));
  put("pcd", "compressed",
      written("b.pcd", [](const std::string& path) { writeCloud(path, toCloudFile(somePoints()), true); }));
  put("pcd", "ascii", ascii_pcd);
  put("ply", "points", written("a.ply", points));
  put("ply", "mesh", written("b.ply", mesh));
  put("ply", "ascii", ascii_ply);
  put("vtk", "binary", written("a.vtk", mesh));
  put("vtk", "ascii", ascii_vtk);
  put("stl", "binary", written("a.stl", mesh));
  put("xyz", "points", written("a.xyz", points));
  put("xyz", "colors", "# x y z r g b\n0 0 0 255 0 0\n1,2,3,0,0,255\n-1e3 nan 5 1 2 3\n");
  put("ptx", "stations", two_stations_ptx);
  put("pts", "blocks", "2\n1 2 3 -7 10 20 30\n4 5 6 100 1 2 3\n1\n431000.123 5410000.456 7 8 9 10 11\n");
  put("las", "old", someLas(2, 3));
  put("las", "new", someLas(4, 8));
  put("e57", "scans", someE57());
  put("obj", "quads", parts(quads_obj, "newmtl a\nKd 1 0 0\nmap_Kd -s 1 1 1 missing.png\n"));
  put("obj", "mesh", written("a.obj", mesh));
  const std::string obj = written("input.obj", model);
  put("obj", "model", parts(obj, readFile(scratch + "/input.mtl")));
  put("glb", "model", written("a.glb", model));
  put("colmap_text", "model", textColmap(scratch));
  put("colmap_binary", "model", binaryColmap());
  for (const std::string target : {"points3d_text", "points3d_binary"})
    put(target, "points", generated(target, 1).packed());
  for (std::uint32_t seed = 0; seed < 20; ++seed) // each program's at least once
    put("cameras", std::to_string(seed), generated("cameras", seed).packed());
  for (const std::string type : {".png", ".jpg"})
    put("picture", type.substr(1), written("a" + type, [](const std::string& path) { writeImage(path, Image(5, 4)); }));
  for (const auto& [name, make] : {std::pair{"depth", &depthImage}, {"tiff", tiff}, {"bmp", bmp}, {"webp", webp}})
    put("picture", name, make());
  const test::Floats metres{3, 2, {1, 1.5f, 2, 0, -1, 1e9f}};
  put("picture", "pfm", test::pfmBytes(metres));
  put("picture", "npy", test::npyBytes(metres));
  put("picture", "depth_tiff", test::tiffBytes(metres));
  put("poses", "poses", written("poses.txt", [](const std::string& path) {
        writePoses(path, {Eigen::Matrix4d::Identity().eval(), Pose()});
      }));
  put("rgbd", "frame",
      parts(parts("585 0 2\n0 585 1.5\n0 0 1\n", "1 0 0 0.5\n0 1 0 .5\n0 0 1 -2e1\n0 0 0 1\n"), depthImage()));
  for (const auto& [name, input] : layouts())
    put("layout", name, input);
  put("stage_log", "record", stageLog(scratch));
  put("args", "words", "in.pcd\n-n\n5\n-f\n1e-3\n-xyz\n-1\n0\n.5\nout.ply\n-on\n--text\nword\n-size\n640x480");
  std::filesystem::remove_all(scratch);
}
} // namespace fresco::fuzz
