#pragma once

#include <functional>
#include <vector>

namespace parallux {

/// x of A x = b, A of any kind, by its products alone (H. van der Vorst, Bi-CGSTAB, SIAM J. Sci.
/// Stat. Comput. 13, 1992), until over(x, |b - A x| / |b|) says so, or so many steps are done: then
/// what came closest. Serial but for the products: the same bits if theirs are.
std::vector<double> bicgstab(
    const std::function<std::vector<double>(const std::vector<double>&)>& times,
    const std::vector<double>& b, int steps,
    const std::function<bool(const std::vector<double>&, double)>& over);

}  // namespace parallux
