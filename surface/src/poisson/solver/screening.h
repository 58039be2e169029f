// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/halo.h"
#include "poisson/samples/samples.h"
#include "poisson/solver/hat_function.h"
// The screening term of Kazhdan & Hoppe 2013, "Screened Poisson Surface Reconstruction", section 4: chi shall be 0 at
// the samples p_i. It adds to the energy of depth d
//
//   alpha 2^d sum_i a_i s_i chi(p_i)^2
//
// with alpha = VolumetricOptions::point_weight, a_i the area that sample i stands for and s_i = screeningWeight() of
// its noise. In hat functions B_j, chi = sum_j x_j B_j, the linear system A x = b becomes
//
//   A_jk = integral grad B_j . grad B_k + alpha 2^d sum_i a_i s_i B_j(p_i) B_k(p_i)
//
// and b stays. The system is divided by the cell side 2^-d. With f_i, the area in faces of a cell of depth d, the
// second term of A_jk is then alpha sum_i f_i s_i B_j(p_i) B_k(p_i): the factor 2^d, which makes the term independent
// of the scale, is gone. The system stays symmetric and gains positive entries on its diagonal; with alpha = 0 it is
// the one of Kazhdan, Bolitho & Hoppe 2006.
namespace fresco::poisson {
/// s_i: noisy samples hold chi less.
/// @param noise    in cells of the depth that is solved
/// @param softness 1, less where the data are dense: see softnessOf()
inline float screeningWeight(float noise, float softness = 1.f)
{
  constexpr float gain = 2.5f;      // measured: less leaves ripples of the normal field, more follows every sample
  constexpr float tolerated = 0.2f; // noise at which the weight is halved; far beyond, it falls as 1 / variance
  return gain / (softness + noise * noise / (tolerated * tolerated));
}

/// Samples that are means of many points without noise hold chi harder than their normals, which are means over shape.
/// @param surplus depths that the data sustain beyond the finest
/// @param noise   in cells of the finest depth
float softnessOf(float surplus, float noise);

/// alpha f_i s_i at a depth. @param scale cells of the depth per finest cell
Array<float> screeningWeights(const SampleLevel& samples, float scale, float point_weight, int threads);

/// alpha f_i s_i on the complete grid of a coarse depth. @param scale cells of the grid per finest cell
inline double screeningFactor(const CoarseSample& sample, double scale, double point_weight)
{
  return point_weight * screeningWeight(sample.noise * scale) * sample.area * scale * scale;
}

/// Matrix entries of the nodes of a brick, by offsetIndex() of the other node and ownIndex().
using MatrixRows = float[27][own_nodes];

/// Adds alpha f_i s_i B_j(p_i) B_k(p_i) for the eight nodes j around a sample, as far as the brick owns them, and the
/// eight nodes k.
/// @param hat    B at the sample, in the cells of the brick
/// @param weight alpha f_i s_i
inline void addScreening(const HatWeights& hat, float weight, MatrixRows& rows)
{
  for (int j = 0; j < 8; ++j) {
    const int jx = j & 1, jy = j >> 1 & 1, jz = j >> 2;
    const int x = hat.x + jx, y = hat.y + jy, z = hat.z + jz;
    if (((x | y | z) & ~3) != 0)
      continue;
    float* row = &rows[offsetIndex(-jx, -jy, -jz)][ownIndex(x, y, z)];
    const float weighted = weight * hat.value[j];
    for (int k = 0; k < 8; ++k)
      row[offsetIndex((k & 1) - 1, (k >> 1 & 1) - 1, (k >> 2) - 1) * own_nodes] += weighted * hat.value[k];
  }
}

/// Adds alpha f_i s_i e_i B_j(p_i) to the right-hand side of the nodes j that the brick owns, of a sample that expects
/// e_i where other samples expect 0.
inline void addExpected(const HatWeights& hat, float weighted, float* right)
{
  for (int j = 0; j < 8; ++j) {
    const int x = hat.x + (j & 1), y = hat.y + (j >> 1 & 1), z = hat.z + (j >> 2);
    if (((x | y | z) & ~3) == 0)
      right[ownIndex(x, y, z)] += weighted * hat.value[j];
  }
}
} // namespace fresco::poisson
