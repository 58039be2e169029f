// SPDX-License-Identifier: BSD-3-Clause
// To be started by mpirun; ends with 0 on all ranks if all laws hold on all.
#include "exchange_laws.h"
#include <chrono>
#include <ctime>
#include <fresco/distributed/mpi_session.h>
#include <thread>
namespace {
using namespace fresco;

MpiSession* session = nullptr;

double processorSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

TEST(MpiExchange, Laws) { test::expectExchangeLaws(session->exchange()); }

TEST(MpiExchange, ManyBytes)
{
  Exchange& ranks = session->exchange();
  constexpr std::size_t bytes = 20'000'003;
  std::vector<Exchange::Bytes> to;
  for (int other = 0; other < ranks.size(); ++other)
    to.push_back(test::message(ranks.rank(), other, bytes));
  const auto from = ranks.deliver(std::move(to));
  for (int other = 0; other < ranks.size(); ++other)
    EXPECT_TRUE(from[other] == test::message(other, ranks.rank(), bytes)) << other;
}

// Ranks that wait leave the processor to others.
TEST(MpiExchange, WaitingCostsNothing)
{
  constexpr double seconds = 1.5, share = 0.2 / 3;
  Exchange& ranks = session->exchange();
  awaitAll(ranks);
  const double start = processorSeconds();
  if (ranks.rank() == ranks.size() - 1)
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  awaitAll(ranks);
  EXPECT_LT(processorSeconds() - start, share * seconds);
}

TEST(MpiExchange, DifferencesAreNamed)
{
  Exchange& ranks = session->exchange();
  EXPECT_NO_THROW(session->requireSame("weather", "fine"));
  if (ranks.size() == 1)
    return;
  try {
    session->requireSame("weather", ranks.rank() == 1 ? "rain" : "fine");
    ADD_FAILURE() << "not noticed";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("weather differs between rank 0 on "), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(" and rank 1 on "), std::string::npos) << error.what();
  }
}
} // namespace

int main(int argc, char** argv)
{
  testing::InitGoogleTest(&argc, argv);
  MpiSession mpi;
  session = &mpi;
  std::int64_t failed = RUN_ALL_TESTS();
  mpi.exchange().sum(&failed, 1);
  return failed != 0;
}
