// SPDX-License-Identifier: BSD-3-Clause
// Files made to do harm: counts that wrap, sections twice, nesting, names of other people's files, and small files that
// ask for much time or memory.
#include "common/io/memory_limit.h"
#include "io/points/point_formats.h"
#include "test_data.h"
#include <chrono>
#include <fresco/core/require.h>
#include <fresco/io/cloud_file.h>
#include <fresco/io/colmap.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/pose_file.h>
#include <fstream>
namespace {
using namespace fresco;
namespace fs = std::filesystem;

std::string put(const std::string& path, const std::string& content)
{
  std::ofstream(path, std::ios::binary) << content;
  return path;
}

template <typename T>
std::string raw(T value)
{
  return {reinterpret_cast<const char*>(&value), sizeof(value)};
}

/// Binary glTF of a JSON text and a buffer.
std::string glb(std::string json, std::string buffer = "")
{
  json.resize((json.size() + 3) / 4 * 4, ' ');
  buffer.resize((buffer.size() + 3) / 4 * 4, '\0');
  const std::string chunk =
      buffer.empty() ? ""
                     : raw<std::uint32_t>(static_cast<std::uint32_t>(buffer.size())) + std::string("BIN\0", 4) + buffer;
  return "glTF" + raw<std::uint32_t>(2) +
         raw<std::uint32_t>(static_cast<std::uint32_t>(20 + json.size() + chunk.size())) +
         raw<std::uint32_t>(static_cast<std::uint32_t>(json.size())) + "JSON" + json + chunk;
}

std::string repeated(const std::string& item, int count, const std::string& between = "")
{
  std::string text;
  for (int i = 0; i < count; ++i)
    text += (i > 0 ? between : "") + item;
  return text;
}

/// One triangle in a buffer of 36 bytes that `buffer` describes; `meshes` and `nodes` as given.
std::string triangleJson(const std::string& buffer, const std::string& primitives, const std::string& nodes)
{
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + nodes +
         R"(],"meshes":[{"primitives":[)" + primitives + R"(]}],"accessors":[{"bufferView":0,"componentType":5126,)" +
         R"("count":3,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[)" + buffer + "]}";
}
const char* const one_primitive = R"({"attributes":{"POSITION":0}})";

std::string triangleBytes()
{
  std::string bytes;
  for (const float value : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f})
    bytes += raw(value);
  return bytes;
}

#ifdef __SANITIZE_ADDRESS__
constexpr double most_seconds = 60; // instrumented code takes a few times as long
struct Limit {};                    // and keeps what it has freed
#else
constexpr double most_seconds = 10; // linear work takes one; quadratic work would take minutes
using Limit = test::MemoryLimit;
#endif

/// Whether `read` ends in time and takes no memory without measure.
template <typename Read>
void expectFast(const Read& read)
{
  [[maybe_unused]] const Limit limit{};
  const auto start = std::chrono::steady_clock::now();
  read();
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), most_seconds);
}

TEST(UntrustedVtk, ArraysOfOtherLengthThanThePoints)
{
  const std::string folder = test::scratchFolder(), head = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\n";
  const std::string one = "POINTS 1 float\n1 2 3\n", three = "POINTS 3 float\n0 0 0\n1 0 0\n0 1 0\n",
                    values = "POINT_DATA 1\nSCALARS a float 1\nLOOKUP_TABLE default\n7\n";
  EXPECT_EQ(readMesh(put(folder + "/sound.vtk", head + one + values)).fields.at("a")[0], 7);
  for (const std::string& body : {one + values + three, three + one + values, one + three, values + three,
                                  "POINT_DATA 6148914691236517206\n" + three, // times 3 is 2^64 + 2
                                  three + "POINT_DATA 3\n" + one}) {
    EXPECT_THROW(readMesh(put(folder + "/two.vtk", head + body)), std::runtime_error) << body;
    EXPECT_THROW(readCloud(folder + "/two.vtk"), std::runtime_error) << body;
  }
}

TEST(UntrustedPly, TwoElementsOfVertices)
{
  const std::string path = test::scratchFolder() + "/two.ply";
  const std::string element = "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
  put(path, "ply\nformat ascii 1.0\n" + element + element + "end_header\n1 2 3\n4 5 6\n");
  EXPECT_THROW(readMesh(path), std::runtime_error);
}

