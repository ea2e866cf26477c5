#pragma once

#include "solve/pass.h"

namespace parallux {

/// Particle tracing (S. Pattanaik and S. Mudur, Computation of global illumination by Monte Carlo
/// simulation of the particle model of light, 1992; P. Shirley, A ray tracing method for
/// illumination calculation in diffuse-specular scenes, 1990): `plan.lines` particles of equal
/// power leave the patches with unshot power and walk on by local rays; each is reflected with the
/// highest of its patch's reflectances as probability, let through with the highest of its
/// transmittances, and absorbed otherwise. It goes on from
/// any point of the patch, not from where it arrived: so it solves the same H = F B as the other
/// methods, whose patches have one value each. A particle is a pure function of seed and number.
PassResult particle_pass(const Run& run, DirectLight& direct, TransferState& state);

}  // namespace parallux
