#include "throughput/rounds.h"

#include <algorithm>

#include <benchmark/benchmark.h>

namespace parallux::throughput {

namespace {

// Keeps what Google Benchmark measured, by the number of the row.
class Collector : public benchmark::BenchmarkReporter {
public:
    explicit Collector(std::vector<Row>& rows) : rows_(rows) {}

    bool ReportContext(const Context&) override { return true; }

    void ReportRuns(const std::vector<Run>& runs) override {
        for (const Run& run : runs) {
            Row& row = rows_[static_cast<std::size_t>(run.counters.at("row"))];
            row.lines = static_cast<std::uint64_t>(run.counters.at("lines"));
            row.rates.push_back(run.counters.at("lines") / run.real_accumulated_time);
            row.hit_rates.push_back(run.counters.at("hits") / run.real_accumulated_time);
            row.serial.push_back(run.counters.at("serial") / run.real_accumulated_time);
        }
    }

private:
    std::vector<Row>& rows_;
};

// One benchmark: a run of an engine that says itself how long it took, since set-up is not timed.
void measure(benchmark::State& state, Engine& engine, unsigned threads, std::size_t row) {
    LineCounts counts;
    double serial = 0;
    for ([[maybe_unused]] auto once : state) {
        const Measured measured = engine.run(threads);
        state.SetIterationTime(measured.seconds);
        counts = measured.counts;
        serial = measured.serial;
    }
    state.counters["row"] = static_cast<double>(row);
    state.counters["lines"] = static_cast<double>(counts.lines);
    state.counters["serial"] = serial;
    state.counters["hits"] = static_cast<double>(counts.hits);
}

}  // namespace

double median(std::vector<double> values) {
    if (values.empty())
        return 0;
    const std::size_t half = values.size() / 2;
    std::sort(values.begin(), values.end());
    return values.size() % 2 ? values[half] : (values[half - 1] + values[half]) / 2;
}

double Row::rate() const {
    return median(rates);
}

double Row::hit_rate() const {
    return median(hit_rates);
}

double Row::spread() const {
    auto [low, high] = std::minmax_element(rates.begin(), rates.end());
    return (*high - *low) / rate();
}

std::vector<Row> run_rounds(const Case& of, const std::vector<std::unique_ptr<Engine>>& engines,
                            const std::vector<unsigned>& threads, int repetitions) {
    std::vector<Row> rows;
    for (unsigned count : threads)
        for (const auto& engine : engines) {
            if (count == 1 && engine->name() == std::string("bundle-apart"))
                continue;
            Row row;
            row.scene = of.name;
            row.engine = engine->name();
            row.choice = engine->choice();
            row.threads = count;
            row.patches = of.patches.count();
            row.lines_per_bundle = of.lines_per_bundle;
            row.bundles = of.bundles;
            const std::string name =
                row.scene + "/" + row.engine + "/threads:" + std::to_string(count);
            benchmark::RegisterBenchmark(name.c_str(), measure, std::ref(*engine), count,
                                         rows.size())
                ->Iterations(1)
                ->UseManualTime();
            rows.push_back(std::move(row));
        }
    // Its own repetitions would run one benchmark to the end before the next begins.
    Collector collector(rows);
    for (int k = 0; k < repetitions; ++k)
        benchmark::RunSpecifiedBenchmarks(&collector);
    benchmark::ClearRegisteredBenchmarks();
    return rows;
}

}  // namespace parallux::throughput
