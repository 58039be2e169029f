// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/surface/core/volumetric_reconstruction.h>
namespace fresco::poisson {
/// Moves the vertices, attributes and faces of all ranks to rank 0, in the order of the whole; the others keep none.
void gatherMesh(Exchange& exchange, VolumetricPart& part);
} // namespace fresco::poisson
