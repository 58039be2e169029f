// SPDX-License-Identifier: BSD-3-Clause
// Files as other programs and people write them: each stands for a kind. What was guessed or left out is remarked.
#include "common/io/e57_file.h"
#include "common/io/test_io_data.h"
#include <fresco/io/cloud_file.h>
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_files.h>
#include <fresco/io/point_io.h>
#include <fresco/io/reading.h>
#include <fresco/io/scan_file.h>
#include <fresco/io/scan_images.h>
namespace {
using namespace fresco;
using test::stored;
using test::testFolder;

/// What readers remark while it lives.
class Remarks {
public:
  Remarks()
  {
    listenToReaders([this](const std::string& line) { all_ += line + "\n"; });
  }
  ~Remarks() { listenToReaders({}); }
  bool have(const std::string& words) const { return all_.find(words) != std::string::npos; }
  const std::string& all() const { return all_; }

private:
  std::string all_;
};

/// What a text cloud of three points means: names of its columns in order, then the values of its second row.
struct Table {
  const char *name, *content;
  std::vector<std::string> columns;
  std::vector<double> second;
  bool is_guess = false;
};

double fieldValue(const CloudFile& file, const std::string& name, std::size_t row)
{
  const PointSet points = toPointSet(file);
  const Index i = static_cast<Index>(row);
  for (Index k = 0; k < 3; ++k) {
    const std::string axis(1, "xyz"[k]);
    if (name == axis)
      return points.points(k, i) + points.origin[k];
    if (name == "normal_" + axis)
      return points.normals.cols() > 0 ? points.normals(k, i) : NAN;
    const char* const colors[] = {"red", "green", "blue"};
    if (name == colors[k])
      return points.colors.cols() > 0 ? points.colors(k, i) : NAN;
  }
  for (const auto& field : file.cloud.fields)
    if (field.name == name && field.datatype == pcl::PCLPointField::FLOAT32) {
      float value = 0;
      std::memcpy(&value, &file.cloud.data[row * file.cloud.point_step + field.offset], sizeof(value));
      return value;
    }
  return NAN;
}

const std::vector<std::string> xyz = {"x", "y", "z"}, xyzrgb = {"x", "y", "z", "red", "green", "blue"},
                               xyzirgb = {"x", "y", "z", "intensity", "red", "green", "blue"},
                               xyzn = {"x", "y", "z", "normal_x", "normal_y", "normal_z"};

const Table tables[] = {
    {"header.txt", "X,Y,Z,R,G,B\n1.5,2,3,10,20,30\n4.5,5,6,40,50,60\n7.5,8,9,1,2,3\n", xyzrgb, {4.5, 5, 6, 40, 50, 60}},
    {"quotes.txt",
     "\"X\";\"Y\";\"Z\";\"R\";\"G\";\"B\"\n1.5;2;3;10;20;30\n4.5;5;6;40;50;60\n7;8;9;1;2;3\n",
     xyzrgb,
     {4.5, 5, 6, 40, 50, 60}},
    {"table.csv",
     "x,y,z,red,green,blue\n1.5,2,3,10,20,30\n4.5,5,6,40,50,60\n7.5,8,9,1,2,3\n",
     xyzrgb,
     {4.5, 5, 6, 40, 50, 60}},
    {"mark.csv", "\xEF\xBB\xBFx,y,z\r\n1.5,2,3\r\n4.5,5,6\r\n7,8,9\r\n", xyz, {4.5, 5, 6}},
    {"comma.txt", "1,5;2,25;3\n4,5;5,25;6\n7,5;8;9\n", xyz, {4.5, 5.25, 6}},
    {"comma_tab.txt", "X\tY\tZ\n1,5\t2,25\t3\n4,5\t5,25\t6\n7,5\t8\t9\n", xyz, {4.5, 5.25, 6}},
    {"comma_blank.asc", "1,5 2,25 3,0\n4,5 5,25 6,0\n7,5 8,0 9,0\n", xyz, {4.5, 5.25, 6}},
    {"units.txt",
     "// Easting [m];Northing [m];Z (m);Intensity\n1;2;3;100\n4;5;6;200\n7;8;9;300\n",
     {"x", "y", "z", "intensity"},
     {4, 5, 6, 200}},
    {"order.txt", "Intensity z y x\n7 3 2 1\n8 6 5 4\n9 9 8 7\n", {"intensity", "z", "y", "x"}, {8, 6, 5, 4}},
    {"cloudcompare.asc",
     "//X Y Z Rf Gf Bf Nx Ny Nz\n3\n1 2 3 0 0.5 1 0 0 1\n4 5 6 1 0.5 0 0 1 0\n7 8 9 0 0 0 1 0 0\n",
     {"x", "y", "z", "red", "green", "blue", "normal_x", "normal_y", "normal_z"},
     {4, 5, 6, 255, 128, 0, 0, 1, 0}},
    {"paraview.csv", "\"Points:0\",\"Points:1\",\"Points:2\"\n1,2,3\n4,5,6\n7,8,9\n", xyz, {4, 5, 6}},
    {"behind.xyz", "1 2 3 # the first\n4 5 6 // the second\n7 8 9\n", xyz, {4, 5, 6}},
    {"empty.csv", "x,y,z,intensity\n1,2,3,\n4,5,6,7\n8,9,10,\n", {"x", "y", "z", "intensity"}, {4, 5, 6, 7}},
    {"irgb.txt", "1 2 3 200 10 20 30\n4 5 6 90 40 50 60\n7 8 9 5 1 2 3\n", xyzirgb, {4, 5, 6, 90, 40, 50, 60}, true},
    {"rgbi.txt",
     "1 2 3 100 101 102 3\n4 5 6 40 41 42 250\n7 8 9 201 202 203 90\n",
     {"x", "y", "z", "red", "green", "blue", "intensity"},
     {4, 5, 6, 40, 41, 42, 250},
     true},
    {"rgba.txt",
     "1 2 3 100 10 2 255\n4 5 6 40 41 42 255\n7 8 9 2 20 203 255\n",
     {"x", "y", "z", "red", "green", "blue"},
     {4, 5, 6, 40, 41, 42},
     true},
    {"floor.xyz", "1 2 3 0 0 1\n4 5 6 0 0 1\n7 8 9 0 0 1\n", xyzn, {4, 5, 6, 0, 0, 1}, true},
    {"fractions.xyz", "1 2 3 0.1 0.2 0.3\n4 5 6 1 0.2 0\n7 8 9 0 0 0.4\n", xyzrgb, {4, 5, 6, 255, 51, 0}, true},
    {"rgbn.xyz",
     "1 2 3 9 8 7 0 0 1\n4 5 6 255 0 0 0.6 0 -0.8\n7 8 9 1 2 3 1 0 0\n",
     {"x", "y", "z", "red", "green", "blue", "normal_x", "normal_y", "normal_z"},
     {4, 5, 6, 255, 0, 0, 0.6, 0, -0.8},
     true},
    {"color16.xyz", "1 2 3 0 256 65535\n4 5 6 32768 512 0\n7 8 9 0 0 1\n", xyzrgb, {4, 5, 6, 128, 2, 0}, true},
    {"nan.xyz", "1.#QNAN -1.#IND nan\n4 5 6\n7 8 1.#INF\n", xyz, {4, 5, 6}}};

TEST(AsOthersWrite, TextClouds)
{
  for (const Table& table : tables) {
    SCOPED_TRACE(table.name);
    const Remarks remarks;
    const CloudFile file = readCloud(stored(table.name, table.content));
    ASSERT_EQ(file.cloud.width, 3u);
    for (std::size_t c = 0; c < table.columns.size(); ++c)
      EXPECT_NEAR(fieldValue(file, table.columns[c], 1), table.second[c], 1e-6) << table.columns[c];
    EXPECT_EQ(remarks.have("no names of columns"), table.is_guess) << remarks.all();
  }
}

TEST(AsOthersWrite, TextCloudsThatAreNotClearAreRefused)
{
  const std::tuple<const char*, const char*, const char*> cases[] = {
      {"1,05,2,50,7,00\n3,05,4,50,8,00\n", "6 whole numbers", "3 with decimal commas"},
      {"1 2 3 .1 .2 .3 .4\n4 5 6 .4 .5 .7 .2\n", "x y z red green blue intensity", "x y z intensity red green blue"},
      {"lon,lat,h\n1,2,3\n", "lon,lat,h", "-columns"},
      {"x,y,z,i\n1,2,3,4,5\n", "names 4 columns", "the rows have 5"},
      {"1 2 3\nx y z\n", "line 2", "not a number"}};
  for (const auto& [content, one, other] : cases) {
    const std::string error = test::errorOf([c = content] { readPoints(stored("a.txt", c)); });
    EXPECT_NE(error.find(one), std::string::npos) << content << error;
    EXPECT_NE(error.find(other), std::string::npos) << content << error;
  }
}

TEST(AsOthersWrite, ColumnsAreAsTheUserSays)
{
  setTextColumns({"intensity", "x", "y", "z", "-"});
  const PointSet points = readPoints(stored("a.csv", "lon,lat,h,a,b\n9,1,2,3,0\n8,4,5,6,0\n"));
  EXPECT_EQ(points.points.col(1), Eigen::Vector3f(4, 5, 6));
  EXPECT_EQ(points.intensities[1], 8.f);
  EXPECT_EQ(points.colors.cols(), 0);
  EXPECT_THROW(readPoints(stored("b.txt", "1 2 3\n")), std::runtime_error);
  setTextColumns({});
  EXPECT_EQ(readPoints(stored("b.txt", "1 2 3\n")).size(), 1);
  EXPECT_THROW(setTextColumns({"x", "y"}), std::invalid_argument);
}

/// A PLY of three vertices with colours in fields of `type`.
std::string coloredPly(const std::string& type, const char* const (&rows)[3])
{
  std::string text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
  for (const char* channel : {"red", "green", "blue"})
    text += "property " + type + " " + channel + "\n";
  text += "end_header\n";
  for (const char* row : rows)
    text += std::string("0 0 0 ") + row + "\n";
  return text;
}

TEST(AsOthersWrite, ColoursByTypeAndValues)
{
  const struct {
    const char* type;
    const char* rows[3];
    int green; ///< of the second row
  } cases[] = {{"float", {"0 0 0", "200 100.4 50", "255 255 255"}, 100},
               {"float", {"0 0 0", "0.5 0.2 0", "1 1 1"}, 51},
               {"double", {"0 0 0", "0 65535 0", "256 0 0"}, 255},
               {"ushort", {"0 0 0", "9 77 0", "255 0 0"}, 77},
               {"ushort", {"0 0 0", "9 5120 0", "65535 0 0"}, 20},
               {"int", {"0 0 0", "9 77 0", "255 0 0"}, 77},
               {"char", {"0 0 0", "9 -1 0", "127 0 0"}, 255},
               {"uchar", {"0 0 0", "1 1 0", "0 1 0"}, 1}};
  for (const auto& [type, rows, green] : cases) {
    SCOPED_TRACE(type + std::string(" ") + rows[1]);
    const std::string path = stored("a.ply", coloredPly(type, rows));
    EXPECT_EQ(readPoints(path).colors(1, 1), green);
    EXPECT_EQ(readMesh(path).colors(1, 1), green);
    EXPECT_EQ(toPointSet(readCloud(path)).colors(1, 1), green);
  }
  std::string binary = coloredPly("ushort", {"", "", ""});
  binary = binary.substr(0, binary.find("0 0 0"));
  binary.replace(binary.find("ascii"), 5, "binary_little_endian");
  for (const int value : {3, 77, 200})
    for (const char* none = "\0\0\0\0\0\0\0\0\0\0\0\0"; none;) {
      binary += std::string(none, 12) + std::string(1, char(value)) + std::string(1, '\0') + std::string(4, '\0');
      none = nullptr;
    }
  Colors all(3, 0);
  openPointFiles({{stored("b.ply", binary), -1}}, 1)->read([&](const PointSet& window) {
    all.conservativeResize(3, all.cols() + window.size());
    all.rightCols(window.size()) = window.colors;
  });
  EXPECT_EQ(all.row(0).cast<int>(), Eigen::RowVector3i(3, 77, 200)); // windows agree on what stands for white
}

std::string asciiPcd(const std::string& fields, const std::string& sizes, const std::string& types,
                     const std::string& rows)
{
  const auto count = std::to_string(std::count(rows.begin(), rows.end(), '\n'));
  return "VERSION .7\nFIELDS " + fields + "\nSIZE " + sizes + "\nTYPE " + types + "\nWIDTH " + count +
         "\nHEIGHT 1\nPOINTS " + count + "\nDATA ascii\n" + rows;
}

TEST(AsOthersWrite, Pcd)
{
  CloudFile file = readCloud(stored("a.pcd", asciiPcd("x y z intensity", "4 4 4 1", "F F F U",
                                                      "1.5 2.5 .5 128.0 # first\n-1.#IND 1.#QNAN -nan(ind) 0\n"
                                                      "1e+000 +2.5 .5 7\n")));
  const PointSet points = toPointSet(file);
  EXPECT_EQ(points.intensities[0], 128.f);
  EXPECT_TRUE(points.points.col(1).array().isNaN().all());
  EXPECT_EQ(points.points.col(2), Eigen::Vector3f(1, 2.5f, 0.5f));
  for (const auto& [type, value] :
       {std::pair("U", "-14536902"), {"I", "4280430394"}, {"I", "-14536902"}, {"F", "2240314"}}) {
    const PointSet packed = readPoints(stored("b.pcd", asciiPcd("x y z rgb", "4 4 4 4", std::string("F F F ") + type,
                                                                std::string("0 0 0 ") + value + "\n0 0 1 0\n")));
    EXPECT_EQ(packed.colors.col(0).cast<int>(), Eigen::Vector3i(0x22, 0x2F, 0x3A)) << type << value;
  }
  const PointSet named =
      readPoints(stored("c.pcd", asciiPcd("x y z nx ny nz", "4 4 4 4 4 4", "F F F F F F", "1 2 3 0 0 1\n")));
  EXPECT_EQ(named.normals.col(0), Eigen::Vector3f(0, 0, 1));
}

TEST(AsOthersWrite, Obj)
{
  const std::string folder = testFolder();
  const std::string corners = "v 0 0 0\nv 1 0 0 # behind\nv 0 1 0\n";
  const TriangleMesh parts = readMesh(stored("a.obj", corners + "v 2 0 0 200 40 20\nv 3 0 0 200 40 20\nf 1 2 3\n"));
  EXPECT_EQ(parts.colors.col(0).cast<int>(), Eigen::Vector3i(255, 255, 255));
  EXPECT_EQ(parts.colors.col(4).cast<int>(), Eigen::Vector3i(200, 40, 20));
  writeImage(folder + "/red.png", Image(2, 2, 3, 200));
  std::filesystem::create_directory(folder + "/tex");
  writeImage(folder + "/tex/a b.png", Image(2, 2, 3, 90));
  test::writeText(folder + "/one.mtl", "newmtl one # a comment\nmap_Kd -s 2 2 1 -clamp on red.png\n");
  test::writeText(folder + "/two.mtl", "newmtl two\nmap_Kd \"tex\\a b.png\"\n");
  for (const char* libraries : {"one.mtl two.mtl", ".\\one.mtl .\\two.mtl"}) {
    const Remarks remarks;
    const TexturedMesh model = readTexturedMesh(
        stored("b.obj", std::string("mtllib ") + libraries + "\n" + corners +
                            "vt 0.5\nvt 0\nvt 1 1 0\nusemtl one\nf 1/1 2/2 3/3\nusemtl two # x\nf 1/1 2/2 3/3\n"
                            "usemtl none\nf 1/1 2/2 3/3\n"));
    EXPECT_EQ(model.face_atlas, Eigen::Vector3i(0, 1, -1));
    EXPECT_EQ(model.texcoords.col(0), Eigen::Vector2f(0.5f, 0));
    EXPECT_TRUE(remarks.have("'none'")) << remarks.all();
  }
}

TEST(AsOthersWrite, TexturedPly)
{
  const std::string folder = testFolder();
  writeImage(folder + "/a b.png", Image(2, 2, 3, 90));
  writeImage(folder + "/c.png", Image(2, 2, 3, 10));
  const std::string head = "ply\nformat ascii 1.0\ncomment TextureFile a b.png\ncomment TextureFile c.png\n"
                           "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string rows[] = {"0 0 0", "1 0 0", "1 1 0", "0 1 0"};
  std::string wedge = head +
                      "element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n"
                      "property int texnumber\nend_header\n";
  for (const std::string& row : rows)
    wedge += row + "\n";
  wedge += "4 0 1 2 3 8 0 0 1 0 1 1 0 1 1\n3 0 1 2 6 0 0 1 0 1 1 -1\n";
  const TexturedMesh model = readTexturedMesh(stored("wedge.ply", wedge));
  EXPECT_EQ(model.face_atlas, Eigen::Vector3i(1, 1, -1));
  EXPECT_EQ(model.texcoords.col(model.texcoord_faces(2, 1)), Eigen::Vector2f(0, 1));
  wedge.replace(wedge.find("int texnumber"), 3, "float").replace(wedge.rfind("-1"), 2, "nan");
  EXPECT_EQ(readTexturedMesh(stored("nan.ply", wedge)).face_atlas, model.face_atlas);
  std::string smooth =
      head + "property float s\nproperty float t\nelement face 1\nproperty list uchar int vertex_index\nend_header\n";
  for (const std::string& row : rows)
    smooth += row + " " + row.substr(0, 3) + "\n";
  const TexturedMesh plain = readTexturedMesh(stored("smooth.ply", smooth + "3 0 1 2\n"));
  EXPECT_EQ(plain.texcoords.col(plain.texcoord_faces(2, 0)), Eigen::Vector2f(1, 1));
  EXPECT_TRUE(plain.mesh.fields.empty());
  const TexturedMesh full = test::fullTexturedMesh(5, 2);
  writeTexturedMesh(folder + "/out.ply", full);
  const TexturedMesh back = readTexturedMesh(folder + "/out.ply");
  EXPECT_EQ(back.face_atlas, full.face_atlas);
  EXPECT_EQ(back.atlases[1].data, full.atlases[1].data);
  for (Index f = 0; f < full.mesh.faceCount(); ++f)
    for (int k = 0; k < 3 && full.face_atlas[f] >= 0; ++k)
      EXPECT_EQ(back.texcoords.col(back.texcoord_faces(k, f)), full.texcoords.col(full.texcoord_faces(k, f)));
}

TEST(AsOthersWrite, PtxWithNormalsAndAScale)
{
  std::string text = "1\n2\n5 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0.001 0 0\n-0.001 0 0 0\n0 0 0.001 0\n5 0 0 1\n"
                     "1000 0 0 0.5 255 0 9 0.6 0 0.8\n0 2000 0 0.5 1 2 3 0.6 0 0.8\n";
  const PointSet points = readPoints(stored("a.ptx", text));
  EXPECT_LT((points.points.col(0) - Eigen::Vector3f(5, 1, 0)).norm(), 1e-5f);
  EXPECT_LT((points.normals.col(0) - Eigen::Vector3f(0, 0.6f, 0.8f)).norm(), 1e-5f);
  EXPECT_LT((points.viewpoints.col(0) - Eigen::Vector3f(5, 0, 0)).norm(), 1e-5f);
  EXPECT_EQ(points.colors.col(0).cast<int>(), Eigen::Vector3i(255, 0, 9));
}

TEST(AsOthersWrite, AStationThatIsBrokenDoesNotCostTheOthers)
{
  const std::string header = "1\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
  std::string squeezed = header;
  squeezed.replace(header.find("1 0 0 0"), 1, "7");
  for (const std::string& broken : {header + "1 2 3 0.5\n4 5 6 0.5\n", header + "1 2 3 0.5 one 2 3\n",
                                    "1\nx\n" + header.substr(4), squeezed + "1 2 3 0.5\n"}) {
    const Remarks remarks;
    const std::string path = stored("a.ptx", broken + header + "7 8 9 0.5\n");
    EXPECT_EQ(readScanInfos(path).size(), 2u) << broken;
    const PointSet points = readPoints(path);
    ASSERT_EQ(points.size(), 1) << broken;
    EXPECT_EQ(points.points.col(0), Eigen::Vector3f(7, 8, 9));
    EXPECT_TRUE(remarks.have("station 1")) << remarks.all();
  }
}

test::e57::Scan cartesianScan(const std::string& name, std::size_t count)
{
  test::e57::Scan scan{name, {}, count};
  for (const char* axis : {"cartesianX", "cartesianY", "cartesianZ"}) {
    test::e57::Field field{axis};
    for (std::size_t i = 0; i < count; ++i)
      field.reals.push_back(static_cast<double>(i + scan.fields.size()));
    scan.fields.push_back(field);
  }
  return scan;
}

TEST(AsOthersWrite, PartsOfAnE57ThatAreBrokenDoNotCostTheOthers)
{
  const test::e57::Image odd{"", "", "<name type=\"String\"/>"},
      good{"<sphericalRepresentation type=\"Structure\"><jpegImage type=\"Blob\" PICTURE/></sphericalRepresentation>",
           "jpeg", ""};
  test::e57::Scan vendor = cartesianScan("a", 5), flat = cartesianScan("b", 5);
  vendor.more = "<ven:points type=\"Integer\">5</ven:points>";
  flat.fields.pop_back();
  const Remarks remarks;
  const std::string path = stored("a.e57", test::e57::fileOf({vendor, flat}, {odd, good}));
  EXPECT_EQ(readScanInfos(path).size(), 2u);
  EXPECT_EQ(readPoints(path).size(), 5);
  ASSERT_EQ(readScanImages(path).size(), 1u);
  EXPECT_EQ(readScanImageBytes(path, 0), "jpeg");
  EXPECT_TRUE(remarks.have("picture 1") && remarks.have("scan 2")) << remarks.all();
}

TEST(AsOthersWrite, ColoursOfE57ByTheirValues)
{
  const auto read = [](const std::vector<double>& reals, const std::string& more) {
    test::e57::Scan scan = cartesianScan("a", 3);
    for (const char* channel : {"colorRed", "colorGreen", "colorBlue"}) {
      test::e57::Field field{channel};
      field.reals = reals;
      scan.fields.push_back(field);
    }
    scan.more = more;
    const Colors colors = readPoints(stored("a.e57", test::e57::fileOf({scan}))).colors;
    return int(colors(1, 1));
  };
  const auto limits = [](int most) {
    std::string xml = "<colorLimits type=\"Structure\">";
    for (const char* channel : {"colorRed", "colorGreen", "colorBlue"})
      xml += test::e57::element(channel + std::string("Minimum"), 0) +
             test::e57::element(channel + std::string("Maximum"), most);
    return xml + "</colorLimits>";
  };
  EXPECT_EQ(read({0, 100, 255}, ""), 100);
  EXPECT_EQ(read({0, 0.2, 1}, ""), 51);
  EXPECT_EQ(read({0, 0.2, 1}, limits(255)), 51);
  EXPECT_EQ(read({0, 100, 255}, limits(1)), 100);
  EXPECT_EQ(read({0, 100, 255}, limits(65535)), 100);
  EXPECT_EQ(read({0, 512, 1023}, limits(1023)), 128);
}

TEST(AsOthersWrite, WhatIsLeftOutIsSaid)
{
  const Remarks remarks;
  readMesh(stored("a.ply",
                  "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                  "property list uchar int ring\nelement face 1\nproperty list uchar int vertex_indices\n"
                  "property uchar label\nelement edge 1\nproperty int vertex1\nend_header\n"
                  "0 0 0 0\n1 0 0 0\n0 1 0 0\n3 0 1 2 7\n1\n"));
  EXPECT_TRUE(remarks.have("ring of vertex") && remarks.have("label of face") && remarks.have("vertex1 of edge"))
      << remarks.all();
}
} // namespace
