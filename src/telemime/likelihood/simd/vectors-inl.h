// SPDX-License-Identifier: Apache-2.0
// Types and small functions of the kernel; included once for each instruction set.
#if defined(TELEMIME_SIMD_VECTORS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TELEMIME_SIMD_VECTORS_INL_H
#undef TELEMIME_SIMD_VECTORS_INL_H
#else
#define TELEMIME_SIMD_VECTORS_INL_H
#endif

#include <hwy/highway.h>

#include <bit>

#include "telemime/likelihood/simd/kernel.h"

HWY_BEFORE_NAMESPACE();
namespace telemime::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// At most as many lanes as a tile has pixels.
using Float = hn::CappedTag<float, TileGrid::kPixels>;
using Int = hn::RebindToSigned<Float>;
using FloatVector = hn::Vec<Float>;
using IntVector = hn::Vec<Int>;
using FloatMask = hn::Mask<Float>;
constexpr Float kFloat;
constexpr Int kInt;
constexpr std::size_t kN = hn::MaxLanes(Float());
constexpr std::size_t kTile = TileGrid::kPixels;
// Number of vectors in a tile.
constexpr std::size_t kParts = kTile / kN;

HWY_INLINE FloatVector number(float x) {
  return hn::Set(kFloat, x);
}

HWY_INLINE std::uint64_t bits_of(FloatMask mask) {
  static_assert(std::endian::native == std::endian::little);
  std::uint64_t bits = 0;
  hn::StoreMaskBits(kFloat, mask, reinterpret_cast<std::uint8_t*>(&bits));
  return bits;
}

#define FN HWY_INLINE
#define REAL FloatVector
#define MASK FloatMask
#define NUMBER(x) number(x)
#define FUSED(a, b, c) hn::MulAdd(a, b, c)
#define SELECT(m, a, b) hn::IfThenElse(m, a, b)
#define LESS(a, b) hn::Lt(a, b)
#include "telemime/likelihood/formulas.inc"
#undef FN
#undef REAL
#undef MASK
#undef NUMBER
#undef FUSED
#undef SELECT
#undef LESS

}  // namespace telemime::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // TELEMIME_SIMD_VECTORS_INL_H
