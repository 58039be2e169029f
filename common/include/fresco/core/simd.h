// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <cstring>
#ifdef __AVX2__
#include <immintrin.h>
#endif
/// Numbers side by side in the compiler's vector types, for inner loops that are written once and compiled twice: for any
/// processor, and with -mavx2 for those that have it. Operators work lane by lane, comparisons give 0 or -1 in each lane,
/// `mask ? a : b` chooses by lane; results have the same bits either way. All is local to the file that includes this, so
/// that the linker cannot keep AVX2 code for the whole program.
namespace fresco::simd {
namespace {
#pragma GCC diagnostic ignored "-Wpsabi" // vectors never pass from file to file
using Float4 = float __attribute__((vector_size(16)));
using Float8 = float __attribute__((vector_size(32)));
using Int4 = std::int32_t __attribute__((vector_size(16)));
using Short8 = std::int16_t __attribute__((vector_size(16)));
using Int8 = std::int32_t __attribute__((vector_size(32)));
using Double4 = double __attribute__((vector_size(32)));

inline constexpr Int8 lane_numbers = {0, 1, 2, 3, 4, 5, 6, 7};
inline constexpr Float8 infinities = Float8{} + __builtin_inff();

/// @param from of any alignment
template <typename Vector, typename T>
inline Vector load(const T* from)
{
  Vector vector;
  std::memcpy(&vector, from, sizeof vector);
  return vector;
}

template <typename Vector, typename T>
inline void store(const Vector& vector, T* to)
{
  std::memcpy(to, &vector, sizeof vector);
}

/// Four small numbers as floats: of less than a whole register the compiler would convert them one by one.
inline Float4 floatsOf(const std::int16_t* from)
{
  using Long2 = std::int64_t __attribute__((vector_size(16)));
  const auto all = reinterpret_cast<Short8>(Long2{load<std::int64_t>(from)});
  const auto upper = reinterpret_cast<Int4>(__builtin_shufflevector(all, all, 0, 8, 1, 9, 2, 10, 3, 11));
  return __builtin_convertvector(upper >> 16, Float4);
}

inline Float4 floatsOf(const std::int8_t* from)
{
  using Byte16 = std::int8_t __attribute__((vector_size(16)));
  const auto all = reinterpret_cast<Byte16>(Int4{load<std::int32_t>(from)});
  const auto twice = reinterpret_cast<Short8>(
      __builtin_shufflevector(all, all, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23));
  const auto upper = reinterpret_cast<Int4>(__builtin_shufflevector(twice, twice, 0, 8, 1, 9, 2, 10, 3, 11));
  return __builtin_convertvector(upper >> 24, Float4);
}

inline Float4 floatsOf(const std::uint8_t* from)
{
  using Byte16 = std::uint8_t __attribute__((vector_size(16)));
  const auto all = reinterpret_cast<Byte16>(Int4{load<std::int32_t>(from)});
  const auto wide = reinterpret_cast<Short8>(
      __builtin_shufflevector(all, Byte16{}, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23));
  const auto wider = reinterpret_cast<Int4>(__builtin_shufflevector(wide, Short8{}, 0, 8, 1, 9, 2, 10, 3, 11));
  return __builtin_convertvector(wider, Float4);
}

/// Nearest integers, halves to the even one, as std::lrint(), which compilers call as a function, lane by lane.
/// @param v below 2^22 in magnitude
inline Int4 rounded(const Float4& v)
{
  constexpr float no_fraction = 3 << 22; // 1.5 * 2^23: floats of this size are whole, so sums are rounded
  return __builtin_convertvector(v + no_fraction - no_fraction, Int4);
}

/// Squares of the numbers, those of each two added.
inline Int4 squaresOf(const Short8& v)
{
#ifdef __SSE2__
  return reinterpret_cast<Int4>(__builtin_ia32_pmaddwd128(v, v));
#else
  return Int4{v[0] * v[0] + v[1] * v[1], v[2] * v[2] + v[3] * v[3], v[4] * v[4] + v[5] * v[5],
              v[6] * v[6] + v[7] * v[7]};
#endif
}

/// The lanes of a mask that are set, as bits.
inline unsigned lanesOf(const Int8& mask)
{
#ifdef __AVX2__
  return _mm256_movemask_ps(reinterpret_cast<__m256>(mask));
#else
  unsigned lanes = 0;
  for (int lane = 0; lane < 8; ++lane)
    lanes |= (mask[lane] & 1u) << lane;
  return lanes;
#endif
}

/// The numbers at eight places.
inline Float8 gathered(const float* from, const Int8& at)
{
#ifdef __AVX2__
  return _mm256_i32gather_ps(from, reinterpret_cast<__m256i>(at), 4);
#else
  Float8 values;
  for (int lane = 0; lane < 8; ++lane)
    values[lane] = from[at[lane]];
  return values;
#endif
}

/// Four floats in double precision.
inline Double4 widened(const float* from) { return __builtin_convertvector(load<Float4>(from), Double4); }

inline void store(const Double4& v, float* to) { store(__builtin_convertvector(v, Float4), to); }

inline Double4 squareRoot(const Double4& v)
{
#ifdef __AVX2__
  return _mm256_sqrt_pd(v);
#else
  return Double4{__builtin_sqrt(v[0]), __builtin_sqrt(v[1]), __builtin_sqrt(v[2]), __builtin_sqrt(v[3])};
#endif
}

template <typename Vector>
inline Vector smaller(const Vector& a, const Vector& b)
{
  return a < b ? a : b;
}

template <typename Vector>
inline Vector larger(const Vector& a, const Vector& b)
{
  return a > b ? a : b;
}

/// All lanes joined to one number, in the same order everywhere.
template <typename Join>
inline float joined(const Float8& v, const Join& join)
{
  Float4 half[2];
  std::memcpy(half, &v, sizeof half);
  const Float4 four = join(half[0], half[1]);
  return join(join(four[0], four[2]), join(four[1], four[3]));
}

inline std::int32_t total(const Int4& v) { return v[0] + v[1] + v[2] + v[3]; }

inline float total(const Float8& v)
{
  return joined(v, [](const auto& a, const auto& b) { return a + b; });
}
} // namespace
} // namespace fresco::simd
