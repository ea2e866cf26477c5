#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace parallux {

/// Says when an iteration may end: where in every group, however dim beside the others, the last
/// steps changed what it is to receive by less than a thousandth of all that it receives. A norm
/// over the whole scene would end while dim places behind narrow gaps are still dark.
class Settled {
public:
    /// `known`: what regions have received; `group`: of each region. All arrays region · bands +
    /// band. Keeps a reference to `group`.
    Settled(const std::vector<double>& known, const std::vector<std::uint32_t>& group,
            std::uint32_t bands);

    /// What they are to receive besides, after one more step from none. O(regions).
    void step(const std::vector<double>& values);
    /// Each band by itself, as if it were alone.
    bool over(std::uint32_t band) const { return over_[band]; }
    bool all_over() const;

private:
    static constexpr int judged = 4;
    static constexpr double enough = 1e-3;

    const std::vector<std::uint32_t>& group_;
    std::uint32_t bands_;
    std::vector<double> known_, before_;               // a group; a region
    std::array<std::vector<double>, judged> changed_;  // of the last steps, a group
    int steps_ = 0;
    std::vector<bool> over_;
};

}  // namespace parallux
