// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "photometry/color_ratios.h"
namespace fresco::texture {
/// Vignetting of each lens, a polynomial as in Goldman 2010, "Vignette and Exposure Calibration and Compensation", and the
/// tone curve behind it, by least squares over patches that several views show. Lenses that come out within 1 % of even
/// are taken as even, curves that are not certain or change less than 2 % as straight.
/// @param lens of each owner, -1 = none
/// @param out  gets `falloff` and `response`
void calibrateLenses(const ColorRatios& pairs, const std::vector<int>& lens, Photometry& out);

/// Takes the lenses' part out of the ratios: what is left is that of light.
void correctRatios(const Photometry& photometry, const std::vector<int>& lens, ColorRatios& pairs);
} // namespace fresco::texture
