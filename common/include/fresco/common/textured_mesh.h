// SPDX-License-Identifier: BSD-3-Clause
// The old name of <fresco/core/textured_mesh.h>, for one version.
#pragma once
#include <fresco/core/textured_mesh.h>
