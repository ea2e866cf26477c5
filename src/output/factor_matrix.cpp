#include <string>

#include "output/factor_text.h"
#include "output/npz_file.h"
#include "parallux/error.h"
#include "parallux/factors.h"

namespace parallux {

namespace {

// Matrix Market exchange format (R. Boisvert, R. Pozo, K. Remington, NISTIR 5935, 1996).
void write_market(const std::filesystem::path& file, const Factors& factors, bool exchange) {
    std::uint64_t entries = 0;
    auto each = [&](auto&& visit) {
        for (std::size_t i = 0; i < factors.nodes.size(); ++i)
            for (std::uint64_t k = factors.start[i]; k < factors.start[i + 1]; ++k)
                if (!exchange || factors.column[k] <= i)
                    visit(i, k);
    };
    each([&](std::size_t, std::uint64_t) { ++entries; });
    FactorText text(file);
    text.text(exchange ? "%%MatrixMarket matrix coordinate real symmetric\n"
                         "% exchange areas A_i F_ij = A_j F_ji in m2; F_ij = value / area_i\n"
                       : "%%MatrixMarket matrix coordinate real general\n"
                         "% form factors F_ij: share of what leaves row i that reaches column j\n");
    const std::size_t n = factors.nodes.size();
    text.index(n).text(" ").index(n).text(" ").index(entries).text("\n");
    each([&](std::size_t i, std::uint64_t k) {
        const double value = factors.exchange[k];
        text.index(i + 1).text(" ").index(factors.column[k] + std::uint64_t(1)).text(" ");
        text.number(exchange ? value : value / factors.nodes[i].area).text("\n");
    });
    text.commit();
}

// As scipy.sparse.save_npz writes a csr_matrix.
void write_npz(const std::filesystem::path& file, const Factors& factors, bool exchange) {
    NpzFile npz(file);
    std::vector<double> ratios;
    for (std::size_t i = 0; !exchange && i < factors.nodes.size(); ++i)
        for (std::uint64_t k = factors.start[i]; k < factors.start[i + 1]; ++k)
            ratios.push_back(factors.exchange[k] / factors.nodes[i].area);
    const std::uint64_t entries = factors.column.size();
    // Both index arrays are of one type.
    if (entries < 0x7fffffffu) {
        npz.add_array("indices", "<i4", factors.column);
        npz.add_array("indptr", "<i4",
                      std::vector<std::int32_t>(factors.start.begin(), factors.start.end()));
    } else {
        npz.add_array("indices", "<i8",
                      std::vector<std::int64_t>(factors.column.begin(), factors.column.end()));
        npz.add_array("indptr", "<i8", factors.start);
    }
    npz.add("format", "|S3", "()", "csr");
    npz.add_array("shape", "<i8", std::vector<std::int64_t>(2, std::int64_t(factors.nodes.size())));
    npz.add_array("data", "<f8", exchange ? factors.exchange : ratios);
    npz.commit();
}

}  // namespace

void write_factors(const std::filesystem::path& file, const Factors& factors, FactorValues values) {
    const bool exchange = values == FactorValues::exchange;
    if (file.extension() == ".mtx")
        write_market(file, factors, exchange);
    else if (file.extension() == ".npz")
        write_npz(file, factors, exchange);
    else
        throw Error(Fault::usage, file.string() + ": expected a name that ends in .mtx or .npz");
}

}  // namespace parallux
