// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/exchange.h>
#include <mpi.h>
namespace fresco::distributed {
/// Over a communicator of its own.
class MpiExchange : public Exchange {
public:
  explicit MpiExchange(MPI_Comm all);
  ~MpiExchange() override;

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  void sum(std::int64_t* values, Index n) override;
  void largest(double* values, Index n) override;
  std::int64_t sumBefore(std::int64_t own) override;
  std::vector<Bytes> gatherAll(Bytes own) override;
  std::vector<Bytes> deliver(std::vector<Bytes> to) override;
  void swap(const std::vector<Send>& sent, const std::vector<Receive>& received) override;

private:
  MPI_Comm all_ = MPI_COMM_NULL;
  int rank_ = 0, size_ = 1;
};
} // namespace fresco::distributed
