// SPDX-License-Identifier: BSD-3-Clause
#include "mpi_exchange.h"
#include "mpi_calls.h"
#include <algorithm>
namespace fresco::distributed {
namespace {
constexpr int tag = 0; // messages between two ranks arrive in the order in which they were sent

/// call(begin, count) for pieces of n elements of `bytes` each that MPI can count.
template <typename Call>
void inPieces(std::size_t n, std::size_t bytes, const Call& call)
{
  const std::size_t most = most_bytes_per_call / bytes;
  for (std::size_t begin = 0; begin < n; begin += most)
    call(begin, static_cast<int>(std::min(most, n - begin)));
}

template <typename T>
void reduce(T* values, Index n, MPI_Datatype type, MPI_Op operation, MPI_Comm all)
{
  Requests requests;
  inPieces(static_cast<std::size_t>(n), sizeof(T), [&](std::size_t begin, int count) {
    check(MPI_Iallreduce(MPI_IN_PLACE, values + begin, count, type, operation, all, requests.next()));
  });
  requests.wait();
}
} // namespace

MpiExchange::MpiExchange(MPI_Comm all)
{
  Requests requests;
  check(MPI_Comm_idup(all, &all_, requests.next()));
  requests.wait();
  check(MPI_Comm_set_errhandler(all_, MPI_ERRORS_RETURN));
  check(MPI_Comm_rank(all_, &rank_));
  check(MPI_Comm_size(all_, &size_));
}

MpiExchange::~MpiExchange() { MPI_Comm_free(&all_); }

void MpiExchange::sum(std::int64_t* values, Index n) { reduce(values, n, MPI_INT64_T, MPI_SUM, all_); }

void MpiExchange::largest(double* values, Index n) { reduce(values, n, MPI_DOUBLE, MPI_MAX, all_); }

std::int64_t MpiExchange::sumBefore(std::int64_t own)
{
  std::int64_t before = 0;
  Requests requests;
  check(MPI_Iexscan(&own, &before, 1, MPI_INT64_T, MPI_SUM, all_, requests.next()));
  requests.wait();
  return rank_ == 0 ? 0 : before; // MPI leaves it undefined there
}

std::vector<Exchange::Bytes> MpiExchange::gatherAll(Bytes own)
{
  std::vector<std::uint64_t> sizes(static_cast<std::size_t>(size_), 0);
  const std::uint64_t own_size = own.size();
  Requests counted;
  check(MPI_Iallgather(&own_size, 1, MPI_UINT64_T, sizes.data(), 1, MPI_UINT64_T, all_, counted.next()));
  counted.wait();
  std::vector<Bytes> gathered(sizes.size());
  gathered[rank_] = std::move(own);
  Requests requests;
  for (int rank = 0; rank < size_; ++rank) {
    Bytes& part = gathered[rank];
    part.resize(sizes[rank]);
    inPieces(part.size(), 1, [&](std::size_t begin, int count) {
      check(MPI_Ibcast(part.data() + begin, count, MPI_BYTE, rank, all_, requests.next()));
    });
  }
  requests.wait();
  return gathered;
}

std::vector<Exchange::Bytes> MpiExchange::deliver(std::vector<Bytes> to)
{
  std::vector<std::uint64_t> sent(static_cast<std::size_t>(size_), 0), received = sent;
  std::transform(to.begin(), to.end(), sent.begin(), [](const Bytes& bytes) { return bytes.size(); });
  Requests counted;
  check(MPI_Ialltoall(sent.data(), 1, MPI_UINT64_T, received.data(), 1, MPI_UINT64_T, all_, counted.next()));
  counted.wait();
  std::vector<Bytes> from(to.size());
  std::vector<Send> sends;
  std::vector<Receive> receives;
  for (int rank = 0; rank < size_; ++rank)
    if (rank == rank_) {
      from[rank] = std::move(to[rank]);
    } else {
      from[rank].resize(received[rank]);
      if (sent[rank] > 0)
        sends.push_back({rank, to[rank].data(), to[rank].size()});
      if (received[rank] > 0)
        receives.push_back({rank, from[rank].data(), from[rank].size()});
    }
  swap(sends, receives);
  return from;
}

void MpiExchange::swap(const std::vector<Send>& sent, const std::vector<Receive>& received)
{
  Requests requests;
  for (const Receive& message : received)
    inPieces(message.bytes, 1, [&](std::size_t begin, int count) {
      check(MPI_Irecv(static_cast<std::byte*>(message.data) + begin, count, MPI_BYTE, message.rank, tag, all_,
                      requests.next()));
    });
  for (const Send& message : sent)
    inPieces(message.bytes, 1, [&](std::size_t begin, int count) {
      check(MPI_Isend(static_cast<const std::byte*>(message.data) + begin, count, MPI_BYTE, message.rank, tag, all_,
                      requests.next()));
    });
  requests.wait();
}
} // namespace fresco::distributed
