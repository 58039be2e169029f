// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "draw_mesh.h"
#include <array>
#include <fresco/core/image.h>
#include <vtkActor.h>
#include <vtkSmartPointer.h>
namespace fresco::rendering {
/// How a DrawMesh looks. Its own colours (per face, else per vertex) replace `color`.
struct SurfaceLook {
  std::array<double, 3> color{0.80, 0.80, 0.78}; ///< 0..1
  bool lit = true;
  double ambient = 0.0;       ///< share of the colour that shows without light, 0..1
  double specular = 0.0;      ///< strength of the highlight, 0..1
  double edge_strength = 0.0; ///< 0 = no edges, 1 = black edges
  double size = 1.0;          ///< of points and edges, pixels
  bool cull_back_faces = false;
  const Image* texture = nullptr; ///< RGB or grey, needs texture coordinates
  bool mipmap = true;             ///< filter the texture where it is drawn small
};

/// `mesh` is used in place: it must outlive the actor.
vtkSmartPointer<vtkActor> makeActor(DrawMesh& mesh, const SurfaceLook& look);

/// After a change of the mesh that the actor was made from.
void update(vtkActor& actor, DrawMesh& mesh);

/// `image` halved (mean of 2x2) until no side is above `largest`.
Image shrinkTo(Image image, int largest);
} // namespace fresco::rendering