/// A PCD header of `fields` fields of 8 bytes, `count` times each.
std::string pcd(int fields, int count, std::int64_t points, const std::string& data)
{
  std::string names;
  for (int i = 0; i < fields; ++i)
    names += concat(" f", i);
  return concat("VERSION .7\nFIELDS", names, "\nSIZE", repeated(" 8", fields), "\nTYPE", repeated(" F", fields),
                "\nCOUNT", repeated(concat(' ', count), fields), "\nWIDTH ", points, "\nHEIGHT 1\nPOINTS ", points,
                "\nDATA ", data);
}

TEST(UntrustedPcd, SizesThatWrap)
{
  const std::string compressed = "binary_compressed\n" + raw<std::uint32_t>(4) + raw<std::uint32_t>(0) + "abcd";
  // 2^30 points of 2^34 bytes are 0 modulo 2^64.
  EXPECT_THROW(io::parsePcd(pcd(2048, 1 << 20, 1 << 30, compressed)), std::runtime_error);
  EXPECT_THROW(io::parsePcd(pcd(2048, 1 << 20, 1 << 30, "binary\nabcdefgh")), std::runtime_error);
  EXPECT_THROW(io::parsePcd(pcd(1, 1, 1, compressed)), std::runtime_error);
}

TEST(UntrustedPcd, FieldsWithoutBytes)
{
  const std::string head = "VERSION .7\nFIELDS x y z _\nSIZE 4 4 4 0\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 1\nHEIGHT 1\n";
  EXPECT_THROW(io::parsePcd(head + "DATA binary\n" + std::string(12, 'x')), std::runtime_error);
  const std::string padding = "VERSION .7\nFIELDS _\nSIZE 0\nTYPE U\nCOUNT 1\nWIDTH 2147483647\nHEIGHT 1\n";
  for (const char* storage : {"ascii", "binary", "binary_compressed"})
    expectFast([&] {
      EXPECT_THROW(io::parsePcd(padding + "DATA " + storage + "\n" + std::string(8, '\0')), std::runtime_error);
    });
}

TEST(UntrustedPcd, FieldsOfOneName)
{
  // The narrow one must not be read as the wide one is wide.
  const std::string head = "VERSION .7\nFIELDS x y z red green blue a a\nSIZE 4 4 4 1 1 1 1 8\nTYPE F F F U U U U F\n"
                           "COUNT 1 1 1 1 1 1 1 1000\nWIDTH 1\nHEIGHT 1\nDATA binary\n";
  const std::string path = put(test::scratchFolder() + "/a.pcd", head + std::string(12 + 4 + 8000, '\1'));
  EXPECT_EQ(readCloud(path).cloud.fields.size(), 6U);
  EXPECT_THROW(io::parsePcd("VERSION .7\nFIELDS" + repeated(" x", 20000) + "\nDATA ascii\n"), std::runtime_error);
}

TEST(UntrustedGltf, ReadsFilesBelowItsFolderOnly)
{
  const std::string folder = test::scratchFolder();
  fs::create_directories(folder + "/model/parts");
  put(folder + "/secret.bin", triangleBytes());
  put(folder + "/model/parts/own.bin", triangleBytes());
  const auto model = [&](const std::string& uri) {
    return put(folder + "/model/a.glb",
               glb(triangleJson(R"({"byteLength":36,"uri":")" + uri + "\"}", one_primitive, R"({"mesh":0})"), "BIN"));
  };
  EXPECT_EQ(readTexturedMesh(model("parts/own.bin")).mesh.faceCount(), 1);
  for (const std::string& uri :
       {std::string("../secret.bin"), folder + "/secret.bin", std::string("parts/../../secret.bin"),
        std::string("%2e%2e/secret.bin"), std::string("/dev/zero")})
    EXPECT_THROW(readTexturedMesh(model(uri)), std::runtime_error) << uri;
}

TEST(UntrustedGltf, NestingAndNumbersAreBounded)
{
  const std::string folder = test::scratchFolder(), path = folder + "/a.glb", own = R"({"byteLength":36})";
  const auto refused = [&](const std::string& json) {
    put(path, glb(json, triangleBytes()));
    expectFast([&] { EXPECT_THROW(readTexturedMesh(path), std::runtime_error); });
  };
  put(path, glb(triangleJson(own, one_primitive, R"({"mesh":0})"), triangleBytes()));
  EXPECT_EQ(readTexturedMesh(path).mesh.faceCount(), 1);
  refused(R"({"asset":{"version":"2.0"},"extras":)" + repeated("[", 100000) + repeated("]", 100000) + "}");
  refused(R"({"asset":{"version":"2.0"},"extras":)" + repeated("{\"a\":", 100000) + "0" + repeated("}", 100000) + "}");
  refused(triangleJson(own, one_primitive, repeated(R"({"mesh":0})", 1000000, ",")));
  refused(triangleJson(own, one_primitive, R"({"mesh":0,"children":[)" + repeated("0", 50000, ",") + "]}"));
  // One mesh in 90,000 places is read; as many children of each of them are no tree.
  std::string children;
  for (int i = 1; i < 90000; ++i)
    children += concat(i > 1 ? "," : "", i);
  put(path,
      glb(triangleJson(own, one_primitive, R"({"children":[)" + children + "]}" + repeated(R"(,{"mesh":0})", 89999)),
          triangleBytes()));
  expectFast([&] { EXPECT_EQ(readTexturedMesh(path).mesh.faceCount(), 89999); });
}

