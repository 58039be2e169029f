// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/search/neighbors.h>
namespace fresco {
/// Area of the surface that each point stands for, length^2, by position: that of a disc through the k-th other
/// neighbour, over k. Where more than k points coincide it is a thousandth of the smallest area of the others. At the
/// boundary of a surface it is up to twice too large.
/// @param k other points, >= 1
FRESCO_EXPORT Eigen::VectorXf sampleAreas(const PointTree& tree, int k = 8, int threads = 0);

/// As above with the last neighbour of each list, from nearestLists().
FRESCO_EXPORT Eigen::VectorXf sampleAreas(const PointTree& tree, const NeighborLists& lists, int threads = 0);
} // namespace fresco
