// SPDX-License-Identifier: BSD-3-Clause
// The old name of <fresco/io/cloud_file.h>, for one version.
#pragma once
#include <fresco/io/cloud_file.h>
