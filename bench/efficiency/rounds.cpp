#include "efficiency/rounds.h"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "efficiency/judge.h"
#include "efficiency/quality.h"

namespace parallux::efficiency {

namespace {

double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// So many bundles or lines that they take about `shortest` on top of what any run takes.
std::uint64_t shortest_length(const Case& of, const Contender& contender,
                              const RoundSettings& settings) {
    std::uint64_t length = contender.least_length();
    if (settings.shortest <= 0)
        return 8 * length;
    const double least = timed_run(of, contender, length, 1).seconds(settings.clock);
    double more = 0;
    while (more < 0.3 * settings.shortest && length < std::uint64_t(1) << 40) {
        length *= 4;
        more = timed_run(of, contender, length, 1).seconds(settings.clock) - least;
    }
    const double wanted = static_cast<double>(length) * settings.shortest / more;
    return std::max(contender.least_length(),
                    static_cast<std::uint64_t>(std::exp2(std::round(std::log2(wanted)))));
}

Row empty_row(const Case& of, const Contender& contender, std::uint64_t length) {
    Row row;
    row.scene = of.name;
    row.method = contender.name;
    row.threads = contender.settings.threads;
    row.length = length;
    return row;
}

void add_run(const Case& of, const Reference& reference, const Timed& run, Row& row) {
    row.wall.push_back(run.wall);
    row.cpu.push_back(run.cpu);
    row.errors.push_back(quadratic_error(of, run.solution.radiosity, reference.radiosity));
    row.runs.push_back(run.solution.radiosity);
    row.lines = static_cast<double>(run.solution.counts.lines);
    row.first_shot_rays = static_cast<double>(run.solution.first_shot_rays);
}

void finish(const Case& of, const Reference& reference, Clock clock, Row& row) {
    row.seconds = median(clock == Clock::wall ? row.wall : row.cpu);
    judge(of, reference, row);
}

}  // namespace

double median(std::vector<double> values) {
    if (values.empty())
        return 0;
    const std::size_t half = values.size() / 2;
    std::sort(values.begin(), values.end());
    return values.size() % 2 ? values[half] : (values[half - 1] + values[half]) / 2;
}

Timed timed_run(const Case& of, const Contender& contender, std::uint64_t length,
                std::uint64_t seed) {
    const SolveSettings settings = contender.run(length, seed);
    const double cpu = processor_seconds();
    const auto begin = std::chrono::steady_clock::now();
    Timed result;
    result.solution = solve(of.scene, of.patches, settings);
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
    result.wall = wall.count();
    result.cpu = processor_seconds() - cpu;
    return result;
}

Row run_row(const Case& of, const Reference& reference, const Contender& contender,
            std::uint64_t length, const RoundSettings& settings) {
    Row row = empty_row(of, contender, length);
    for (int seed = 1; seed <= settings.seeds; ++seed)
        add_run(of, reference, timed_run(of, contender, length, static_cast<unsigned>(seed)), row);
    finish(of, reference, settings.clock, row);
    return row;
}

std::vector<Row> run_rounds(const Case& of, const Reference& reference,
                            const std::vector<Contender>& contenders,
                            const RoundSettings& settings) {
    std::vector<Row> rows;
    std::vector<const Contender*> of_row;
    for (const Contender& contender : contenders) {
        std::uint64_t length = shortest_length(of, contender, settings);
        for (int k = 0; k < settings.lengths; ++k, length *= 4) {
            rows.push_back(empty_row(of, contender, length));
            of_row.push_back(&contender);
        }
    }
    for (int seed = 1; seed <= settings.seeds; ++seed)
        for (std::size_t k = 0; k < rows.size(); ++k)
            add_run(of, reference,
                    timed_run(of, *of_row[k], rows[k].length, static_cast<unsigned>(seed)),
                    rows[k]);
    for (Row& row : rows)
        finish(of, reference, settings.clock, row);
    return rows;
}

}  // namespace parallux::efficiency
