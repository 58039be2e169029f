// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dice.h"
#include "generator.h"
#include <string>
#include <string_view>
#include <utility>
#include <vector>
namespace fresco::fuzz {
/// Small sound folders as inputs of the target "layout": files between separators, each a line with its name and what it
/// holds. A picture that holds "4x3" is one of so many pixels.
const std::vector<std::pair<std::string, std::string>>& layouts();

/// Writes those files below `folder`; what has no name of a file there is left out.
void writeFolder(std::string_view input, const std::string& folder);

GeneratedFile layout(Dice& dice);
} // namespace fresco::fuzz
