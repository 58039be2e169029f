// SPDX-License-Identifier: BSD-3-Clause
// The old name of <fresco/io/unfinished_files.h>, for one version.
#pragma once
#include <fresco/io/unfinished_files.h>
