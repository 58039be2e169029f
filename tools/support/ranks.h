// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/exchange.h>
#include <functional>
#include <string>
namespace fresco {
/// As runTool(), for a tool that is two programs: NAME, a process alone (ranks_alone.cpp), and NAME_mpi (ranks_mpi.cpp), which
/// mpirun or srun starts several times. There an error of one rank ends all, with one line that names the rank and its
/// host, and only rank 0 prints on stdout. Ranks that run another version of the program, or on another kind of
/// processor, whose results may differ in the last bits, are refused.
/// @param body gets the name of the program; with -h it is alone
int runRanks(const std::string& name, int argc, char** argv,
             const std::function<void(const std::string& program, Exchange& ranks)>& body);
} // namespace fresco
