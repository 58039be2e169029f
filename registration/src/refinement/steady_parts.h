// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "refinement/joint_refinement.h"
#include <fresco/registration/core/scan_registration.h>
#include <optional>
namespace fresco::registration {
/// Refines the body of a loose cut again against the rest, by fewer samples. A place that these move by more than the finest
/// voxel rests on a handful of edges, and there may be a second one a few voxels away: along a corridor, door frames fit
/// to each other that are not the same.
/// @param poses world from working frame, refined
/// @param options that they were refined with
/// @return where it moves; nothing if it stays, or if whole walls hold it
std::optional<FreeMotion> findUnsteadyMotion(const ScanPointers& members, const IsometryVector& poses,
                                             const LooseCut& cut, JointOptions options);
} // namespace fresco::registration
