// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "views/visibility.h"
namespace fresco::texture {
/// Cuts the patches that no view shows whole, though some view shows a part of them, to an eighth of their side: what
/// is seen beside something that stands before it can then be painted, and only the rest is unseen.
PatchMesh cutHiddenParts(PatchMesh patches, const VisibilityInput& input);
} // namespace fresco::texture
