// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "optimization/common/mesh_graph.h"
namespace fresco::optimization {
/// Scales the moves of single vertices down, to nothing if it must be, so that no face turns by more than 90 degrees from
/// `normals` or loses nearly all its area by its own move, unless it was so before.
/// @param normals 3xF, what the faces should look like; zero = the face is not checked
/// @return V, what is left of each move, 0..1
Eigen::VectorXf limitMoves(const MeshGraph& graph, const Positions& x, const Eigen::Matrix3Xf& normals, Positions& move,
                           int threads);

/// Draws the corners of inverted faces to the middle of their neighbours, so that they can find their place from there.
/// @param part V, how far each may go, 0..1 of the way
void relaxInverted(const MeshGraph& graph, const Eigen::VectorXf& part, Positions& x, int threads);

/// The same for vertices that limitMoves() did not let go anywhere.
/// @param left what it returned
void relaxStuck(const MeshGraph& graph, const Eigen::VectorXf& part, const Eigen::VectorXf& left, Positions& x,
                int threads);

/// Relaxes inverted faces, then puts vertices back towards `start` until no face is inverted that was not so at the
/// start. A face is inverted if its normal is more than 90 degrees from the area-weighted mean of the faces around its
/// corners.
/// @return number of vertices put back
Index repairInverted(const MeshGraph& graph, const Positions& start, const Eigen::VectorXf& part, Positions& x,
                     int threads);

/// F, 1 where the face is inverted in that sense.
std::vector<char> invertedFaces(const MeshGraph& graph, const Positions& x, int threads);
} // namespace fresco::optimization
