#pragma once

#include "solve/pass.h"

namespace parallux {

/// Progressive radiosity (M. Cohen, S. Chen, J. Wallace and D. Greenberg, A progressive refinement
/// approach to fast radiosity image generation, SIGGRAPH 1988): shoots from the patch with most
/// unshot power, form factors by local rays (or exact), until the wanted shots are done or a
/// thousandth is left. What is left comes back as the ambient term: the mean irradiance that it
/// would bring, had it gone everywhere alike. All in `direct`; the state stays dark.
PassResult progressive_pass(const Run& run, DirectLight& direct);

}  // namespace parallux
