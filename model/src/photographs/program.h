// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/progress.h>
#include <functional>
#include <string>
#include <vector>
namespace fresco::model {
/// Path of an installed program, by the variable PATH; "" = not installed.
std::string findProgram(const std::string& name);

/// Runs a program to its end, and ends with it what it has started. What it writes is added to the file `log`; `hear` gets each line of it.
/// @param command  program and its words, as they are: no shell
/// @param stop     is asked ten times a second and throws to stop: the program and all it has started are killed then
/// @throws std::runtime_error with the program's last lines if it cannot be started, fails or is killed
void runProgram(const std::vector<std::string>& command, const std::string& log,
                const std::function<void(const std::string&)>& hear, const std::function<void()>& stop);
} // namespace fresco::model
