// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/octree.h"
#include "poisson/samples/sample_ghosts.h"
namespace fresco::poisson {
/// What chi of a depth is expected to be at the samples, as its cells resolve it: 1/2 less the share of the solid in
/// what a hat function around the sample covers. At a surface that is 0. Cells that hold both sides of a sheet of
/// thickness t, in cells, see mostly the space around it: from one of its sides
///
///   1/2 - integral of 1 - x over 0..t  =  1/2 (1 - t)^2,
///
/// and the opposite around a gap. Held at 0 there, chi would be about 0 in all the empty space beside a sheet, where no
/// finer depth corrects it. Of the samples in the eight cells around a node, with their mean normal n, and with m the
/// mean of n_i . (p_i - mean p), t/2 between the sides of a sheet and -t/2 in a gap, it is
///
///   c max(0, 1 - 2 |m|)^2 m / (2 |m| + 0.04),  c = 1.2 - 2 |n| within 0..1,
///
/// 0 at surfaces, edges and corners.
/// @param cells   samples joined in the cells of `level`, with fluxes; at the finest depth, without, 0 is expected
/// @param samples that hold chi, of the level's depth or finer
/// @param finest  depth whose cells are the unit of the samples' positions
/// @return by sample, see expectedOf()
Array<float> expectedValues(const BrickLevel& level, const SampleLevel& cells, const SampleLevel& samples, int finest,
                            int threads);

/// Where both sides of a thing are as near as cells, normals cancel, and the samples alone hold chi. There, and in part
/// at edges, their noise does not count. What is thinner than a cell, t cells, would fall between the nodes. It is made
/// one cell thick: at the finest depth, where chi rises by 0.3 in a cell, -0.3 c (1 - t) / 2 is expected.
/// Where cells of the finest depth are everywhere (min_depth), solveBase() expects 0.
/// @param normals of the samples of the finest depth, ghosts among them
/// @param finest  receives `expected`
void holdThin(const Octree& tree, const SampleGhosts& ghosts, const Array<Eigen::Vector3f>& normals,
              SampleLevel& finest, int threads);

inline float expectedOf(const Array<float>& values, Index sample) { return values.empty() ? 0.f : values[sample]; }
} // namespace fresco::poisson
