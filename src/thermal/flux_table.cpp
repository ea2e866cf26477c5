#include <cmath>

#include "output/output_file.h"
#include "output/row.h"
#include "parallux/thermal.h"

namespace parallux {

void write_fluxes(const std::filesystem::path& file, const Fluxes& fluxes) {
    constexpr const char* units[] = {"patch", "surface", "object", "material"};
    std::string text;
    Row row(text);
    for (const char* name : {"unit", "name", "area", "temperature", "emissivity", "incoming",
                             "outgoing", "net", "net_stderr", "net_watts", "net_watts_stderr"})
        row.word(name);
    row.end();
    for (const Flux& flux : fluxes.rows) {
        row.word(units[static_cast<int>(fluxes.unit)]).word(flux.name);
        row.number(flux.area);
        row.number(std::sqrt(std::sqrt(flux.emission / flux.absorptance / stefan_boltzmann)));
        row.number(flux.absorptance).number(flux.incoming).number(flux.outgoing).number(flux.net);
        const bool known = flux.net_stderr >= 0;
        known ? row.number(flux.net_stderr) : row.word("");
        row.number(flux.net * flux.area);
        known ? row.number(flux.net_stderr * flux.area) : row.word("");
        row.end();
    }
    OutputFile output(file);
    output.write(text);
    output.commit();
}

}  // namespace parallux
