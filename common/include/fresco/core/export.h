// SPDX-License-Identifier: BSD-3-Clause
#pragma once
/// Marks what users of the shared libraries may call. All else stays inside its library, so that private types of one
/// name in two modules never meet.
#define FRESCO_EXPORT __attribute__((visibility("default")))
