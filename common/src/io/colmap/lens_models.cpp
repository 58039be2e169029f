// SPDX-License-Identifier: BSD-3-Clause
#include "io/colmap/lens_models.h"
#include <algorithm>
#include <fresco/core/require.h>
namespace fresco::io {
namespace {
const std::vector<LensModel>& lensModels()
{
  using M = CameraModel;
  constexpr CameraProjection plane = CameraProjection::perspective, fisheye = CameraProjection::fisheye,
                             in_turn = CameraProjection::fisheye_in_turn;
  static const std::vector<LensModel> all = {
      {"SIMPLE_PINHOLE", 0, plane, {&M::fx, &M::cx, &M::cy}},
      {"PINHOLE", 1, plane, {&M::fx, &M::fy, &M::cx, &M::cy}},
      {"SIMPLE_RADIAL", 2, plane, {&M::fx, &M::cx, &M::cy, &M::k1}},
      {"RADIAL", 3, plane, {&M::fx, &M::cx, &M::cy, &M::k1, &M::k2}},
      {"OPENCV", 4, plane, {&M::fx, &M::fy, &M::cx, &M::cy, &M::k1, &M::k2, &M::p1, &M::p2}},
      {"OPENCV_FISHEYE", 5, fisheye, {&M::fx, &M::fy, &M::cx, &M::cy, &M::k1, &M::k2, &M::k3, &M::k4}},
      {"FULL_OPENCV",
       6,
       plane,
       {&M::fx, &M::fy, &M::cx, &M::cy, &M::k1, &M::k2, &M::p1, &M::p2, &M::k3, &M::k4, &M::k5, &M::k6}},
      {"FOV", 7, plane, {&M::fx, &M::fy, &M::cx, &M::cy, &M::omega}},
      {"SIMPLE_RADIAL_FISHEYE", 8, fisheye, {&M::fx, &M::cx, &M::cy, &M::k1}},
      {"RADIAL_FISHEYE", 9, fisheye, {&M::fx, &M::cx, &M::cy, &M::k1, &M::k2}},
      {"THIN_PRISM_FISHEYE",
       10,
       fisheye,
       {&M::fx, &M::fy, &M::cx, &M::cy, &M::k1, &M::k2, &M::p1, &M::p2, &M::k3, &M::k4, &M::sx1, &M::sy1}},
      {"RAD_TAN_THIN_PRISM_FISHEYE", // Project Aria's; its p0 stands where OpenCV has p2
       11,
       in_turn,
       {&M::fx, &M::fy, &M::cx, &M::cy, &M::k1, &M::k2, &M::k3, &M::k4, &M::k5, &M::k6, &M::p2, &M::p1, &M::sx1,
        &M::sx2, &M::sy1, &M::sy2}}};
  return all;
}

template <typename Test>
const LensModel& findModel(const std::string& failure, const Test& test)
{
  const auto found = std::find_if(lensModels().begin(), lensModels().end(), test);
  if (found != lensModels().end())
    return *found;
  std::string names;
  for (const LensModel& model : lensModels())
    names += (names.empty() ? "" : ", ") + std::string(model.name);
  throw std::runtime_error(failure + " is none of " + names);
}
} // namespace

const LensModel& lensModelNamed(const std::string& name, const std::string& where)
{
  return findModel(where + ": camera model " + name, [&](const LensModel& model) { return model.name == name; });
}

const LensModel& lensModelNumbered(int number, const std::string& where)
{
  return findModel(concat(where, ": camera model number ", number),
                   [&](const LensModel& model) { return model.number == number; });
}

const LensModel& lensModelOf(const CameraModel& camera)
{
  const auto has_all = [&](const LensModel& model) {
    CameraModel rest = camera; // what is left without the parameters of the model
    for (double CameraModel::*parameter : model.parameters)
      rest.*parameter = 0;
    rest.projection = CameraProjection::perspective;
    return model.projection == camera.projection && model.parameters[1] == &CameraModel::fy && !rest.hasDistortion();
  };
  const auto found = std::find_if(lensModels().begin(), lensModels().end(), has_all);
  if (found == lensModels().end())
    throw std::invalid_argument("camera: COLMAP has no model of panoramas, of skew, or of r^8 in perspective");
  return *found;
}
} // namespace fresco::io
