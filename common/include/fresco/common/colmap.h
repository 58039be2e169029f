// SPDX-License-Identifier: BSD-3-Clause
// The old name of <fresco/io/colmap.h>, for one version.
#pragma once
#include <fresco/io/colmap.h>
