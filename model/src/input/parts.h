// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "input/layout.h"
namespace fresco::model {
// What layouts of scans, clouds and photographs are made of: each takes its files into `input` and adds a line of what it found.

/// The scans in files, with the poses that the files themselves have.
void takeScans(ModelInput& input, const Survey& found, const std::vector<std::string>& names);

/// The files of one cloud: those without faces where there are any, so that nothing is there twice.
std::vector<std::string> cloudsIn(const Survey& found);

/// poses.txt, where there is one. @throws std::runtime_error if it has another number of poses than there are scans
void takePoses(ModelInput& input, const Survey& found);

/// The scans are parts of one cloud; trajectory.txt tells where the sensor was.
void takeAsCloud(ModelInput& input, const Survey& found);

/// The photographs of cameras/ or of a file of cameras; where there is none all below images/, to be placed.
void takePhotographs(ModelInput& input, const Survey& found);
void takeUnplaced(ModelInput& input, const Survey& found, const std::string& images);
/// @param cameras as readCameraFile() takes them @throws std::runtime_error naming a photograph that is not there
void takeCameras(ModelInput& input, const Survey& found, const std::string& cameras, const std::string& images);

/// Panoramas named as their scans. @throws std::runtime_error for one that is of no scan
void takePanoramas(ModelInput& input, const Survey& found, const std::string& pattern);

/// Pictures in the same folder as the scans: panoramas where they are named as a scan, else photographs without cameras.
void takePicturesBeside(ModelInput& input, const Survey& found);

std::string readablePoints(); ///< extensions, for messages
std::string roughOnly();      ///< what a model of photographs alone lacks, and the cure
} // namespace fresco::model
