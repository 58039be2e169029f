// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/e57/content.h"
#include "io/points/e57/xml_values.h"
#include "io/points/scan_reader.h"
#include <algorithm>
#include <cmath>
#include <limits>
namespace fresco::io::e57 {
int Field::bits() const
{
  if (!isInteger())
    return type == Type::single_float ? 32 : type == Type::double_float ? 64 : 0;
  int bits = 0; // each is stored as its distance from the minimum
  for (std::uint64_t range = std::uint64_t(maximum) - std::uint64_t(minimum); range > 0; range >>= 1)
    ++bits;
  return bits;
}

std::optional<std::size_t> CompressedVector::find(std::string_view name) const
{
  const auto found = std::find_if(fields.begin(), fields.end(), [&](const Field& field) { return field.name == name; });
  return found == fields.end() ? std::nullopt : std::optional<std::size_t>(found - fields.begin());
}

namespace {
constexpr std::size_t longest_name = 200;

/// A prototype is flat in every file seen; the standard allows structures within.
constexpr int deepest_structure = 8;

/// Names of the standard; an extension that uses one again means something else.
bool isStandard(std::string_view name)
{
  for (const std::string_view begin : {"cartesian", "spherical", "color", "isColor", "intensity", "isIntensity",
                                       "return", "timeStamp", "isTimeStamp", "rowIndex", "columnIndex"})
    if (name.substr(0, begin.size()) == begin)
      return true;
  return false;
}

Field fieldOf(pugi::xml_node node)
{
  Field field;
  field.name = std::string(localName(node));
  field.own = prefixOf(node) == "fresco:";
  if (const std::string_view prefix = prefixOf(node); !prefix.empty() && isStandard(field.name))
    field.name = std::string(prefix.substr(0, prefix.size() - 1)) + "_" + field.name;
  const std::string_view type = typeOf(node);
  if (type == "Float") {
    const std::string_view precision = node.attribute("precision").as_string("double");
    field.type = precision == "single" ? Field::Type::single_float : Field::Type::double_float;
  } else if (type == "Integer" || type == "ScaledInteger") {
    field.type = type == "Integer" ? Field::Type::integer : Field::Type::scaled_integer;
    field.minimum = attributeOf<std::int64_t>(node, "minimum", std::numeric_limits<std::int64_t>::min());
    field.maximum = attributeOf<std::int64_t>(node, "maximum", std::numeric_limits<std::int64_t>::max());
    field.scale = attributeOf<double>(node, "scale", 1);
    field.offset = attributeOf<double>(node, "offset", 0);
    expect(field.maximum >= field.minimum, "field ", field.name, ": maximum ", field.maximum, " is below minimum ",
           field.minimum);
    expect(std::isfinite(field.scale) && std::isfinite(field.offset), "field ", field.name,
           ": scale or offset is not finite");
  } else if (type == "String")
    field.type = Field::Type::string;
  else
    throw std::runtime_error(concat("field ", field.name, ": type '", type.substr(0, 40), "' is not known"));
  return field;
}

void addFields(pugi::xml_node structure, int depth, std::vector<Field>& fields)
{
  constexpr std::size_t most_fields = 1000; // a packet has room for some 32,000 streams; writers use up to 20
  expect(depth <= deepest_structure, "XML: structures within structures within the prototype");
  for (const pugi::xml_node node : structure.children()) {
    if (node.type() != pugi::node_element)
      continue;
    if (typeOf(node) == "Structure")
      addFields(node, depth + 1, fields);
    else
      fields.push_back(fieldOf(node));
    expect(fields.size() <= most_fields, "XML: more than ", most_fields, " fields");
  }
}

CompressedVector vectorOf(pugi::xml_node points)
{
  expect(typeOf(points) == "CompressedVector", "XML: points are no CompressedVector");
  CompressedVector records;
  records.physical_offset = attributeOf<std::uint64_t>(points, "fileOffset");
  records.count = attributeOf<std::uint64_t>(points, "recordCount");
  addFields(childNamed(points, "prototype"), 0, records.fields);
  for (const pugi::xml_node codec : childNamed(points, "codecs").children())
    expect(codec.type() != pugi::node_element || childNamed(codec, "bitPackCodec"),
           "points are packed by another codec than bitPackCodec");
  constexpr std::uint64_t most_points = std::uint64_t{1} << 48; // far above any file; keeps sums from overflowing
  expect(records.count <= most_points, "XML: ", records.count, " points");
  return records;
}

Eigen::Isometry3d poseOf(pugi::xml_node pose)
{
  const auto rotation = childNamed(pose, "rotation"), translation = childNamed(pose, "translation");
  const auto value = [](pugi::xml_node node, const char* name, double otherwise) {
    return realIn(node, name).value_or(otherwise);
  };
  const Eigen::Quaterniond q(value(rotation, "w", rotation ? 0 : 1), value(rotation, "x", 0), value(rotation, "y", 0),
                             value(rotation, "z", 0));
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(value(translation, "x", 0), value(translation, "y", 0), value(translation, "z", 0));
  expect(q.norm() > 1e-6 && q.norm() < 1e6 && T.translation().allFinite(), "its pose is no rotation and translation");
  T.linear() = q.normalized().toRotationMatrix();
  return T;
}

std::optional<Limits> limitsIn(pugi::xml_node limits, const std::string& name)
{
  const auto low = realIn(limits, name + "Minimum"), high = realIn(limits, name + "Maximum");
  if (!low || !high || !(*high > *low) || !std::isfinite(*high - *low))
    return std::nullopt;
  return Limits{*low, *high};
}

Scan scanOf(pugi::xml_node node)
{
  Scan scan;
  scan.guid = textIn(node, "guid");
  scan.info.name = singleLine(textIn(node, "name"), longest_name);
  const pugi::xml_node points = childNamed(node, "points");
  expect(points, "XML: it has no points");
  scan.records = vectorOf(points);
  scan.info.points = scan.records.count;
  const bool spherical = !scan.records.find("cartesianX");
  if (const pugi::xml_node pose = childNamed(node, "pose")) {
    scan.info.T_file_scan = poseOf(pose);
    scan.info.has_pose = true;
  }
  if (scan.info.has_pose || spherical) // a cloud without a pose may lie anywhere
    scan.info.sensor = Eigen::Vector3d::Zero();
  if (const auto limits = limitsIn(childNamed(node, "intensityLimits"), "intensity"))
    scan.info.intensity_limits = Eigen::Array2d(limits->minimum, limits->maximum);
  const pugi::xml_node colors = childNamed(node, "colorLimits");
  scan.color = {limitsIn(colors, "colorRed"), limitsIn(colors, "colorGreen"), limitsIn(colors, "colorBlue")};
  return scan;
}

std::optional<Blob> blobIn(pugi::xml_node node, std::string_view name)
{
  const pugi::xml_node blob = childNamed(node, name);
  return blob ? std::optional(
                    Blob{attributeOf<std::uint64_t>(blob, "fileOffset"), attributeOf<std::uint64_t>(blob, "length")})
              : std::nullopt;
}

int pixels(pugi::xml_node node, const char* name)
{
  const pugi::xml_node child = childNamed(node, name);
  const std::int64_t count = child ? integerOf(child) : 0;
  expect(count >= 0 && count <= 1 << 20, "XML: ", name, ' ', count, " is out of range");
  return count;
}

/// The representation that says most of where the picture was taken.
pugi::xml_node representationOf(pugi::xml_node node, ScanImage::Projection& projection)
{
  using Projection = ScanImage::Projection;
  constexpr std::pair<const char*, Projection> all[] = {{"pinholeRepresentation", Projection::pinhole},
                                                        {"sphericalRepresentation", Projection::spherical},
                                                        {"cylindricalRepresentation", Projection::cylindrical},
                                                        {"visualReferenceRepresentation", Projection::none}};
  for (const auto& [name, kind] : all)
    if (const pugi::xml_node found = childNamed(node, name)) {
      projection = kind;
      return found;
    }
  throw std::runtime_error("XML: it has no representation");
}

Image imageOf(pugi::xml_node node, const std::vector<Scan>& scans)
{
  Image image;
  ScanImage& said = image.description;
  said.name = singleLine(textIn(node, "name"), longest_name);
  const std::string guid = textIn(node, "associatedData3DGuid");
  const auto scan =
      std::find_if(scans.begin(), scans.end(), [&](const Scan& s) { return !guid.empty() && s.guid == guid; });
  said.scan = scan == scans.end() ? -1 : std::distance(scans.begin(), scan);
  const pugi::xml_node shown = representationOf(node, said.projection);
  const auto jpeg = blobIn(shown, "jpegImage"), png = blobIn(shown, "pngImage");
  expect(jpeg || png, "XML: it has neither jpegImage nor pngImage");
  image.picture = jpeg ? *jpeg : *png;
  image.mask = blobIn(shown, "imageMask");
  said.encoding = jpeg ? ScanImage::Encoding::jpeg : ScanImage::Encoding::png;
  said.has_mask = image.mask.has_value();
  said.width = pixels(shown, "imageWidth");
  said.height = pixels(shown, "imageHeight");
  if (const pugi::xml_node pose = childNamed(node, "pose"))
    said.T_file_image = poseOf(pose);
  const auto value = [&](const char* name) { return realIn(shown, name).value_or(0); };
  said.focal_length = value("focalLength");
  said.pixel_width = value("pixelWidth");
  said.pixel_height = value("pixelHeight");
  said.principal_x = value("principalPointX");
  said.principal_y = value("principalPointY");
  said.radius = value("radius");
  return image;
}

/// @param errors gets what is wrong with its pages: what they say may be whole all the same
std::string readXml(PagedFile& file, std::vector<std::string>& errors)
{
  const Header& header = file.header();
  const std::uint64_t begin = file.logical(header.xml_offset);
  expect(header.xml_length != 0 && header.xml_length <= file.size() - begin, "truncated: the XML section has ",
         header.xml_length, " bytes, ", file.size() - begin, " are left in the file");
  std::string text(header.xml_length, '\0');
  file.readDamaged(begin, text.data(), text.size(), errors);
  return text;
}

/// add(child) for each child of a vector.
template <typename Add>
void forEachChild(pugi::xml_node vector, const char* what, std::vector<std::string>& errors, const Add& add)
{
  int number = 0;
  for (const pugi::xml_node child : vector.children())
    if (child.type() == pugi::node_element)
      attempt(concat(what, ' ', ++number), errors, [&] { add(child); });
}
} // namespace

Content parseContent(PagedFile& file)
{
  Content content;
  std::string text = readXml(file, content.errors);
  content.is_doubtful = !content.errors.empty();
  for (std::string& error : content.errors)
    error += ": what the file says of its scans may be wrong";
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer_inplace(text.data(), text.size());
  expect(parsed, content.errors.empty() ? concat("XML: ", parsed.description(), " at byte ", parsed.offset)
                                        : content.errors[0]);
  const pugi::xml_node root = document.document_element();
  expect(localName(root) == "e57Root", "XML: no e57Root");
  forEachChild(childNamed(root, "data3D"), "scan", content.errors, [&](pugi::xml_node node) {
    content.scans.emplace_back(); // without points unless it can be read
    content.scans.back() = scanOf(node);
  });
  forEachChild(childNamed(root, "images2D"), "picture", content.errors,
               [&](pugi::xml_node node) { content.images.push_back(imageOf(node, content.scans)); });
  return content;
}
} // namespace fresco::io::e57
