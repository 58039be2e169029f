// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/progress.h>
#include <fresco/core/textured_mesh.h>
namespace fresco {
/// Simplification by edge collapses in the order of their quadric error: Garland & Heckbert 1997, "Surface Simplification
/// Using Quadric Error Metrics"; with the quadrics of planes that are known up to noise: Trettner & Kobbelt 2020, "Fast and
/// Robust QEF Minimization using Probabilistic Quadrics".
struct SimplificationOptions {
  Index faces = 0;  ///< that are to be left, >= 0; 0 = as few as `error` allows
  double error = 0; ///< most that a vertex may be off the planes it stands for, mesh units, RMS, >= 0; 0 = any
  int threads = 0;  ///< 0 = all cores; the result does not depend on it
};

/// What a simplification did beside the model.
struct SimplificationFigures {
  double error = 0; ///< largest of the errors of the collapses, as SimplificationOptions::error
  /// Whether no edge is left that may collapse although neither bound is reached: each would make a hole, a handle, a flipped
  /// face or a sliver.
  bool exhausted = false;
};

/// Fewer faces. Topology stays: a manifold stays one, a closed surface closed, borders remain borders. No face turns by more
/// than 75 degrees in a collapse. Borders, seams of the texture and edges between faces with and without texture collapse along
/// themselves only, and vertices where more than two of these meet stay. Vertices that are not manifold stay. Colours, normals,
/// fields and texture coordinates are interpolated; the atlases stay as they are.
/// @param model atlases may be without pixels
/// @throws std::invalid_argument as validateMesh(), if a texture coordinate does not exist, an option is out of range or both
///         bounds are 0
/// @throws Cancelled if `progress` asks to stop
FRESCO_EXPORT TexturedMesh simplifyModel(TexturedMesh model, const SimplificationOptions& options,
                                         SimplificationFigures* figures = nullptr, const Progress& progress = {});

/// The same without texture.
FRESCO_EXPORT TriangleMesh simplifyMesh(TriangleMesh mesh, const SimplificationOptions& options,
                                        SimplificationFigures* figures = nullptr, const Progress& progress = {});
} // namespace fresco
