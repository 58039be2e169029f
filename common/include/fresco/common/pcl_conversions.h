// SPDX-License-Identifier: BSD-3-Clause
// The old name of <fresco/io/texture_mesh_conversions.h>, for one version.
#pragma once
#include <fresco/core/pcl_conversions.h>
#include <fresco/io/texture_mesh_conversions.h>
