// SPDX-License-Identifier: BSD-3-Clause
// Files of scans, as their specifications have them.
#include "generator_scans.h"
#include "common/io/e57_file.h"
#include "common/io/las_writer.h"
#include "targets.h"
#include <fresco/core/require.h>
namespace fresco::fuzz {
namespace {
/// "x y z [intensity] [r g b [nx ny nz]]" of PTX and PTS.
std::string pointLine(Dice& dice, int words)
{
  std::string line = concat(dice.value(), ' ', dice.value(), ' ', dice.value());
  if (words % 3 == 1)
    line += concat(' ', 0.25 * dice.below(5));
  for (int k = 0; k < 3 && words >= 6; ++k)
    line += concat(' ', dice.below(256));
  return line + (words >= 9 ? " 0 0.6 0.8\n" : "\n");
}

int someWords(Dice& dice) { return dice.of<int>({3, 4, 6, 7, 9, 10}); }

test::e57::Field someField(Dice& dice, const std::string& name, std::size_t count)
{
  test::e57::Field field{name, dice.of<std::string>({"Float", "Integer", "ScaledInteger"})};
  field.single = dice.chance();
  field.minimum = dice.of<std::int64_t>({0, 0, -1, -5000, std::numeric_limits<std::int64_t>::min()});
  field.maximum =
      field.minimum + dice.of<std::int64_t>({0, 1, 2, 255, 65535, std::numeric_limits<std::int64_t>::max()});
  field.scale = dice.of<double>({1, 0.001, -2});
  field.offset = dice.value();
  const auto range = static_cast<std::uint64_t>(field.maximum) - static_cast<std::uint64_t>(field.minimum);
  for (std::size_t i = 0; i < count; ++i) {
    field.stored.push_back(field.minimum + dice.below(std::min<std::uint64_t>(range, 1000) + 1));
    field.reals.push_back(dice.value());
  }
  return field;
}

test::e57::Scan someScan(Dice& dice, int number)
{
  test::e57::Scan scan{concat("scan ", number), {}, std::size_t(dice.between(0, 30))};
  std::vector<std::string> names{"cartesianX", "cartesianY", "cartesianZ"};
  if (dice.below(4) == 0)
    names = {"sphericalRange", "sphericalAzimuth", "sphericalElevation"};
  const std::vector<std::vector<std::string>> more = {{"intensity"},
                                                      {"colorRed", "colorGreen", "colorBlue"},
                                                      {"rowIndex", "columnIndex"},
                                                      {"cartesianInvalidState"},
                                                      {"sphericalInvalidState"},
                                                      {"isIntensityInvalid"},
                                                      {"isColorInvalid"},
                                                      {"nor:normalX", "nor:normalY", "nor:normalZ"},
                                                      {"timeStamp"}};
  for (const auto& group : more)
    if (dice.chance())
      names.insert(names.end(), group.begin(), group.end());
  for (const std::string& name : names)
    scan.fields.push_back(someField(dice, name, scan.count));
  if (dice.chance()) {
    test::e57::Field label{"label", "String"};
    for (std::size_t i = 0; i < scan.count; ++i)
      label.texts.emplace_back(std::size_t(dice.below(200)), 'a');
    scan.fields.push_back(label);
  }
  if (dice.chance())
    scan.more += "\n" + test::e57::poseXml(dice.value(), 0, dice.value(), 2, 3);
  for (const std::string name : {"intensity", "colorRed", "colorGreen", "colorBlue"})
    if (dice.chance())
      scan.more += "\n<" + name.substr(0, 5) + "Limits type=\"Structure\">" + test::e57::element(name + "Minimum", 0) +
                   test::e57::element(name + "Maximum", dice.of<int>({1, 255, 1023, 65535})) + "</" +
                   name.substr(0, 5) + "Limits>\n";
  return scan;
}
} // namespace

GeneratedFile ptx(Dice& dice)
{
  Parts parts;
  for (int station = dice.between(1, 3); station > 0; --station) {
    const int columns = dice.between(1, 3), rows = dice.between(1, 3), words = someWords(dice);
    const std::string scale = dice.of<std::string>({"1", "0.001", "1.0"});
    parts.insert(parts.end(), {concat(columns, "\n"), concat(rows, "\n"), "1 2 3\n", "1 0 0\n", "0 1 0\n", "0 0 1\n",
                               scale + " 0 0 0\n", "0 " + scale + " 0 0\n", "0 0 " + scale + " 0\n", "1 2 3 1\n"});
    for (int i = 0; i < columns * rows; ++i)
      parts.push_back(pointLine(dice, words));
  }
  return {parts};
}

GeneratedFile pts(Dice& dice)
{
  Parts parts;
  if (dice.chance())
    parts.push_back("//X Y Z\n");
  for (int block = dice.between(1, 3); block > 0; --block) {
    const int points = dice.between(1, 5), words = someWords(dice);
    parts.push_back(concat(points, "\n"));
    for (int i = 0; i < points; ++i)
      parts.push_back(pointLine(dice, words));
  }
  return {parts};
}

GeneratedFile las(Dice& dice)
{
  test::las::File file;
  file.minor = dice.below(5);
  file.format = dice.below(file.minor == 4 ? 11 : 6);
  file.points.resize(std::size_t(dice.between(1, 6)));
  file.scale = {dice.of<double>({1, 0.001, 1e-7}), 0.001, 0.01};
  file.offset = {dice.of<double>({0, 431000, -1e9}), 0, 1};
  const bool described = dice.chance();
  file.extra_bytes = described ? dice.of<int>({1, 2, 3, 8, 9}) : dice.below(3);
  for (test::las::Point& point : file.points) {
    point.stored = {dice.below(100000) - 50000, dice.below(100000), dice.below(100000)};
    point.intensity = std::uint16_t(dice.below(65536));
    point.color = {std::uint16_t(dice.below(dice.chance() ? 256 : 65536)), 7, 9};
  }
  const std::string bytes = test::las::fileOf(file);
  const std::size_t record = test::las::recordOf(file, {}).size(), data = bytes.size() - record * file.points.size();
  std::string header = bytes.substr(0, data - 2), descriptor;
  if (described) { // a record of what extra bytes there are
    std::string head(54, '\0');
    descriptor.assign(192, '\0');
    descriptor[2] = char(dice.below(32));
    descriptor[3] = char(dice.below(32));
    descriptor.replace(4, 5, dice.of<std::string>({"extra", "inten", "green"}));
    for (const std::size_t at : {40, 112, 136})
      test::las::put(descriptor, at, dice.of<double>({0, 0.5, -1e300}));
    head.replace(2, 9, "LASF_Spec");
    test::las::put(head, 18, std::uint16_t{4});
    test::las::put(head, 20, std::uint16_t{192});
    test::las::put(header, 96, std::uint32_t(header.size() + head.size() + descriptor.size()));
    test::las::put(header, 100, std::uint32_t{1});
    descriptor = head + descriptor;
  } else {
    descriptor = "\xDD\xCC";
  }
  Parts parts{header, descriptor};
  for (std::size_t i = 0; i < file.points.size(); ++i)
    parts.push_back(bytes.substr(data + i * record, record));
  return {parts};
}

GeneratedFile e57(Dice& dice)
{
  std::vector<test::e57::Scan> scans;
  for (int i = dice.between(1, 3); i > 0; --i)
    scans.push_back(someScan(dice, i));
  std::vector<test::e57::Image> images;
  for (int i = dice.below(3); i > 0; --i) {
    const std::string kind = dice.of<std::string>({"spherical", "pinhole", "cylindrical"});
    images.push_back({"<" + kind + "Representation type=\"Structure\">\n<pngImage type=\"Blob\" PICTURE/>\n" +
                          test::e57::element("imageWidth", dice.below(100)) +
                          test::e57::element("focalLength", double(dice.value())) + "</" + kind + "Representation>",
                      "png", ""});
  }
  const std::string file = test::e57::fileOf(scans, images);
  std::string logical;
  for (std::size_t at = 0; at < file.size(); at += 1024)
    logical += file.substr(at, 1020);
  const std::size_t xml = logical.find("<?xml"), end = logical.find("</e57Root>") + 11;
  GeneratedFile result{{logical.substr(0, xml)}, GeneratedFile::Kind::e57};
  for (std::size_t at = xml; at < end;) {
    const std::size_t next = logical.find('\n', at) + 1;
    result.parts.push_back(logical.substr(at, next - at));
    at = next;
  }
  return result;
}

GeneratedFile points3dText(Dice& dice)
{
  Parts parts;
  for (int i = 1; i <= 2; ++i) {
    parts.push_back(concat(i, " 1 0 0 0 0 0 1 1 a.jpg\n"));
    parts.push_back("1 2 -1 3.5 4 7\n"); // two features
  }
  parts.insert(parts.end(), {std::string(separator), "# points\n"});
  for (int p = dice.between(1, 4); p > 0; --p) {
    std::string line = concat(p, ' ', dice.value(), " 0 1 ", dice.below(256), " 0 255 0.5");
    for (int seen = dice.below(4); seen > 0; --seen)
      line += concat(' ', dice.between(1, 2), ' ', dice.below(2));
    parts.push_back(line + "\n");
  }
  return {parts};
}

GeneratedFile points3dBinary(Dice& dice)
{
  Parts parts{raw(std::uint64_t(2))};
  for (std::uint32_t i = 1; i <= 2; ++i) {
    parts.push_back(raw(i) + raw(1.) + raw(0.) + raw(0.) + raw(0.) + raw(0.) + raw(0.) + raw(1.) +
                    raw(std::uint32_t(1)) + std::string("a.jpg\0", 6));
    parts.push_back(raw(std::uint64_t(1)) + raw(1.) + raw(2.) + raw(std::uint64_t(7)));
  }
  parts.emplace_back(separator);
  const int points = dice.between(1, 4);
  parts.push_back(raw(std::uint64_t(points)));
  for (int p = 0; p < points; ++p) {
    parts.push_back(raw(std::uint64_t(p)) + raw(double(dice.value())) + raw(0.) + raw(1.) + "rgb" + raw(0.5));
    const int seen = dice.below(4);
    std::string track = raw(std::uint64_t(seen));
    for (int k = 0; k < seen; ++k)
      track += raw(std::uint32_t(dice.between(1, 2))) + raw(std::uint32_t(0));
    parts.push_back(track);
  }
  return {parts};
}
} // namespace fresco::fuzz
