#include <cmath>
#include <limits>

#include "output/table_reader.h"
#include "parallux/error.h"
#include "parallux/tables.h"

namespace parallux {

namespace {

// Areas are written with 9 digits, and another compiler may round the last ones differently.
constexpr double same_area = 1e-6;

void check_same_patch(const TableReader& a, const TableReader& b) {
    if (a.patch() != b.patch())
        a.fail("patch " + std::to_string(a.patch()) + ", but " + std::to_string(b.patch()) +
               " in " + b.file().string() +
               "; rows are missing, or the tables have other receivers");
    if (std::abs(a.area() - b.area()) > same_area * std::max(a.area(), b.area()) ||
        a.back() != b.back())
        a.fail("patch " + std::to_string(a.patch()) + " has another area or side in " +
               b.file().string() + "; compare tables of one scene and patch size");
}

}  // namespace

Comparison compare_tables(const std::filesystem::path& file_a,
                          const std::filesystem::path& file_b) {
    TableReader a(file_a), b(file_b);
    if (a.bands() != b.bands())
        a.fail(std::to_string(a.bands()) + " bands, but " + b.file().string() + " has " +
               std::to_string(b.bands()));

    Comparison result;
    double difference = 0, reference = 0, area = 0;  // Σ A ΔB², Σ A B_b², Σ A
    for (;;) {
        bool more_a = a.next(), more_b = b.next();
        if (more_a != more_b)
            (more_a ? b : a)
                .fail("the table ends after " + std::to_string(result.patches) +
                      " patches, the other goes on; compare tables of one scene and patch size");
        if (!more_a)
            break;
        check_same_patch(a, b);
        for (std::uint32_t band = 0; band < a.bands(); ++band) {
            double delta = std::abs(a.radiosity(band) - b.radiosity(band));
            difference += a.area() * delta * delta;
            reference += a.area() * b.radiosity(band) * b.radiosity(band);
            area += a.area();
            if (delta > result.maximum) {
                result.maximum = delta;
                result.maximum_patch = a.patch();
            }
        }
        ++result.patches;
    }
    if (result.patches == 0)
        a.fail("the table has no patches");

    result.rms = area > 0 ? std::sqrt(difference / area) : 0;
    // A dark reference: equal tables agree, others are infinitely far off.
    result.relative_rms = reference > 0    ? std::sqrt(difference / reference)
                          : difference > 0 ? std::numeric_limits<double>::infinity()
                                           : 0;
    return result;
}

}  // namespace parallux
