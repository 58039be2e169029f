// SPDX-License-Identifier: BSD-3-Clause
// The old name of <fresco/io/pose_file.h>, for one version.
#pragma once
#include <fresco/io/pose_file.h>
