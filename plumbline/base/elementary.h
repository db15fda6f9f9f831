// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Elementary functions that give the same bits on every machine. Those of the C library do not:
// glibc selects a variant with or without fused multiply-add by the processor, and their last
// digits differ. The functions here consist of additions, multiplications, divisions and square
// roots, whose rounding IEEE 754 defines.
//
// Arguments and results are as in <cmath>, including infinities and NaN. Errors are given in units
// of the last place (ulp): below 1 unless a function says otherwise. Most functions take about 10
// ns, one to three times as long as glibc's.
//
// Exact functions (std::sqrt, floor, round, fmod, remainder, abs, ...) need no replacement.
// tools/check_elementary.py keeps the inexact ones of <cmath> out of the library.
namespace plumbline::math {

// The argument is in radians. Beyond 1e5 radians the error is below 2e-16 (not relative to the
// value). Beyond 1e15, where neighbouring doubles are most of a turn apart, the value lies in [-1,
// 1] but is meaningless.
double Sin(double x);
double Cos(double x);
// Error below 2.5 ulp.
double Tan(double x);

// The angle of (x, y) from the x axis, in [-pi, pi]. Error below 2 ulp.
double Atan2(double y, double x);
double Atan(double x);
// Error below 3 ulp.
double Asin(double x);
double Acos(double x);

double Exp(double x);
// exp(x) - 1, with an error below 3 ulp near zero, too.
double Expm1(double x);
// Error below 5 ulp.
double Tanh(double x);

// The natural logarithm.
double Log(double x);
// log(1 + x), with an error below 3 ulp near zero, too.
double Log1p(double x);
// Powers of ten within 1e-22 and 1e22 have exact logarithms. Error below 3 ulp.
double Log10(double x);

// Power by repeated squaring. The error is below |exponent| ulp, and zero if all products are
// exact.
double Pow(double base, int exponent);
// base >= 0. The error grows with the result's logarithm: below (2 + 2 |exponent log(base)|) ulp.
double Pow(double base, double exponent);
// Error below 2 ulp.
double Cbrt(double x);

// The length of (x, y), without overflow. Error below 2 ulp.
double Hypot(double x, double y);

}  // namespace plumbline::math
