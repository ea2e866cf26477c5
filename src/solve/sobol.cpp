#include "solve/sobol.h"

namespace parallux {

namespace {

// Degree, coefficients and first direction numbers of dimensions 2 to 5 in Joe and Kuo's table.
struct Primitive {
    unsigned degree, coefficients;
    std::uint32_t first[3];
};
constexpr Primitive primitives[] = {
    {1, 0, {1}}, {2, 1, {1, 3}}, {3, 1, {1, 3, 1}}, {3, 2, {1, 1, 1}}};

std::uint32_t reverse(std::uint32_t x) {
    x = (x << 16) | (x >> 16);
    x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
    x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
    return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}

// Each bit is flipped or not by a hash of the higher bits alone: a nested uniform scramble.
std::uint32_t owen(std::uint32_t x, std::uint32_t seed) {
    x = reverse(x);
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return reverse(x);
}

}  // namespace

Sobol::Sobol(std::uint64_t seed) {
    std::uint32_t matrix[dimensions][32];
    for (unsigned bit = 0; bit < 32; ++bit)
        matrix[0][bit] = 1u << (31 - bit);
    for (unsigned d = 1; d < dimensions; ++d) {
        const Primitive& p = primitives[d - 1];
        std::uint32_t* v = matrix[d];
        for (unsigned bit = 0; bit < 32; ++bit) {
            if (bit < p.degree) {
                v[bit] = p.first[bit] << (31 - bit);
                continue;
            }
            v[bit] = v[bit - p.degree] ^ (v[bit - p.degree] >> p.degree);
            for (unsigned k = 1; k < p.degree; ++k)
                if ((p.coefficients >> (p.degree - 1 - k)) & 1)
                    v[bit] ^= v[bit - k];
        }
    }
    for (unsigned byte = 0; byte < 4; ++byte)
        for (unsigned value = 0; value < 256; ++value)
            for (unsigned d = 0; d < dimensions; ++d) {
                std::uint32_t sum = 0;
                for (unsigned bit = 0; bit < 8; ++bit)
                    if ((value >> bit) & 1)
                        sum ^= matrix[d][8 * byte + bit];
                bytes_[byte][value][d] = sum;
            }
    Random random(seed, stream::first_shot);
    for (std::uint32_t& s : scramble_)
        s = static_cast<std::uint32_t>(random.bits() >> 32);
}

std::array<double, Sobol::dimensions> Sobol::point(std::uint32_t index) const {
    std::array<double, dimensions> p;
    for (unsigned d = 0; d < dimensions; ++d) {
        std::uint32_t x = bytes_[0][index & 255][d] ^ bytes_[1][(index >> 8) & 255][d] ^
                          bytes_[2][(index >> 16) & 255][d] ^ bytes_[3][index >> 24][d];
        p[d] = owen(x, scramble_[d]) * 0x1p-32;
    }
    return p;
}

}  // namespace parallux
