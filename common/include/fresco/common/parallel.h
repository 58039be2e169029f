// SPDX-License-Identifier: BSD-3-Clause
// The old name of <fresco/core/parallel.h>, for one version.
#pragma once
#include <fresco/core/parallel.h>
