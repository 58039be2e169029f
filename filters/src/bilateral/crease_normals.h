// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "bilateral/candidate_features.h"
#include "bilateral/smoothing_field.h"
#include <fresco/core/types.h>
#include <functional>
namespace fresco::filters {
/// @param position of a point, its own normal and the directions it may have instead, at least one
using UseOffers =
    std::function<void(Index position, const std::vector<DirectionOffer>& offers, DirectionFigures& figures)>;

/// For all points beside creases: what chooseSurfaces() chooses from. Different points at the same time.
void compareDirections(const SmoothingField& field, const Points& viewpoints, const Points& normals, int threads,
                       const UseOffers& use);

/// Beside a crease a neighbourhood often holds too few points of a surface to tell its direction, but a few directions
/// are all there are around: those of the larger surfaces, of what is parallel to them, and of what faces the other
/// way. Where the neighbours of a point have different normals, of all these directions and its own that of the
/// greatest DirectionWorth is taken.
/// Points whose normals do not face their viewpoint, or which have none, keep their normals.
/// @param viewpoints 3x1, or 3xN by column
/// @param normals 3 x size of the tree, unit, by position: those of the field or smoother ones
/// @return such normals
Points chooseSurfaces(const SmoothingField& field, const Points& viewpoints, const Points& normals, int threads);
} // namespace fresco::filters
