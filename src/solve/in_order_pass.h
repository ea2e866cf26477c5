#pragma once

#include "solve/pass.h"

namespace parallux {

/// The global algorithm as the paper prints it: independent lines, each of which sees what the one
/// before it did (M. Sbert and X. Pueyo, A Global Algorithm for Linear Radiosity, LSI-93-37-R,
/// 1993). Lines are traced on all threads and followed on one. Nothing is done about what is left
/// unshot when the lines end; it is stated in the balance.
PassResult in_order_pass(const Run& run, DirectLight& direct, TransferState& state);

}  // namespace parallux
