// SPDX-License-Identifier: BSD-3-Clause
// Cases of public reports, listed with their addresses in docs/measurements/formats.md.
#include "common/io/e57_file.h"
#include "common/io/las_writer.h"
#include "common/io/test_io_data.h"
#include <fresco/io/cloud_file.h>
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_files.h>
#include <fresco/io/point_io.h>
#include <fresco/io/reading.h>
#include <fresco/io/scan_file.h>
namespace {
using namespace fresco;
using test::stored;
using test::testFolder;

const std::string ply_head =
    "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n";

/// A file of two points, and what its second point is. Values that are not given are not looked at.
struct Report {
  const char *report, *name;
  std::string content;
  Eigen::Vector3f point, normal = Eigen::Vector3f::Zero();
  Eigen::Vector3i color{-1, -1, -1};
  float intensity = -1;
};

const Eigen::Vector3f none = Eigen::Vector3f::Zero();

const Report reports[] = {
    {"assimp#1167",
     "a.ply",
     ply_head +
         "property float red\nproperty float green\nproperty float blue\nend_header\n0 0 0 0 0 0\n1 2 3 1 0.2 0\n",
     {1, 2, 3},
     none,
     {255, 51, 0}},
    {"MonoRec#20",
     "a.ply",
     ply_head +
         "property float red\nproperty float green\nproperty float blue\nend_header\n0 0 0 0 0 0\n1 2 3 255 51 0\n",
     {1, 2, 3},
     none,
     {255, 51, 0}},
    {"meshlab#186",
     "a.ply",
     ply_head + "property uchar r\nproperty uchar g\nproperty uchar b\nend_header\n0 0 0 0 0 0\n1 2 3 255 51 0\n",
     {1, 2, 3},
     none,
     {255, 51, 0}},
    {"assimp#750", "a.ply", ply_head + "end_header\n-5,98402 558,628 -139,477\n1,5 2,25 3\n", {1.5f, 2.25f, 3}},
    {"UnityPointCloudViewer#31",
     "a.pcd",
     "VERSION .7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA "
     "ascii\n0 0 0 4.2108e+06\n1 2 3 4.2108e+06\n",
     {1, 2, 3},
     none,
     {64, 64, 112}},
    {"blender-pcd-io#13",
     "a.pcd",
     "VERSION .7\r\nFIELDS x y z\r\nSIZE 4 4 4\r\nTYPE F F F\r\nWIDTH 2\r\nHEIGHT 1\r\nVIEWPOINT 0 0 0 1 0 0 "
     "0\r\nPOINTS 2\r\nDATA ascii\r\n0 0 0\r\n1 2 3\r\n",
     {1, 2, 3}},
    {"Open3D#1379",
     "a.txt",
     "694386.212,5155487.512,381.036\n694387.25,5155488.5,382.125\n",
     {694387.25f, 5155488.5f, 382.125f}},
    {"PDAL#1508",
     "a.txt",
     "//X;Y;Z;Rf;Gf;Bf;Intensity;curvature;Illuminance (PCV);Volume density (r=0.01);Roughness(0.01);Nx;Ny;Nz\n2\n"
     "1.4;2.7;1.7;1;0.976471;0.988235;0.514534;0;0.889831;86421136;0.000164;0.842968;-0.279958;-0.459379\n"
     "1;2;3;1;0.2;0;0.25;0;0.8;5;0.0003;0;-0.6;0.8\n",
     {1, 2, 3},
     {0, -0.6f, 0.8f},
     {255, 51, 0},
     0.25f},
    {"CloudCompare#639",
     "a.csv",
     "x,y,z,Nx,Ny,Nz,dip\n0,0,0,0,0,1,7\n1,2,3,0.6,0,-0.8,9\n",
     {1, 2, 3},
     {0.6f, 0, -0.8f}},
    {"meshlab#226", "a.asc", "0 0 0 0 0 1\n1 2 3 0.6 0 -0.8\n", {1, 2, 3}, {0.6f, 0, -0.8f}},
    {"pyntcloud#305", "a.pts", "x y z\n0 0 0\n1 2 3\n", {1, 2, 3}},
    {"pyntcloud#305", "a.pts", "2\n0 0 0 -5 0 0 0\n1 2 3 17 255 51 0\n", {1, 2, 3}, none, {255, 51, 0}, 17},
    {"more points than announced", "a.pts", "1\n0 0 0\n1 2 3\n", {1, 2, 3}},
    {"a comment without its word",
     "a.ply",
     "ply\nformat ascii 1.0\nCreated by hand\n" + ply_head.substr(21) + "end_header\n0 0 0\n1 2 3\n",
     {1, 2, 3}},
    {"PotreeConverter#85", "a.obj", "v 0 0 0 0 0 0\nv 1 2 3 255 51 0\n", {1, 2, 3}, none, {255, 51, 0}},
    {"exports in other locales",
     "a.pcd",
     "VERSION .7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n0,5 0 0 "
     "0\n1,0 2 3 0,25\n",
     {1, 2, 3},
     none,
     {-1, -1, -1},
     0.25f}};

TEST(FormatReports, FilesOfTwoPoints)
{
  for (const Report& report : reports) {
    SCOPED_TRACE(report.report);
    const std::string path = stored(report.name, report.content);
    for (const PointSet& set : {readPoints(path), toPointSet(readCloud(path))}) {
      ASSERT_EQ(set.size(), 2);
      EXPECT_LT((set.origin + set.points.col(1).cast<double>() - report.point.cast<double>()).norm(), 1e-6);
      if (!report.normal.isZero()) {
        ASSERT_TRUE(set.hasNormals());
        EXPECT_EQ(set.normals.col(1), report.normal);
      }
      if (report.color[0] >= 0) {
        ASSERT_EQ(set.colors.cols(), 2);
        EXPECT_EQ(set.colors.col(1).cast<int>(), report.color);
      }
      if (report.intensity >= 0) {
        ASSERT_EQ(set.intensities.size(), 2);
        EXPECT_EQ(set.intensities[1], report.intensity);
      }
    }
  }
}

TEST(FormatReports, LasColours)
{
  for (const int format : {2, 3, 5, 7, 8, 10}) // schwarzwald#5
    for (const int scale : {1, 257}) {         // gocesiumtiler#17, lidR#13
      test::las::File file;
      file.minor = 4;
      file.format = format;
      file.points.resize(2);
      file.points[1].color = {std::uint16_t(200 * scale), std::uint16_t(51 * scale), 0};
      EXPECT_EQ(readPoints(stored("a.las", test::las::fileOf(file))).colors.col(1).cast<int>(),
                Eigen::Vector3i(200, 51, 0))
          << format << ' ' << scale;
    }
}

TEST(FormatReports, LasExtraBytesAreScaled)
{
  test::las::File file; // laspy#64, PDAL#392
  file.format = 1;
  file.points.resize(2);
  file.extra_bytes = 5;
  const std::string bytes = test::las::fileOf(file);
  std::string descriptor(192, '\0'), record(54, '\0'), points = bytes.substr(bytes.size() - 2 * 33);
  descriptor[2] = 3;      // unsigned short
  descriptor[3] = 1 | 24; // with no_data, scale and offset
  descriptor.replace(4, 9, "Amplitude");
  test::las::put(descriptor, 40, std::uint64_t{9});
  test::las::put(descriptor, 112, 0.5);
  test::las::put(descriptor, 136, 100.0);
  record.replace(2, 9, "LASF_Spec");
  test::las::put(record, 18, std::uint16_t{4});
  test::las::put(record, 20, std::uint16_t{192});
  std::string head = bytes.substr(0, 227);
  test::las::put(head, 96, std::uint32_t{227 + 54 + 192});
  test::las::put(head, 100, std::uint32_t{1});
  test::las::put(points, 28, std::uint16_t{9});
  test::las::put(points, 33 + 28, std::uint16_t{7});
  const TriangleMesh fields = [&] {
    writeCloud(testFolder() + "/a.ply", readCloud(stored("a.las", head + record + descriptor + points)));
    return readMesh(testFolder() + "/a.ply");
  }();
  ASSERT_EQ(fields.fields.count("Amplitude"), 1u);
  EXPECT_TRUE(std::isnan(fields.fields.at("Amplitude")[0]));
  EXPECT_EQ(fields.fields.at("Amplitude")[1], 103.5f);
  EXPECT_EQ(fields.fields.at("extra_bytes_2")[1], float('x')); // what no descriptor tells of
}

TEST(FormatReports, E57Fields)
{
  const auto read = [](const test::e57::Field& extra) {
    test::e57::Scan scan{"a", {}, 2};
    for (const char* axis : {"cartesianX", "cartesianY", "cartesianZ"}) {
      test::e57::Field field{axis};
      field.reals = {1, 2};
      scan.fields.push_back(field);
    }
    for (const char* channel : {"colorRed", "colorGreen", "colorBlue"}) {
      test::e57::Field field{channel, "Integer"};
      field.maximum = 255;
      field.stored = {200, 100};
      scan.fields.push_back(field);
    }
    scan.fields.push_back(extra);
    return test::e57::fileOf({scan});
  };
  test::e57::Field invalid{"isColorInvalid", "Integer"}; // e57-to-las#15
  invalid.maximum = 1;
  invalid.stored = {0, 1};
  EXPECT_EQ(readPoints(stored("a.e57", read(invalid))).colors.row(0).cast<int>(), Eigen::RowVector2i(200, 0));
  test::e57::Field wide{"label", "Integer"}; // ifc-lite#3680
  wide.minimum = std::numeric_limits<std::int64_t>::min();
  wide.maximum = std::numeric_limits<std::int64_t>::max();
  wide.stored = {5, -7};
  const std::string whole = read(wide);
  const std::string bare =
      test::e57::edited(whole, " minimum=\"-9223372036854775808\" maximum=\"9223372036854775807\"", "");
  ASSERT_FALSE(bare.empty());
  EXPECT_EQ(readCloud(stored("b.e57", bare)).cloud.data, readCloud(stored("c.e57", whole)).cloud.data);
  writeCloud(testFolder() + "/long.ply", readCloud(stored("c.e57", whole))); // which PLY has only double for
  EXPECT_EQ(readMesh(testFolder() + "/long.ply").fields.at("label"), Eigen::Vector2f(5, -7));
}

TEST(FormatReports, PtxStationsStandInTheirPlaces)
{
  const std::string scanner = "1\n2\n", axes = "1 0 0\n0 1 0\n0 0 1\n", beams = "1 0 0 0.5\n0 2 0 0.25\n";
  const std::string path =
      stored("a.ptx", scanner + "0 0 0\n" + axes + "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n" + beams + scanner +
                          "10 0 3\n" + axes + "0 1 0 0\n-1 0 0 0\n0 0 1 0\n10 0 3 1\n" + beams); // meshlab#640
  const PointSet all = readPoints(path);
  ASSERT_EQ(all.size(), 4);
  EXPECT_EQ(all.points.col(0), Eigen::Vector3f(1, 0, 0));
  EXPECT_LT((all.points.col(2) - Eigen::Vector3f(10, 1, 3)).norm(), 1e-6f);
  EXPECT_LT((all.viewpoints.col(3) - Eigen::Vector3f(10, 0, 3)).norm(), 1e-6f);
  EXPECT_EQ(readPoints(ScanPath{path, 1}).points.col(1), Eigen::Vector3f(0, 2, 0));
}

/// A scan of points (x, 0, 0).
test::e57::Scan scanOnAxis(const std::string& name, const std::vector<double>& x)
{
  test::e57::Scan scan{name, {}, x.size()};
  for (const char* axis : {"cartesianX", "cartesianY", "cartesianZ"}) {
    test::e57::Field field{axis};
    field.reals = axis[9] == 'X' ? x : std::vector<double>(x.size(), 0.0);
    scan.fields.push_back(field);
  }
  return scan;
}

TEST(FormatReports, E57PointsThatAreOdd)
{
  test::e57::Scan scan = scanOnAxis("a", {0, 1, 7}), packed = scan;
  packed.fields[0] = {"cartesianX", "Integer"};
  packed.fields[0].maximum = 5; // PCD-E57#8: 7 is above
  packed.fields[0].stored = {0, 1, 7};
  for (const test::e57::Scan& each : {scan, packed}) {
    const PointSet set = readPoints(stored("a.e57", test::e57::fileOf({each})));
    ASSERT_EQ(set.size(), 3);
    EXPECT_EQ(set.points.col(0), Eigen::Vector3f(0, 0, 0)); // CloudCompare#1374: nothing says that it is none
    EXPECT_EQ(set.points.col(2), Eigen::Vector3f(7, 0, 0));
  }
}

TEST(FormatReports, FieldsThatSomeScansLackAreSaid)
{
  test::e57::Scan bright = scanOnAxis("b", {3, 4});
  test::e57::Field intensity{"intensity"};
  intensity.reals = {0.25, 0.75};
  bright.fields.push_back(intensity); // ifc-lite#608
  const std::string path = stored("a.e57", test::e57::fileOf({bright, scanOnAxis("a", {1, 2})}));
  std::string remarks;
  listenToReaders([&](const std::string& line) { remarks += line; });
  EXPECT_EQ(readPoints(path).intensities.size(), 0);
  listenToReaders({});
  EXPECT_NE(remarks.find("field intensity is not in all scans"), std::string::npos) << remarks;
  EXPECT_EQ(readPoints(ScanPath{path, 0}).intensities, Eigen::Vector2f(0.25f, 0.75f));
}

TEST(FormatReports, ObjNames)
{
  const std::string folder = testFolder(), corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n";
  writeImage(folder + "/a.png", Image(2, 2, 3, 200));
  test::writeText(folder + "/foo bar.mtl", "newmtl my material\nmap_Kd a.png\n");
  const TexturedMesh model = readTexturedMesh(
      stored("a.obj", "mtllib foo bar.mtl\n" + corners + "usemtl my material\nf -3/1 -2/1 -1/1\nusemtl\nf 1 2 3\n"));
  EXPECT_EQ(model.face_atlas, Eigen::Vector2i(0, -1));          // tinyobjloader#355, helios#674
  EXPECT_EQ(model.mesh.faces.col(0), Eigen::Vector3i(0, 1, 2)); // three.js#5799
  TexturedMesh full = test::fullTexturedMesh(4, 2);
  writeTexturedMesh(folder + "/name with blanks.obj", full);
  EXPECT_EQ(readTexturedMesh(folder + "/name with blanks.obj").face_atlas, full.face_atlas);
}

TEST(FormatReports, ObjFacesThatAreOdd)
{
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  std::string remarks;
  listenToReaders([&](const std::string& line) { remarks += line; });
  for (const char* face : {"f 1/1/1 2/2/1 3/3/1\n", "f 1// 2//\nf 1// 2// 3//\n"})
    EXPECT_EQ(readMesh(stored("a.obj", corners + face)).faceCount(), 1) << face;
  listenToReaders({});
  EXPECT_NE(remarks.find("of which there are none"), std::string::npos);
  EXPECT_NE(remarks.find("fewer than 3 corners"), std::string::npos);
  EXPECT_THROW(readMesh(stored("b.obj", corners + "vn 0 0 1\nf 1//1 2//2 3//1\n")), std::runtime_error);
}

TEST(FormatReports, HiddenFilesInFoldersDoNotCount)
{
  const std::string folder = testFolder();
  for (const char* name : {"a.xyz", "._a.xyz", ".a.0123.part.ply"})
    test::writeText(folder + "/" + name, "1 2 3\n");
  EXPECT_EQ(pointFilesIn({folder}), std::vector<std::string>{folder + "/a.xyz"});
}

template <typename T>
std::string raw(const std::vector<T>& values)
{
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// Binary glTF of a square of four corners; positions are bytes, texture coordinates 16 bits, both as fractions.
std::string squareGlb(const std::string& node, const std::string& primitives, const std::string& more = "")
{
  std::string buffer = raw<std::int8_t>({0, 0, 0, 0, 127, 0, 0, 0, 127, 127, 0, 0, 0, 127, 0, 0}) +
                       raw<std::uint16_t>({0, 0, 65535, 0, 65535, 65535, 0, 65535}) + raw<std::uint8_t>({0, 1, 3, 2}) +
                       raw<std::uint8_t>({0, 1, 2, 3});
  std::string json = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0)" + node +
                     R"(}],"meshes":[{"primitives":[)" + primitives + R"(]}],"accessors":[)" +
                     R"({"bufferView":0,"componentType":5120,"normalized":true,"count":4,"type":"VEC3"},)" +
                     R"({"bufferView":1,"componentType":5123,"normalized":true,"count":4,"type":"VEC2"},)" +
                     R"({"bufferView":2,"componentType":5121,"count":4,"type":"SCALAR"},)" +
                     R"({"bufferView":3,"componentType":5121,"count":4,"type":"SCALAR"}],"bufferViews":[)" +
                     R"({"buffer":0,"byteLength":16,"byteStride":4},{"buffer":0,"byteOffset":16,"byteLength":16},)" +
                     R"({"buffer":0,"byteOffset":32,"byteLength":4},{"buffer":0,"byteOffset":36,"byteLength":4}],)" +
                     R"("buffers":[{"byteLength":40}])" + more + "}";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const auto u32 = [](std::size_t value) { return raw<std::uint32_t>({static_cast<std::uint32_t>(value)}); };
  return "glTF" + u32(2) + u32(20 + json.size() + 8 + buffer.size()) + u32(json.size()) + "JSON" + json +
         u32(buffer.size()) + std::string("BIN\0", 4) + buffer;
}

TEST(FormatReports, GltfPrimitivesAndNodes)
{
  const std::string strip = R"({"attributes":{"POSITION":0},"indices":2,"mode":5})",
                    fan = R"({"attributes":{"POSITION":0},"indices":3,"mode":6})",
                    lines = R"({"attributes":{"POSITION":0},"mode":1})";
  std::string remarks;
  listenToReaders([&](const std::string& line) { remarks += line; });
  for (const std::string& primitives : {strip, fan, lines + "," + strip}) {
    const TriangleMesh mesh = readTexturedMesh(stored("a.glb", squareGlb("", primitives))).mesh;
    ASSERT_EQ(mesh.faceCount(), 2) << primitives;
    double area = 0; // towards +z of glTF, which is -y here
    for (Index f = 0; f < 2; ++f) {
      const Eigen::Vector3f a = mesh.vertices.col(mesh.faces(0, f)), b = mesh.vertices.col(mesh.faces(1, f)),
                            c = mesh.vertices.col(mesh.faces(2, f));
      area += -0.5 * static_cast<double>((b - a).cross(c - a).y());
    }
    EXPECT_NEAR(area, 1, 1e-6) << primitives;
  }
  EXPECT_NE(remarks.find("lines"), std::string::npos);
  listenToReaders({});
  // glTF#1697, filament#1520: a mirrored surface still shows its outer side.
  const TriangleMesh mirrored = readTexturedMesh(stored("b.glb", squareGlb(R"(,"scale":[-2,1,1])", fan))).mesh;
  const Eigen::Vector3f a = mirrored.vertices.col(mirrored.faces(0, 0)),
                        b = mirrored.vertices.col(mirrored.faces(1, 0)),
                        c = mirrored.vertices.col(mirrored.faces(2, 0));
  EXPECT_NEAR((b - a).cross(c - a).y(), -2, 1e-6);
}

TEST(FormatReports, GltfQuantisedTextureWithATransform)
{
  const std::string folder = testFolder();
  writeImage(folder + "/a.png", Image(2, 2, 3, 200)); // gltf-rs#463
  const std::string fan = R"({"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":3,"mode":6,"material":0})";
  const TexturedMesh model = readTexturedMesh(stored(
      "a.glb",
      squareGlb("", fan,
                R"(,"images":[{"uri":"a.png"}],"textures":[{"source":0}],"extensionsUsed":["KHR_texture_transform"],)"
                R"("materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":{)"
                R"("KHR_texture_transform":{"offset":[0.25,0.5],"scale":[0.5,0.25]}}}}}])")));
  ASSERT_EQ(model.mesh.faceCount(), 2);
  for (Index i = 0; i < 6; ++i) {
    const Eigen::Vector3f p = model.mesh.vertices.col(model.mesh.faces.data()[i]);
    const Eigen::Vector2f t = model.texcoords.col(model.texcoord_faces.data()[i]);
    EXPECT_NEAR(t.x(), 0.25f + 0.5f * p.x(), 1e-5);
    EXPECT_NEAR(1 - t.y(), 0.5f + 0.25f * p.z(), 1e-5); // z is glTF's y
  }
}
} // namespace
