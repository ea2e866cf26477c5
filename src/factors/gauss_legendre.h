#pragma once

#include <array>
#include <cstddef>

namespace parallux {

struct GaussNode {
    double place, weight;
};

/// The Gauss-Legendre rule of n points on [-1, 1], 1 ≤ n ≤ 8: the zeros of P_n, with the weights
/// 2 / ((1 - x²) P_n'(x)²).
class GaussRule {
public:
    static constexpr std::size_t most = 8;

    explicit GaussRule(std::size_t n) {
        // The tables hold the nodes ≥ 0; that at 0 comes first.
        const GaussNode* half = nodes_.data() + start_[n];
        for (std::size_t k = 0; k < (n + 1) / 2; ++k) {
            if (half[k].place > 0)
                node_[size_++] = {-half[k].place, half[k].weight};
            node_[size_++] = half[k];
        }
    }

    const GaussNode* begin() const { return node_.data(); }
    const GaussNode* end() const { return node_.data() + size_; }

private:
    static constexpr std::array<GaussNode, 20> nodes_{{
        {0, 2},
        {0.5773502691896257645, 1},
        {0, 0.8888888888888888889},
        {0.7745966692414833770, 0.5555555555555555556},
        {0.3399810435848562648, 0.6521451548625461426},
        {0.8611363115940525752, 0.3478548451374538574},
        {0, 0.5688888888888888889},
        {0.5384693101056830910, 0.4786286704993664680},
        {0.9061798459386639928, 0.2369268850561890875},
        {0.2386191860831969086, 0.4679139345726910474},
        {0.6612093864662645137, 0.3607615730481386076},
        {0.9324695142031520278, 0.1713244923791703450},
        {0, 0.4179591836734693878},
        {0.4058451513773971669, 0.3818300505051189450},
        {0.7415311855993944399, 0.2797053914892766679},
        {0.9491079123427585245, 0.1294849661688696933},
        {0.1834346424956498049, 0.3626837833783619830},
        {0.5255324099163289858, 0.3137066458778872873},
        {0.7966664774136267396, 0.2223810344533744705},
        {0.9602898564975362317, 0.1012285362903762592},
    }};
    static constexpr std::array<std::size_t, most + 1> start_{0, 0, 1, 2, 4, 6, 9, 12, 16};

    std::array<GaussNode, most> node_;
    std::size_t size_ = 0;
};

}  // namespace parallux
