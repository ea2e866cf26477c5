#include "solve/settled.h"

#include <algorithm>
#include <cmath>

namespace parallux {

Settled::Settled(const std::vector<double>& known, const std::vector<std::uint32_t>& group,
                 std::uint32_t bands)
    : group_(group), bands_(bands), before_(known.size(), 0), over_(bands, false) {
    std::size_t groups = 0;
    for (std::uint32_t one : group)
        groups = std::max<std::size_t>(groups, one + 1);
    known_.resize(groups * bands, 0);
    for (std::size_t k = 0; k < known.size(); ++k)
        known_[group[k / bands] * std::size_t(bands) + k % bands] += known[k];
    for (std::vector<double>& one : changed_)
        one.resize(known_.size(), 0);
}

void Settled::step(const std::vector<double>& values) {
    std::vector<double> all = known_;
    std::vector<double>& changed = changed_[static_cast<std::size_t>(steps_++ % judged)];
    std::fill(changed.begin(), changed.end(), 0);
    for (std::size_t k = 0; k < values.size(); ++k) {
        const std::size_t g = group_[k / bands_] * std::size_t(bands_) + k % bands_;
        all[g] += std::fabs(values[k]);
        changed[g] += std::fabs(values[k] - before_[k]);
    }
    before_ = values;
    if (steps_ < judged)
        return;
    std::vector<bool> over(bands_, true);
    for (std::size_t g = 0; g < all.size(); ++g) {
        double last = 0;
        for (const std::vector<double>& one : changed_)
            last += one[g];
        if (!(last <= enough * all[g]))
            over[g % bands_] = false;
    }
    for (std::uint32_t band = 0; band < bands_; ++band)
        over_[band] = over_[band] || over[band];
}

bool Settled::all_over() const {
    return std::find(over_.begin(), over_.end(), false) == over_.end();
}

}  // namespace parallux
