// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/point_set.h>
#include <fresco/core/progress.h>
namespace fresco {
struct BilateralOptions {
  int rounds = 3;      ///< >= 0; 0 = the input
  float sigma_d = 0;   ///< length, >= 0; 0 = `spacings` times the local sampling distance
  float spacings = 2;  ///< > 0, with sigma_d = 0
  float sigma_n = 15;  ///< degrees, 0 < sigma_n <= 180: normals that differ by it weigh exp(-1/2)
  int move_rounds = 0; ///< >= 0: how often points then move along their normal to the planes of their neighbours
  bool edges = true;   ///< after the first two rounds, where viewpoints are known: points beside creases change sides
  int threads = 0;     ///< 0 = all cores; the result does not depend on it
};

struct BilateralResult {
  Points points;  ///< 3xN; the input's unless options.move_rounds > 0
  Points normals; ///< 3xN, unit
};

/// Bilateral smoothing of a field of normals, which takes noise away and keeps edges:
///
///   n_i' = normalise( sum over j, |p_i - p_j| <= r, of a_j exp(-|p_i - p_j|^2 / 2 s_d^2) exp(-(1 - n_i . n_j)^2 / 2
///   s_n^2) n_j )
///
/// with r = 2 s_d, a_j the area that point j stands for (see sampleAreas()), s_n = 1 - cos(sigma_n). By default s_d
/// follows the local sampling distance, the square root of a_i. Where more than 256 points lie within r, 256 evenly
/// chosen ones are summed. Points whose position or normal is not finite, or whose normal is zero, neither change nor
/// count.
/// @param normals 3xN, of any length; an input with rounds = 0 comes back as it is
/// @throws std::invalid_argument if sizes differ or an option is out of range
/// @throws Cancelled
FRESCO_EXPORT BilateralResult smoothNormals(const Points& points, const Points& normals,
                                            const BilateralOptions& options = {}, const Progress& progress = {});

/// As above with set.points. If set.viewpoints are known, after each of the first two rounds normals beside creases are
/// compared with the directions that are frequent around, by how the neighbours lie about their planes for the noise
/// along the beams; a trained network weighs that (docs/normal_smoothing.md). Normals that do not face their viewpoint stay.
/// @param normals 3xN, facing the viewpoints; those of the set are not used
/// @throws std::invalid_argument also if the set's attributes do not fit
FRESCO_EXPORT BilateralResult smoothNormals(const PointSet& set, const Points& normals,
                                            const BilateralOptions& options = {}, const Progress& progress = {});
} // namespace fresco
