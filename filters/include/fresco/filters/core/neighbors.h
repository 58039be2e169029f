// SPDX-License-Identifier: BSD-3-Clause
// The old name of <fresco/search/neighbors.h>, for one version.
#pragma once
#include <fresco/search/neighbors.h>
