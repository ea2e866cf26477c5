#pragma once

namespace parallux {

/// Clausen's integral Cl₂(φ) = Σ sin(kφ) / k² for 0 ≤ φ ≤ 2π, to rounding. Some 20 ns.
double clausen(double phi);

/// Im Li₂(e^(x + iθ)) - Cl₂(2θ) / 2 for 0 < θ < π and any x up to 700: the imaginary part of the
/// dilogarithm but for a constant (L. Lewin, Polylogarithms and associated functions, 1981, §5.3).
/// The absolute error is some 1e-16 (1 + |x|).
double dilogarithm_sine(double x, double theta);

}  // namespace parallux
