// SPDX-License-Identifier: BSD-3-Clause
// The old name of <fresco/core/mesh.h>, for one version.
#pragma once
#include <fresco/core/mesh.h>
