// SPDX-License-Identifier: BSD-3-Clause
#include "color_camera.h"
#include "dense_alignment.h"
#include "rgbd_pyramid.h"
#include "tracking/rgbd_room.h"
#include <algorithm>
#include <gtest/gtest.h>
using namespace fresco;
using namespace fresco::test;
using namespace fresco::tracking;
namespace {
const DepthRules rules{1e-3, 0.3, 5.0};

Index placed(const RgbdTrackingResult& result)
{
  return std::count_if(result.poses.begin(), result.poses.end(), [](const Pose& pose) { return pose.has_value(); });
}

double turnOf(const Eigen::Isometry3d& T) { return Eigen::AngleAxisd(T.linear()).angle(); }

TEST(RgbdTracking, StaticCameraStays)
{
  const RgbdImage image = RgbdRoom().shoot(swing(0.3), smallCamera(), smallCamera());
  const RgbdTrackingResult result = trackRgbd(videoOf(std::vector<RgbdImage>(5, image)));
  for (const Pose& pose : result.poses)
    EXPECT_LT((pose.value() - Eigen::Matrix4d::Identity()).norm(), 1e-3) << "depths are whole millimetres";
  EXPECT_EQ(result.key_frames.size(), 1u);
  EXPECT_TRUE(result.warnings.empty());
}

TEST(RgbdTracking, SingleFrameIsTheWorld)
{
  const std::vector<RgbdImage> one = {RgbdRoom().shoot(swing(0.3), smallCamera(), smallCamera())};
  EXPECT_TRUE(trackRgbd(videoOf(one)).poses.at(0).value().isIdentity(0));
}

TEST(RgbdTracking, KnownMotionIsRecoveredForwardsAndBackwards)
{
  std::vector<Eigen::Isometry3d> truth = swingPoses(40);
  std::vector<RgbdImage> images = shootAll(truth);
  for (int way = 0; way < 2; ++way) {
    const RgbdTrackingResult result = trackRgbd(videoOf(images));
    EXPECT_EQ(placed(result), 40);
    EXPECT_LT(worstError(result.poses, truth), 0.01) << "a pixel is 1.5 cm wide at 2 m";
    EXPECT_GT(result.key_frames.size(), 2u);
    EXPECT_GT(result.loop_closures, 0) << "it comes back to where it began";
    std::reverse(truth.begin(), truth.end());
    std::reverse(images.begin(), images.end());
  }
}

TEST(RgbdTracking, ThreadsDoNotChangeABit)
{
  std::vector<Eigen::Isometry3d> truth = swingPoses(40);
  std::vector<RgbdImage> images = shootAll(truth);
  truth.resize(20);
  images.resize(20);
  RgbdTrackingOptions one, four;
  one.threads = 1;
  four.threads = 4;
  const RgbdTrackingResult a = trackRgbd(videoOf(images), one), b = trackRgbd(videoOf(images), four);
  for (std::size_t f = 0; f < images.size(); ++f)
    EXPECT_EQ(a.poses[f].value(), b.poses[f].value());
  EXPECT_LT(worstError(a.poses, truth), 0.01);
}

TEST(RgbdTracking, LensCapIsSurvived)
{
  const std::vector<Eigen::Isometry3d> truth = swingPoses(40);
  std::vector<RgbdImage> images = shootAll(truth);
  for (int f = 12; f < 24; ++f) {
    std::fill(images[f].color.data.begin(), images[f].color.data.end(), 3);
    std::fill(images[f].depth.data.begin(), images[f].depth.data.end(), 0);
  }
  const RgbdTrackingResult result = trackRgbd(videoOf(images));
  for (int f = 0; f < 40; ++f)
    EXPECT_EQ(result.poses[f].has_value(), f < 12 || f >= 24) << f;
  EXPECT_LT(worstError(result.poses, truth), 0.02);
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_NE(result.warnings[0].find("frame 12 to frame 23 (12 frames)"), std::string::npos) << result.warnings[0];
}

TEST(RgbdTracking, BlackPicturesLeaveTheDepths)
{
  const std::vector<Eigen::Isometry3d> truth = swingPoses(40);
  std::vector<RgbdImage> images = shootAll(truth);
  for (int f = 12; f < 16; ++f)
    std::fill(images[f].color.data.begin(), images[f].color.data.end(), 0);
  const RgbdTrackingResult result = trackRgbd(videoOf(images));
  EXPECT_EQ(placed(result), 40);
  EXPECT_LT(worstError(result.poses, truth), 0.02);
}

TEST(RgbdTracking, AnotherRoomIsLeftOutWithALine)
{
  std::vector<RgbdImage> images = shootAll(swingPoses(40));
  images.resize(20);
  Eigen::Isometry3d elsewhere = swing(0);
  elsewhere.rotate(Eigen::AngleAxisd(3.0, Eigen::Vector3d::UnitY()));
  for (int f = 0; f < 6; ++f)
    images.push_back(RgbdRoom(2).shoot(elsewhere, smallCamera(), smallCamera()));
  const RgbdTrackingResult result = trackRgbd(videoOf(images));
  for (int f = 0; f < 26; ++f)
    EXPECT_EQ(result.poses[f].has_value(), f < 20) << f;
  EXPECT_EQ(result.submaps[25], 1);
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_NE(result.warnings[0].find("frame 20 to frame 25"), std::string::npos) << result.warnings[0];
}

TEST(RgbdTracking, UnreadableFrameIsLostWithItsReason)
{
  const std::vector<Eigen::Isometry3d> truth = swingPoses(40);
  const std::vector<RgbdImage> images = shootAll(truth);
  RgbdVideo video = videoOf(images);
  video.read = [&](Index f) {
    if (f == 5)
      throw std::runtime_error("five: truncated");
    return images[f];
  };
  const RgbdTrackingResult result = trackRgbd(video);
  EXPECT_EQ(placed(result), 39);
  EXPECT_FALSE(result.poses[5]);
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_NE(result.warnings[0].find("five: truncated"), std::string::npos);
}

TEST(RgbdTracking, RefusesWhatIsNoVideo)
{
  std::vector<RgbdImage> images = shootAll(swingPoses(20));
  images.resize(3);
  RgbdVideo video = videoOf(images);
  RgbdTrackingOptions options;
  options.farthest = options.nearest;
  EXPECT_THROW(trackRgbd(video, options), std::invalid_argument);
  options = {};
  options.refinement_rounds = 11;
  EXPECT_THROW(trackRgbd(video, options), std::invalid_argument);
  options = {};
  options.names = {"one"};
  EXPECT_THROW(trackRgbd(video, options), std::invalid_argument);
  video.camera.k1 = 0.1;
  EXPECT_THROW(trackRgbd(video), std::invalid_argument);
  video = videoOf(images);
  video.depth_unit = 0;
  EXPECT_THROW(trackRgbd(video), std::invalid_argument);
  video.count = 0;
  EXPECT_THROW(trackRgbd(video), std::invalid_argument);
  images[2].depth = {80, 60, std::vector<std::uint16_t>(4800, 1000)};
  EXPECT_THROW(trackRgbd(videoOf(images)), std::runtime_error) << "another size";
  for (RgbdImage& image : images)
    image.depth = {160, 120, std::vector<std::uint16_t>(19200, 0)};
  EXPECT_THROW(trackRgbd(videoOf(images)), std::runtime_error) << "no depth";
  EXPECT_THROW(trackRgbd(videoOf(images), {}, [](auto, double) { return false; }), Cancelled);
}

/// Two frames of the room and the cameras.
struct PairOfFrames {
  Eigen::Isometry3d T_reference_current = swing(0.3).inverse() * swing(0.36);
  RgbdPyramid a, b;
  RgbdCameras cameras{smallCamera(), smallCamera()};
  explicit PairOfFrames(const CameraModel& color = smallCamera(),
                        const Eigen::Vector3d& offset = Eigen::Vector3d::Zero())
      : a(makePyramid(RgbdRoom().shoot(swing(0.3), smallCamera(), color, offset), rules)),
        b(makePyramid(RgbdRoom().shoot(swing(0.36), smallCamera(), color, offset), rules))
  {}
};

TEST(DenseAlignment, FindsTheMotionAndKnowsAFalseOne)
{
  const PairOfFrames pair;
  const DenseAlignment found =
      alignDense(makeReference(pair.a, pair.cameras), pair.b, pair.cameras, Eigen::Isometry3d::Identity(), {});
  const Eigen::Isometry3d off = found.T_reference_current.inverse() * pair.T_reference_current;
  EXPECT_LT(off.translation().norm(), 0.002);
  EXPECT_LT(turnOf(off), 0.002);
  EXPECT_TRUE(isAligned(found));
  const RgbdPyramid other = makePyramid(RgbdRoom(2).shoot(swing(3), smallCamera(), smallCamera()), rules);
  EXPECT_FALSE(isAligned(alignDense(makeReference(pair.a, pair.cameras), other, pair.cameras,
                                    Eigen::Isometry3d(Eigen::AngleAxisd(2, Eigen::Vector3d::UnitY())), {})));
}

/// Sums of the kernels about the true pose, moved by x in the reference's frame.
AlignmentSums sumsAt(const PairOfFrames& pair, const Eigen::Matrix<double, 6, 1>& x, const AlignmentKernels& kernels)
{
  Eigen::Isometry3d step = Eigen::Isometry3d::Identity();
  step.linear() = rotation(x.head<3>());
  step.translation() = x.tail<3>();
  const Eigen::Isometry3d T = (step * pair.T_reference_current).inverse();
  const ReferenceLevel reference(pair.a.levels[0], pair.cameras);
  const RgbdLevel& level = pair.b.levels[0];
  const Pinhole K = halved(pair.cameras.depth, 0);
  const CurrentArrays current{level.depth.data.data(),
                              level.gray.data.data(),
                              160,
                              120,
                              160,
                              120,
                              K.fx,
                              K.fy,
                              K.cx,
                              K.cy,
                              K.fx,
                              K.fy,
                              K.cx,
                              K.cy,
                              0,
                              0,
                              0};
  Linearization at{};
  for (int i = 0; i < 9; ++i)
    at.R[i] = static_cast<float>(T.linear()(i / 3, i % 3));
  for (int i = 0; i < 3; ++i)
    at.t[i] = static_cast<float>(T.translation()[i]);
  at.gate = 0.05f;
  at.gain = 1;
  at.depth_scale = 1;
  at.gray_scale = 1.f / 400;
  AlignmentSums sums;
  kernels.accumulate(reference.arrays(), 0, reference.padded(), current, at, sums);
  return sums;
}

TEST(DenseAlignment, GradientIsTheChangeOfTheResiduals)
{
  const PairOfFrames pair;
  const auto gradient = [&](const Eigen::Matrix<double, 6, 1>& x) {
    const AlignmentSums sums = sumsAt(pair, x, portableAlignmentKernels());
    Eigen::Matrix<double, 6, 1> b;
    for (int k = 0; k < 6; ++k)
      b[k] = sums.values[21 + k];
    return b;
  };
  const AlignmentSums middle = sumsAt(pair, Eigen::Matrix<double, 6, 1>::Zero(), portableAlignmentKernels());
  int diagonal = 0;
  for (int k = 0; k < 6; ++k) {
    const Eigen::Matrix<double, 6, 1> x = 0.003 * Eigen::Matrix<double, 6, 1>::Unit(k);
    const double change = (gradient(x) - gradient(-x))[k] / 0.006;
    EXPECT_NEAR(change / middle.values[diagonal], 1.0, 0.5) << k;
    diagonal += 6 - k;
  }
}

TEST(DenseAlignment, KernelsOfAllProcessorsAgree)
{
  if (!avx2AlignmentKernels())
    GTEST_SKIP() << "no AVX2";
  const PairOfFrames pair;
  const Eigen::Matrix<double, 6, 1> x = Eigen::Matrix<double, 6, 1>::Constant(0.002);
  const AlignmentSums a = sumsAt(pair, x, portableAlignmentKernels()), b = sumsAt(pair, x, *avx2AlignmentKernels());
  for (int k = 0; k < AlignmentSums::count; ++k)
    EXPECT_EQ(a.values[k], b.values[k]) << k;
}

TEST(ColorCamera, FocalLengthIsFound)
{
  const CameraModel color = smallCamera(128);
  std::vector<CalibrationPair> pairs;
  for (int k = 0; k < 6; ++k) {
    const Eigen::Isometry3d first = swing(k), second = swing(k + 0.2);
    const RgbdRoom room;
    pairs.push_back({makePyramid(room.shoot(first, smallCamera(), color), rules),
                     makePyramid(room.shoot(second, smallCamera(), color), rules), second.inverse() * first});
  }
  const RgbdCameras found = calibrateColorCamera(pairs, {smallCamera(), smallCamera()}, 0);
  EXPECT_NEAR(found.color.fx, 128, 2.5);
  EXPECT_LT(found.color_from_depth.norm(), 0.03);
  EXPECT_EQ(calibrateColorCamera({}, {smallCamera(), smallCamera()}, 0).color.fx, 140) << "nothing to learn from";
}
} // namespace
