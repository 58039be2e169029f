// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/camera.h>
#include <fresco/core/poses.h>
#include <string>
#include <vector>
namespace fresco::simulation {
/// Packs a dataset into one file of scans, `folder`/survey.e57: scans, panoramas and photographs (pinhole) of the folder
/// with their poses. Everything is held in memory.
/// @param poses world from scan, of scans/scan_NN.pcd
/// @throws std::runtime_error "PATH: reason" for a file that cannot be read or written
void writeSurvey(const std::string& folder, const std::vector<Pose>& poses, const CameraSet& photographs);
} // namespace fresco::simulation
