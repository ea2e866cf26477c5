#pragma once

#include <string>

#include "factors/methods.h"

namespace parallux::factor_bench {

struct Row {
    std::string scene, method;
    std::uint64_t effort = 0;  ///< bundles, or rays a facet
    double seconds = 0;
    double rms_factor = -1;  ///< √(Σ_i A_i Σ_j (F_ij - F*_ij)² / Σ_i A_i); < 0: none
    double rms_sky = -1;     ///< √(Σ_i A_i (s_i - s*_i)² / Σ_i A_i)
    double net_l2 = -1;      ///< √(Σ_i A_i (q_i - q*_i)² / Σ_i A_i q*_i²)
};

/// Errors of an answer against a reference of the same patches.
Row judge(const std::string& scene, const std::string& method, std::uint64_t effort,
          const Patches& patches, const Answer& answer, const Answer& reference);

void print_heading();
void print_row(const Row& row);
/// {"rows": […]}; the file is whole or untouched.
void write_rows(const std::string& file, const std::vector<Row>& rows);

}  // namespace parallux::factor_bench
