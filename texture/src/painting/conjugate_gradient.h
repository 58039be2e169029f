// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/types.h>
#include <vector>
namespace fresco::texture {
/// Stands for the entries (i, j) and (j, i), i != j.
struct OffDiagonal {
  int i, j;
  float value;
};

/// Symmetric and positive definite, N x N.
struct SymmetricMatrix {
  const Eigen::VectorXf& diagonal;  ///< N
  std::vector<OffDiagonal> entries; ///< those of one place are summed up
};

struct SolverLimits {
  int iterations;
  float tolerance; ///< |right - A x| / |right| at which a row is solved
  int threads;
};

/// Conjugate gradients (Hestenes & Stiefel 1952), preconditioned by the diagonal; all right sides at once.
/// @param right 3xN, a right side in each row
/// @return 3xN
Points solveSymmetric(SymmetricMatrix matrix, const Points& right, const SolverLimits& limits);
} // namespace fresco::texture
