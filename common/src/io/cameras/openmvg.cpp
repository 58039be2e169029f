// SPDX-License-Identifier: BSD-3-Clause
// sfm_data.json of OpenMVG: https://openmvg.readthedocs.io/en/latest/software/SfM/SfM_OutputFormat/. Axes x right, y down, z
// forward. Centres of pixels are whole numbers, as its features and Camera_undistort_image.hpp have them; coefficients as in
// OpenCV.
#include "io/cameras/camera_format.h"
#include "io/cameras/json_values.h"
namespace fresco::io {
namespace {
constexpr double half = 0.5; ///< of a pixel, from its centre to its upper left corner

/// The members of a shared pointer as the library cereal writes it; those of a base class may lie one deeper.
Json dataOf(const Json& value, const std::string& where)
{
  Json data = memberOf(memberOf(value, "ptr_wrapper", where), "data", where);
  if (data.contains("value0") && data["value0"].is_object())
    data.update(Json(data["value0"]));
  return data;
}

template <int count>
Eigen::Matrix<double, count, 1> member(const Json& json, const char* key, const std::string& where)
{
  return numbersOf<count>(memberOf(json, key, where), where + ": " + key);
}

CameraModel cameraIn(const Json& data, const std::string& where)
{
  const int width = int(wholeOf(memberOf(data, "width", where), where)),
            height = int(wholeOf(memberOf(data, "height", where), where));
  if (!data.contains("focal_length") && height > 0 && width == 2 * height)
    return sphericalCamera(width, height);
  CameraModel camera{width, height};
  camera.fx = camera.fy = member<1>(data, "focal_length", where)[0];
  const Eigen::Vector2d middle = member<2>(data, "principal_point", where);
  camera.cx = middle.x() + half, camera.cy = middle.y() + half;
  if (data.contains("disto_k1"))
    camera.k1 = member<1>(data, "disto_k1", where)[0];
  if (data.contains("disto_k3")) {
    const Eigen::Vector3d k = member<3>(data, "disto_k3", where);
    camera.k1 = k[0], camera.k2 = k[1], camera.k3 = k[2];
  }
  if (data.contains("disto_t2")) {
    const Eigen::Matrix<double, 5, 1> k = member<5>(data, "disto_t2", where);
    camera.k1 = k[0], camera.k2 = k[1], camera.k3 = k[2], camera.p1 = k[3], camera.p2 = k[4];
  }
  if (data.contains("fisheye")) {
    const Eigen::Vector4d k = member<4>(data, "fisheye", where);
    camera.k1 = k[0], camera.k2 = k[1], camera.k3 = k[2], camera.k4 = k[3];
    camera.projection = CameraProjection::fisheye;
  }
  return camera;
}

/// The values of a map, which is a list of keys and values, by their keys.
std::map<std::int64_t, const Json*> valuesOf(const Json& json, const char* name)
{
  std::map<std::int64_t, const Json*> values;
  for (const Json& entry : memberOf(json, name, "it"))
    values[wholeOf(memberOf(entry, "key", name), name)] = &memberOf(entry, "value", name);
  return values;
}

void addPoints(const Json& json, const std::map<std::int64_t, int>& numbers, CameraFileBuilder& cameras)
{
  for (const auto& [key, point] : valuesOf(json, "structure")) {
    std::vector<Observation> track;
    for (const auto& [view, seen] : valuesOf(*point, "observations"))
      if (const auto number = numbers.find(view); number != numbers.end())
        track.push_back({number->second, member<2>(*seen, "x", "an observation").array() + half});
    cameras.addPoint(member<3>(*point, "X", "a point"), Eigen::Vector3d::Zero(), track);
  }
}
} // namespace

bool isOpenMvg(std::string_view head) { return head.find("\"sfm_data_version\"") != head.npos; }

void readOpenMvg(const std::string& content, CameraFileBuilder& cameras)
{
  const Json json = parsedJson(content);
  const auto lenses = valuesOf(json, "intrinsics"), poses = valuesOf(json, "extrinsics");
  std::map<std::int64_t, int> numbers;
  for (const auto& [key, value] : valuesOf(json, "views")) {
    const Json view = dataOf(*value, "a view");
    const std::string name = stringOf(memberOf(view, "filename", "a view"), "filename"), where = "photograph " + name;
    const std::string below = view.contains("local_path") ? stringOf(view["local_path"], "local_path") : "";
    const auto lens = lenses.find(wholeOf(memberOf(view, "id_intrinsic", where), where));
    const auto pose = poses.find(wholeOf(memberOf(view, "id_pose", where), where));
    if (pose == poses.end())
      continue;
    expect(lens != lenses.end(), where, " names an intrinsic that is not there: write it again");
    const Eigen::Matrix3d R =
        Eigen::Matrix<double, 3, 3, Eigen::RowMajor>(member<9>(*pose->second, "rotation", where).data());
    const Eigen::Vector3d center = member<3>(*pose->second, "center", where);
    numbers[key] = cameras.addView((below.empty() ? "" : below + "/") + name,
                                   cameraIn(dataOf(*lens->second, where), where), rigid(R, -(R * center)));
  }
  if (json.contains("structure"))
    addPoints(json, numbers, cameras);
}
} // namespace fresco::io