TEST(UntrustedGltf, SharedDataAreBounded)
{
  const std::string folder = test::scratchFolder(), path = folder + "/a.glb";
  std::string json = triangleJson(R"({"byteLength":60000})", repeated(one_primitive, 10000, ","), R"({"mesh":0})");
  json.replace(json.find("\"count\":3"), 9, "\"count\":4998");
  json.replace(json.find("\"byteLength\":36"), 15, "\"byteLength\":60000");
  put(path, glb(json, std::string(60000, '\0')));
  expectFast([&] { EXPECT_THROW(readTexturedMesh(path), std::runtime_error); });
}

TEST(UntrustedObj, ReadsImagesBelowItsFolderOnly)
{
  const std::string folder = test::scratchFolder();
  fs::create_directories(folder + "/model/maps");
  writeImage(folder + "/secret.png", Image(2, 2));
  writeImage(folder + "/model/maps/own.png", Image(2, 2));
  const std::string path =
      put(folder + "/model/a.obj", "mtllib maps/a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                                   "usemtl m\nf 1/1 2/2 3/3\n");
  const auto read = [&](const std::string& map) {
    put(folder + "/model/maps/a.mtl", "newmtl m\nmap_Kd " + map + "\n");
    return readTexturedMesh(path);
  };
  EXPECT_EQ(read("own.png").atlases.size(), 1U);
  EXPECT_EQ(read("../maps/own.png").atlases.size(), 1U);
  for (const std::string& map : {folder + "/secret.png", std::string("../../secret.png"), std::string("/etc/passwd")})
    EXPECT_THROW(read(map), std::runtime_error) << map;
  put(path, "mtllib ../../a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_THROW(readTexturedMesh(path), std::runtime_error);
}

TEST(UntrustedObj, ManyMaterialsAndCornersTakeLinearTime)
{
  const std::string folder = test::scratchFolder();
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n", polygon = "f", vertices;
  for (int i = 0; i < 150000; ++i)
    text += concat("usemtl m", i, "\nf 1 2 3\n");
  expectFast([&] { EXPECT_EQ(readTexturedMesh(put(folder + "/m.obj", text)).mesh.faceCount(), 150000); });
  for (int i = 0; i < 100000; ++i) {
    vertices += concat("v ", i, " ", (i % 317) * (i % 317), " 0\n");
    polygon += concat(' ', i + 1);
  }
  expectFast([&] { EXPECT_EQ(readMesh(put(folder + "/p.obj", vertices + polygon + "\n")).faceCount(), 99998); });
}

TEST(UntrustedCameras, NumbersOutOfRange)
{
  const std::string folder = test::scratchFolder();
  const auto read = [&](const std::string& parameters, const std::string& pose, const std::string& name) {
    put(folder + "/cameras.txt", "1 PINHOLE 640 480 " + parameters + "\n");
    put(folder + "/images.txt", "1 " + pose + " 1 " + name + "\n\n");
    return readColmap(folder);
  };
  EXPECT_EQ(read("500 500 320 240", "1 0 0 0 500000 5000000 100", "a/b.jpg").views.size(), 1U);
  for (const char* parameters : {"1e300 500 320 240", "500 1e-300 320 240", "500 500 1e300 240", "500 -1 320 240"})
    EXPECT_THROW(read(parameters, "1 0 0 0 0 0 0", "a.jpg"), std::runtime_error) << parameters;
  for (const char* pose : {"1 0 0 0 1e300 0 0", "1 0 0 0 0 -1e300 0", "1e300 0 0 0 0 0 0"})
    EXPECT_THROW(read("500 500 320 240", pose, "a.jpg"), std::runtime_error) << pose;
  for (const char* name : {"/etc/passwd", "../a.jpg", "a/../../b.jpg"})
    EXPECT_THROW(read("500 500 320 240", "1 0 0 0 0 0 0", name), std::runtime_error) << name;
  EXPECT_THROW(readPoses(put(folder + "/poses.txt", "1 0 0 1e300 0 1 0 0 0 0 1 0 0 0 0 1\n")), std::runtime_error);
}

TEST(UntrustedCameras, OnlyRotationsAndTranslationsAreRigid)
{
  const Eigen::Matrix4d still = Eigen::Matrix4d::Identity();
  EXPECT_TRUE(isRigid(still, 0));
  const auto with = [&](int row, int column, double value) {
    Eigen::Matrix4d T = still;
    T(row, column) = value;
    return T;
  };
  EXPECT_TRUE(isRigid(with(1, 1, 1.01), 0.05));
  for (const Eigen::Matrix4d& T : {with(1, 1, 1.01), with(0, 1, 0.01), with(2, 2, -1.0), with(0, 0, NAN),
                                   with(0, 3, 1e300), with(1, 3, NAN), with(3, 0, 0.1), with(3, 3, 0.0)})
    EXPECT_FALSE(isRigid(T, 1e-3)) << T;
}

TEST(UntrustedImages, DamageIsAnErrorAndSizesAreCheckedFirst)
{
  const std::string folder = test::scratchFolder();
  Image noise(128, 96);
  for (std::size_t i = 0; i < noise.data.size(); ++i)
    noise.data[i] = static_cast<std::uint8_t>(i * i * 2654435761U >> 13);
  writeImage(folder + "/a.jpg", noise);
  const std::string jpeg = readFile(folder + "/a.jpg");
  int refused = 0;
  for (std::size_t at = 700; at < jpeg.size() - 2; at += jpeg.size() / 20) {
    std::string broken = jpeg;
    broken.replace(at, 2, "\xff\xd9"); // the end, in the middle of the picture
    try {
      readImage(put(folder + "/broken.jpg", broken));
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("broken.jpg"), std::string::npos);
      ++refused;
    }
  }
  EXPECT_GE(refused, 18);
  std::string large = jpeg;
  const std::size_t frame = large.find("\xff\xc0");
  large.replace(frame + 5, 4, "\xff\xff\xff\xff"); // 65,535 x 65,535 pixels
  EXPECT_THROW(readImage(put(folder + "/large.jpg", large)), std::runtime_error);
}

TEST(UntrustedImages, SizesOfOtherFormats)
{
  const std::string folder = test::scratchFolder(), pixels(4000, '\x40');
  const auto bmp = [&](std::int32_t width, std::int32_t height) {
    return "BM" + raw<std::uint32_t>(4054) + raw<std::uint32_t>(0) + raw<std::uint32_t>(54) + raw<std::uint32_t>(40) +
           raw(width) + raw(height) + raw<std::uint16_t>(1) + raw<std::uint16_t>(24) + std::string(24, '\0') + pixels;
  };
  const auto tiff = [&](std::uint32_t width, std::uint32_t height) {
    using Entry = std::pair<std::uint16_t, std::uint32_t>;
    std::string entries;
    for (const auto& [tag, value] : {Entry{256, width}, Entry{257, height}, Entry{258, 8}, Entry{259, 1}, Entry{262, 1},
                                     Entry{273, 122}, Entry{277, 1}, Entry{278, height}, Entry{279, width * height}})
      entries += raw(tag) + raw<std::uint16_t>(4) + raw<std::uint32_t>(1) + raw(value);
    return std::string("II*\0", 4) + raw<std::uint32_t>(8) + raw<std::uint16_t>(9) + entries + raw<std::uint32_t>(0) +
           pixels;
  };
  const auto webp = [&](std::uint32_t side) { // lossless
    return "RIFF" + raw<std::uint32_t>(4020) + "WEBPVP8L" + raw<std::uint32_t>(4000) + "\x2f" +
           raw<std::uint32_t>((side - 1) | (side - 1) << 14) + pixels;
  };
  EXPECT_EQ(readImage(put(folder + "/a.bmp", bmp(40, -30))).height, 30);
  EXPECT_EQ(readImage(put(folder + "/a.tif", tiff(50, 60))).width, 50);
  const test::MemoryLimit limit; // less than any of these asks for
  for (const std::string& image : {bmp(60000, 30000), bmp(30000, -60000), tiff(60000, 30000), webp(16383)}) {
    try {
      readImage(put(folder + "/large", image));
      ADD_FAILURE() << image.substr(0, 4);
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("truncated or damaged"), std::string::npos) << error.what();
    }
  }
}
} // namespace
