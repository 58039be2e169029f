// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "reference_frame.h"
#include <fresco/core/rigid_motion.h>
namespace fresco::tracking {

struct AlignmentOptions {
  int coarsest = 100; ///< level to begin at; the coarsest that there is, if that is finer
  int finest = 0;     ///< level to end at
  int iterations = 8; ///< per level, >= 1
  int threads = 0;
};

struct DenseAlignment {
  Eigen::Isometry3d T_reference_current = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Zero(); ///< of the rotation about the reference's camera (radian) and the
                                           ///< translation; scaled so that the mean over directions of translation is 1
  double overlap = 0;   ///< share of the reference's points that the current frame has a depth for, 0..1
  double agreement = 0; ///< share of these whose depths differ by less than three expected deviations, 0..1
  double rms = 0;       ///< robust, of the depth residuals, expected deviations
  double gray_rms = 0;  ///< robust, of the intensity residuals, grey levels
};

/// Whether the frames see the same place: chance gives an agreement of a third.
inline bool isAligned(const DenseAlignment& found) { return found.overlap >= 0.3 && found.agreement >= 0.6; }

/// Dense alignment of a frame with a reference frame: minimises
///   sum w (n . (T q - p) / s)^2 + sum w (I_current(T^-1 p) - a I_reference(p))^2
/// over the pose T, coarse to fine, by inverse compositional Gauss-Newton steps (Baker, Matthews 2004) with the weights
/// of a t distribution (Kerl, Sturm, Cremers 2013), both terms relative to their own deviations. The gain a is estimated.
/// @param guess reference from current
DenseAlignment alignDense(const ReferenceFrame& reference, const RgbdPyramid& current, const RgbdCameras& cameras,
                          const Eigen::Isometry3d& guess, const AlignmentOptions& options);
} // namespace fresco::tracking
