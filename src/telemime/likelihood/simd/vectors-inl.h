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
#include <numbers>

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

// Sine and cosine of |x| < 10^4 rad to 1e-6 or better: Cody and Waite's reduction to a quarter turn and the
// polynomials of S. L. Moshier's Cephes library.
HWY_INLINE void sine_cosine(FloatVector x, FloatVector* sine, FloatVector* cosine) {
  const FloatVector turns = x * number(static_cast<float>(2.0 / std::numbers::pi));
  const FloatVector half = hn::CopySign(number(0.5F), turns);
  const IntVector quarter = hn::ConvertTo(kInt, turns + half);
  const FloatVector q = hn::ConvertTo(kFloat, quarter);
  const FloatVector r = ((x - q * number(1.5703125F)) - q * number(4.837512969970703125e-4F)) -
                        q * number(7.54978995489188216e-8F);
  const FloatVector r2 = r * r;
  const FloatVector s =
      r +
      r * r2 * ((number(-1.9515295891e-4F) * r2 + number(8.3321608736e-3F)) * r2 - number(1.6666654611e-1F));
  const FloatVector c = number(1.0F) - number(0.5F) * r2 +
                        r2 * r2 *
                            ((number(2.443315711809948e-5F) * r2 - number(1.388731625493765e-3F)) * r2 +
                             number(4.166664568298827e-2F));
  const IntVector one = hn::Set(kInt, 1);
  const FloatMask swapped = hn::RebindMask(kFloat, (quarter & one) == one);
  const IntVector sine_sign = hn::ShiftLeft<30>(quarter & hn::Set(kInt, 2));
  const IntVector cosine_sign = hn::ShiftLeft<30>((quarter + one) & hn::Set(kInt, 2));
  *sine = hn::Xor(hn::IfThenElse(swapped, c, s), hn::BitCast(kFloat, sine_sign));
  *cosine = hn::Xor(hn::IfThenElse(swapped, s, c), hn::BitCast(kFloat, cosine_sign));
}

#define FN HWY_INLINE
#define REAL FloatVector
#define MASK FloatMask
#define NUMBER(x) number(x)
#define FUSED(a, b, c) hn::MulAdd(a, b, c)
#define SELECT(m, a, b) hn::IfThenElse(m, a, b)
#define LESS(a, b) hn::Lt(a, b)
#define SINE_COSINE(angle, sine, cosine) sine_cosine(angle, sine, cosine)
#include "telemime/likelihood/formulas.inc"
#undef FN
#undef REAL
#undef MASK
#undef NUMBER
#undef FUSED
#undef SELECT
#undef LESS
#undef SINE_COSINE

}  // namespace telemime::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // TELEMIME_SIMD_VECTORS_INL_H
