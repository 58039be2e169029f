// SPDX-License-Identifier: BSD-3-Clause
// The old name of <fresco/search/triangle_tree.h>, for one version.
#pragma once
#include <fresco/search/triangle_tree.h>
