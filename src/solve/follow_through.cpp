#include "solve/follow_through.h"

#include "solve/bicgstab.h"
#include "solve/settled.h"

namespace parallux {

namespace {

using Values = std::vector<double>;

// S x: what the regions send of what they receive.
Values sent(const Through& through, const Values& received) {
    Values sum(received);
    for (std::size_t k = 0; k < sum.size(); ++k)
        sum[k] *= through.reflectance[k];
    const std::size_t bands = through.bands;
    for (const Crossing& one : through.crossings)
        for (std::size_t band = 0; band < bands; ++band)
            sum[one.to * bands + band] += one.share[band] * received[one.from * bands + band];
    return sum;
}

// P v: what leaves each region does so in even parts along its lines.
Values arriving(const Through& through, Values sent) {
    for (std::size_t k = 0; k < sent.size(); ++k) {
        const double exits = through.exits[k / through.bands];
        sent[k] = exits > 0 ? sent[k] / exits : 0;
    }
    return through.neighbours(sent);
}

}  // namespace

Values follow_through(const Through& through, const Values& unshot) {
    auto times = [&](const Values& x) {
        Values result = arriving(through, sent(through, x));
        for (std::size_t k = 0; k < x.size(); ++k)
            result[k] = x[k] - result[k];
        return result;
    };
    Settled settled(through.received, through.group, through.bands);
    return bicgstab(times, arriving(through, unshot), 500, [&](const Values& x, double) {
        settled.step(x);
        return settled.all_over();
    });
}

}  // namespace parallux
