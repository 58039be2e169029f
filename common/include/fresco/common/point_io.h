// SPDX-License-Identifier: BSD-3-Clause
// The old name of <fresco/io/point_io.h>, for one version.
#pragma once
#include <fresco/io/point_io.h>
