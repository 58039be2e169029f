// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dice.h"
#include "generator.h"
namespace fresco::fuzz {
GeneratedFile ptx(Dice& dice);
GeneratedFile pts(Dice& dice);
GeneratedFile las(Dice& dice);
GeneratedFile e57(Dice& dice); ///< without checksums, as the target wants it
GeneratedFile points3dText(Dice& dice);
GeneratedFile points3dBinary(Dice& dice);
GeneratedFile cameras(Dice& dice); ///< the extension of the file, then its text
} // namespace fresco::fuzz
