// SPDX-License-Identifier: BSD-3-Clause
#include <fresco/io/byte_hash.h>
#include <gtest/gtest.h>
#include <set>
#include <string>
using fresco::hashBytes;
namespace {
std::uint64_t hashOf(const std::string& text, std::uint64_t before = 0)
{
  return hashBytes(text.data(), text.size(), before);
}

TEST(ByteHash, TellsAnyChangeOfAByte)
{
  std::set<std::uint64_t> hashes;
  for (const std::size_t size : {1u, 7u, 8u, 9u, 40u})
    for (std::size_t i = 0; i < size; ++i)
      for (const int bit : {0, 3, 7}) {
        std::string text(size, 'x');
        text[i] = static_cast<char>(text[i] ^ 1 << bit);
        hashes.insert(hashOf(text));
      }
  EXPECT_EQ(hashes.size(), (1u + 7 + 8 + 9 + 40) * 3);
}

TEST(ByteHash, SizeAndOrderOfPartsCount)
{
  std::set<std::uint64_t> hashes{0};
  for (std::size_t size = 0; size < 20; ++size)
    hashes.insert(hashOf(std::string(size, '\0')));
  EXPECT_EQ(hashes.size(), 21u) << "zeros of any number, and none";
  EXPECT_NE(hashOf("b", hashOf("a")), hashOf("a", hashOf("b")));
  EXPECT_NE(hashOf("bc", hashOf("a")), hashOf("c", hashOf("ab")));
  EXPECT_EQ(hashOf("b", hashOf("a")), hashOf("b", hashOf("a")));
}

TEST(ByteHash, PlaceInMemoryDoesNotCount)
{
  const std::string text = "twenty-one bytes here";
  for (std::size_t shift = 0; shift < 9; ++shift) {
    const std::string moved = std::string(shift, '#') + text + "##########";
    EXPECT_EQ(hashBytes(moved.data() + shift, text.size()), hashOf(text)) << shift;
  }
}
} // namespace
