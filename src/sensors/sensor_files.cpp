#include <glm/geometric.hpp>

#include "csv.h"
#include "output/output_file.h"
#include "output/row.h"
#include "parallux/sensors.h"
#include "parallux/tables.h"
#include "scene/input.h"

namespace parallux {

namespace {

constexpr const char* places[] = {"x", "y", "z", "nx", "ny", "nz"};
constexpr double farthest = 1e15;

}  // namespace

std::vector<Sensor> read_sensors(const std::filesystem::path& file, double scale) {
    const Csv csv(file);
    std::size_t column[6];
    for (int k = 0; k < 6; ++k)
        column[k] = csv.need(places[k]);
    const std::size_t name = csv.find("name");
    if (csv.columns().size() != (name == Csv::absent ? 6u : 7u))
        csv.fail("has other columns than x, y, z, nx, ny, nz and name");
    std::vector<Sensor> sensors;
    for (std::size_t row = 0; row < csv.rows(); ++row) {
        auto vector = [&](int first) {
            glm::dvec3 v;
            for (int axis = 0; axis < 3; ++axis)
                v[axis] = csv.number(row, column[first + axis], -farthest, farthest);
            return v;
        };
        const glm::dvec3 position = vector(0), normal = vector(3);
        const double length = glm::length(normal);
        if (!(length > 1e-30))
            csv.fail(row, "the normal has no direction");
        sensors.push_back(
            {name == Csv::absent ? std::to_string(row) : printable(csv.text(row, name)),
             scale * position, normal / length});
    }
    if (sensors.empty())
        csv.fail("has no sensors");
    return sensors;
}

void write_sensors(const std::filesystem::path& file, const std::vector<Sensor>& sensors,
                   const SensorReadings& readings) {
    std::string text;
    Row row(text);
    row.word("sensor");
    for (const char* name : places)
        row.word(name);
    for (std::uint32_t band = 0; band < readings.bands; ++band)
        for (const char* name : {"irradiance_", "stderr_", "solution_stderr_"})
            row.word(name + band_name(readings.bands, band));
    row.end();
    for (std::size_t s = 0; s < sensors.size(); ++s) {
        row.word(sensors[s].name);
        for (const glm::dvec3& v : {sensors[s].position, sensors[s].normal})
            row.number(v.x).number(v.y).number(v.z);
        for (std::size_t k = s * readings.bands; k < (s + 1) * readings.bands; ++k) {
            row.number(readings.irradiance[k]).number(readings.stderror[k]);
            readings.solution_error.empty() ? row.word("") : row.number(readings.solution_error[k]);
        }
        row.end();
    }
    OutputFile output(file);
    output.write(text);
    output.commit();
}

}  // namespace parallux
