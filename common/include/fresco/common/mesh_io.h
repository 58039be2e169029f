// SPDX-License-Identifier: BSD-3-Clause
// The old name of <fresco/io/mesh_io.h>, for one version.
#pragma once
#include <fresco/io/mesh_io.h>
