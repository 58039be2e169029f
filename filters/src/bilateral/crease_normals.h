// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "bilateral/candidate_features.h"
#include "bilateral/smoothing_field.h"
#include <fresco/core/types.h>
#include <functional>
namespace fresco::filters {
/// @param position of a point @param candidates its own normal, then at least one other
using UseNormalCandidates = std::function<void(Index position, const std::vector<NormalCandidate>& candidates,
                                               NormalCandidateFeatures& features)>;

/// For all points beside creases: what selectCreaseNormals() selects from. Different points at the same time.
void forCreaseCandidates(const SmoothingField& field, const Points& viewpoints, const Points& normals, int threads,
                         const UseNormalCandidates& use);

/// Normals of points beside creases, that is with neighbours of different normals. A neighbourhood there often holds too
/// few points of a surface to tell its normal. Candidates are the own normal, the frequent normals around and their
/// opposites; the one of the greatest CandidateScore is taken.
/// Points whose normals do not face their viewpoint, or which have none, keep their normals.
/// @param viewpoints 3x1, or 3xN by column
/// @param normals 3 x size of the tree, unit, by position: those of the field or smoother ones
/// @return such normals
Points selectCreaseNormals(const SmoothingField& field, const Points& viewpoints, const Points& normals, int threads);
} // namespace fresco::filters
