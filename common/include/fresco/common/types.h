// SPDX-License-Identifier: BSD-3-Clause
// The old name of <fresco/core/types.h>, for one version.
#pragma once
#include <fresco/core/types.h>
