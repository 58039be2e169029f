// SPDX-License-Identifier: BSD-3-Clause
// XML of Metashape's "Export Cameras": Agisoft, "Metashape User Manual, Professional Edition, Version 2.1", appendix D. A camera's
// transform is chunk from camera, axes x right, y down, z forward; the chunk's or component's is world from chunk. The centre
// counts from the middle of the photograph, whose first pixel has its centre at (0.5, 0.5). P1 goes with r^2 + 2 x^2: OpenCV's
// p2.
#include "io/cameras/camera_format.h"
#include "io/files/remarks.h"
#include <Eigen/Geometry>
#include <fresco/core/similarity.h>
#include <pugixml.hpp>
namespace fresco::io {
namespace {
constexpr const char* cure = ": export it again by File > Export > Export Cameras";

template <int count>
Eigen::Matrix<double, count, 1> numbersIn(pugi::xml_node node, const std::string& where)
{
  const std::string content = node.child_value();
  try {
    return Words{TextScanner(content)}.vector<count>();
  } catch (const std::runtime_error&) {
    throw std::runtime_error(concat(where, " wants ", count, " numbers", cure));
  }
}

double numberIn(pugi::xml_node node, const char* name, double otherwise)
{
  const pugi::xml_node child = node.child(name);
  return child ? numbersIn<1>(child, name)[0] : otherwise;
}

/// Of a sensor: of its calibrations the one that was adjusted.
CameraModel cameraIn(pugi::xml_node sensor)
{
  const std::string where = concat("sensor ", sensor.attribute("id").value());
  const pugi::xml_node adjusted = sensor.find_child_by_attribute("calibration", "class", "adjusted"),
                       said = adjusted ? adjusted : sensor.child("calibration"),
                       size = said.child("resolution") ? said.child("resolution") : sensor.child("resolution");
  const std::string type = said.attribute("type") ? said.attribute("type").value() : sensor.attribute("type").value();
  const int width = size.attribute("width").as_int(), height = size.attribute("height").as_int();
  if (type == "spherical" && width == 2 * height && height > 0)
    return sphericalCamera(width, height);
  expect(type == "frame" || type == "fisheye" || type == "equidistant_fisheye", where, ": a camera of type '", type,
         "' is none of frame, fisheye, spherical");
  expect(width > 0 && height > 0 && said.child("f"), where, " has no resolution or calibration with f", cure,
         " after the alignment");
  expect(numberIn(said, "p3", 0) == 0 && numberIn(said, "p4", 0) == 0, where,
         ": p3 and p4 are not read: optimise the cameras without them and export again");
  CameraModel camera{width, height};
  camera.fy = numberIn(said, "f", 0), camera.fx = camera.fy + numberIn(said, "b1", 0);
  camera.skew = numberIn(said, "b2", 0);
  camera.cx = 0.5 * width + numberIn(said, "cx", 0), camera.cy = 0.5 * height + numberIn(said, "cy", 0);
  camera.projection = type == "frame" ? CameraProjection::perspective : CameraProjection::fisheye;
  camera.k1 = numberIn(said, "k1", 0), camera.k2 = numberIn(said, "k2", 0), camera.k3 = numberIn(said, "k3", 0);
  (type == "frame" ? camera.r8 : camera.k4) = numberIn(said, "k4", 0);
  camera.p2 = numberIn(said, "p1", 0), camera.p1 = numberIn(said, "p2", 0);
  return camera;
}

/// World from chunk.
Similarity similarityIn(pugi::xml_node transform)
{
  Similarity T;
  if (const pugi::xml_node rotation = transform.child("rotation"))
    T.R = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>(numbersIn<9>(rotation, "rotation").data());
  if (const pugi::xml_node translation = transform.child("translation"))
    T.t = numbersIn<3>(translation, "translation");
  T.scale = numberIn(transform, "scale", 1);
  expect(isRotation(T.R, 1e-4) && T.scale > 0 && isInReach(T.t), "the transform of the chunk is none", cure);
  return T;
}

/// World from camera of one photograph. @param said its transform
Eigen::Matrix4d poseIn(pugi::xml_node camera, pugi::xml_node said, const std::string& name)
{
  pugi::xml_node chunk = camera.parent();
  while (chunk && std::string_view(chunk.name()) != "chunk")
    chunk = chunk.parent();
  const pugi::xml_node component =
      chunk.child("components").find_child_by_attribute("component", "id", camera.attribute("component_id").value());
  const Similarity world =
      similarityIn(component.child("transform") ? component.child("transform") : chunk.child("transform"));
  const auto numbers = numbersIn<16>(said, "photograph " + name + ": its transform");
  const Eigen::Matrix4d T = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>(numbers.data());
  const Eigen::Matrix3d R = world.R * T.topLeftCorner<3, 3>();
  return rigid(R.transpose(), -(R.transpose() * (world.scale * (world.R * T.topRightCorner<3, 1>()) + world.t)));
}
} // namespace

bool isMetashape(std::string_view head)
{
  return head.find("<document") != head.npos && head.find("<chunk") != head.npos;
}

void readMetashape(const std::string& content, CameraFileBuilder& cameras)
{
  pugi::xml_document document;
  if (const pugi::xml_parse_result result = document.load_buffer(content.data(), content.size()); !result)
    throw std::runtime_error(concat("truncated or damaged XML (", result.description(), ")", cure));
  const std::string reference = document.select_node("//chunk/reference").node().child_value();
  if (!reference.empty() && reference.rfind("LOCAL_CS", 0) != 0)
    remark("its cameras have geocentric coordinates: what they are used with must have the same, or export both in "
           "local coordinates");
  std::map<std::string, CameraModel> known;
  std::size_t without = 0;
  for (const pugi::xpath_node& found : document.select_nodes("//camera[@sensor_id]")) {
    const pugi::xml_node camera = found.node(), said = camera.child("transform");
    const std::string name = camera.attribute("label").value(), sensor = camera.attribute("sensor_id").value();
    if (!said || !camera.attribute("enabled").as_bool(true)) {
      ++without;
      continue;
    }
    expect(!name.empty(), "camera ", camera.attribute("id").value(), " has no label", cure);
    if (known.count(sensor) == 0) {
      const pugi::xml_node node = document.find_node([&](pugi::xml_node each) {
        return std::string_view(each.name()) == "sensor" && sensor == each.attribute("id").value();
      });
      expect(node, "photograph ", name, " names sensor ", sensor, ", which is not there", cure);
      known[sensor] = cameraIn(node);
    }
    cameras.addView(name, known[sensor], poseIn(camera, said, name));
  }
  if (without > 0)
    remark(concat(without, " photographs that were not aligned, or are not enabled, are left out"));
}
} // namespace fresco::io
