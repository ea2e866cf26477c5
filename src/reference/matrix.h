#pragma once

#include "solve/pass.h"

namespace parallux {

/// M. Sbert, An integral geometry based method for fast form-factor computation (Eurographics
/// 1993): global lines are only counted, n_ij between patches i and j and n_i that leave i, F_ij =
/// n_ij / n_i, and H = F (E + ρ H) is solved, E being the unshot power of the first shots. Each
/// band is a symmetric positive definite system, by conjugate gradients to 1e-13. Takes
/// matrix_bytes(). A patch that no line left stays dark, with a warning. Counted form factors do
/// not keep A_i F_ij = A_j F_ji, so that the power received differs from that sent by the noise of
/// the counts: the balance has the difference as unshot.
PassResult matrix_pass(const Run& run, const DirectLight& direct, TransferState& state);

/// Bytes of the counts between so many patches.
std::uint64_t matrix_bytes(std::uint64_t patches);

}  // namespace parallux
