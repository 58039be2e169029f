// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/camera.h>
#include <fresco/simulation/scene/places.h>
#include <fresco/simulation/sensors/dataset.h>
namespace fresco::simulation {
/// Those of the lowest x, `share` of the extent.
ScenePlaces partAlongX(const ScenePlaces& samples, double share);

/// What structure from motion makes of the photographs: points on the surface, the more the sharper its pattern is, each
/// seen by two views at least, with noise; of wrong ones the distance from the first of these views is wrong by a factor of
/// up to e, and the pixels of the others with it. DatasetOptions: sparse, sparse_noise, sparse_outliers, seed.
SparsePoints sparsePoints(const LitScene& lit, const CameraSet& set, const DatasetOptions& options);

/// Brings cameras and points into a frame with a random rotation, position and scale 0.01..100.
/// @return world from that frame, a 4x4 similarity as text
std::string intoOwnFrame(CameraSet& set, SparsePoints& points, int seed);
} // namespace fresco::simulation
