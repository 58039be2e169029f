// SPDX-License-Identifier: BSD-3-Clause
// The old name of <fresco/core/point_set.h>, for one version.
#pragma once
#include <fresco/core/point_set.h>
