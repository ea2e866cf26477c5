#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "parallux/solve.h"

// Grey long-wave exchange: temperatures in, net fluxes out.

namespace parallux {

/// σ of the Stefan-Boltzmann law, W/(m² K⁴) (SI, 2019), here and nowhere else.
inline constexpr double stefan_boltzmann = 5.670374419e-8;

/// Exitance of a black body, σ T⁴, W/m².
inline double black_body(double kelvin) {
    return stefan_boltzmann * kelvin * kelvin * kelvin * kelvin;
}

/// Given temperatures of surfaces, from a CSV table `kind,name,temperature`, kelvin. `kind` is all,
/// material, object, surface or patch; names may be patterns (* and ?), surfaces and patches go by
/// their number. What is more specific counts, in this order; of equals the later row.
class Temperatures {
public:
    /// Throws Fault::input naming file and line for damage and temperatures that are none.
    explicit Temperatures(const std::filesystem::path& csv);

    /// Makes the scene one of grey long-wave exchange: one band, of reflectance and transmittance
    /// the first one's, so that emissivity ε = 1 - ρ - τ; every surface emits ε σ T⁴ and nothing
    /// else does, but for a uniform sky of `sky` kelvin. Pictures give way to the factors they
    /// multiply, with a warning. Throws Fault::input for rows that fit nothing, surfaces without a
    /// temperature, and two sides of unlike emissivity.
    void apply(Scene& scene, double sky) const;
    /// Sets the emission of patches that have a row of their own; after apply(Scene).
    void apply(Patches& patches) const;

private:
    enum class Kind : std::uint8_t { all, material, object, surface, patch };
    struct Row {
        std::size_t line;
        Kind kind;
        std::string name;
        std::uint32_t number;
        double kelvin;
    };

    std::vector<double> of_surfaces(const Scene& scene) const;
    float first_band_only(Material& material) const;
    [[noreturn]] void fail(const Row& row, const std::string& what) const;

    std::filesystem::path file_;
    std::vector<Row> rows_;
};

/// What the rows of a table of fluxes stand for.
enum class FluxUnit { patch, surface, object, material };

/// One row: means over its area of W/m², and the standard error of `net`.
struct Flux {
    std::string name;
    double area = 0;
    double absorptance = 0;  ///< ε = 1 - ρ - τ
    double emission = 0;     ///< ε σ T⁴
    double incoming = 0;     ///< H
    double outgoing = 0;     ///< J = ε σ T⁴ + ρ H, + τ H of the other side
    double net = 0;          ///< q = ε (σ T⁴ - H): what must be supplied to keep T
    double net_stderr = -1;  ///< -1: not known
};

struct Fluxes {
    FluxUnit unit = FluxUnit::patch;
    std::vector<Flux> rows;
    double leaving = 0;         ///< Σ A q, W: what goes out of the scene, less what comes in
    double leaving_stderr = 0;  ///< of the estimate; 0: not known
    bool closed = false;        ///< no line left the scene
    double imbalance = 0;       ///< closed: Σ A q that was taken away, W; leaving is then 0
};

/// Net fluxes of a solve of one band, with their errors from its groups, which it has to see one by
/// one through preview(). Four doubles a patch.
class FluxMeter {
public:
    /// Keeps references to both.
    FluxMeter(const Scene& scene, const Patches& patches, FluxUnit unit);

    /// For solve(). Refers to this.
    Preview preview();

    /// The fluxes of the solution that solve() came to in the end. In a closed scene they are the
    /// nearest to what was estimated, by the squares of its standard errors, whose sum is 0: what
    /// was missing is stated. Without errors (one group) nothing is changed.
    Fluxes fluxes(const Solution& solution);

private:
    struct Spread {
        std::vector<double> mean, squares;
        void add(std::size_t k, double value, std::uint32_t groups);
        double error(std::size_t k, std::uint32_t groups) const;
    };

    void see(const Solution& so_far);
    double absorptance(std::size_t patch) const { return 1 - double(patches_.albedo(patch)); }

    const Scene& scene_;
    const Patches& patches_;
    FluxUnit unit_;
    std::vector<std::uint32_t> unit_of_;  // one a patch
    std::vector<std::string> names_;
    std::uint32_t groups_ = 0;
    std::vector<double> sums_;  // groups_ · irradiance
    Spread patch_, units_;      // of irradiance; of absorbed power, with the whole scene's last
};

/// Writes `unit,name,area,temperature,emissivity,incoming,outgoing,net,net_stderr,net_watts,
/// net_watts_stderr`, one row a unit, 9 significant digits; temperature is that of a black body
/// with the row's mean emission over its emissivity. The file is whole or untouched; throws
/// Fault::output.
void write_fluxes(const std::filesystem::path& file, const Fluxes& fluxes);

}  // namespace parallux
