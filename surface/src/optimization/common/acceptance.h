// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "optimization/common/problem.h"
namespace fresco::optimization {
/// Shortens moves that would end outside the trust radius: as far from the datum nearest at the start as the vertex
/// was there, or data are apart, and twice their distance. Beyond, nothing says that there is a surface. Data do not tell
/// where a surface ends either, so a boundary moves across it only.
void keepTrusted(const OptimizationProblem& problem, Positions& move, int threads);

/// Distance of each datum from its face at x, mean edge lengths.
Eigen::VectorXf dataDistances(const MeshGraph& graph, const Positions& x, const DataPoints& data, int threads);

/// The part of the way from the start that the data accept: less where those around are farther from the surface than they
/// were there and than their noise explains. Finds their faces anew.
/// @param noise deviation of the data, mean edge lengths
void acceptFit(OptimizationProblem& problem, double noise, int threads);

/// The moves that are accepted: scaled down at single vertices, to nothing if it must be, so that no face turns by more
/// than 90 degrees from `normals` or loses nearly all its area by its own move, unless it was so before.
/// @param normals 3xF, what the faces should look like; zero = the face is not checked
void keepFacing(const MeshGraph& graph, const Positions& x, const Eigen::Matrix3Xf& normals, Positions& move,
                int threads);

/// Draws the corners of inverted faces to the middle of their neighbours, so that they can find their place from there.
/// @param part V, how far each may go, 0..1 of the way
void relaxInverted(const MeshGraph& graph, const Eigen::VectorXf& part, Positions& x, int threads);

/// Relaxes inverted faces, then puts vertices back towards `start` until no face is inverted that was not so at the
/// start. A face is inverted if its normal is more than 90 degrees from the area-weighted mean of the faces around its
/// corners.
/// @return number of vertices put back
Index repairInverted(const MeshGraph& graph, const Positions& start, const Eigen::VectorXf& part, Positions& x,
                     int threads);

/// F, 1 where the face is inverted in that sense.
std::vector<char> invertedFaces(const MeshGraph& graph, const Positions& x, int threads);
} // namespace fresco::optimization
