#include "paper/runs.h"

#include <cmath>

#include "lines/line_stream.h"
#include "parallel.h"
#include "reference/error_theory.h"
#include "reference/exact_factors.h"
#include "reference/matrix.h"
#include "solve/end_pass.h"
#include "solve/estimate.h"
#include "solve/first_shot.h"

namespace parallux::paper {

namespace {

// Four runs of 16384 bundles: their own quadratic error stays below a hundredth of the smallest
// cell's.
std::vector<double> long_runs(const Scene& scene, const Patches& patches) {
    std::vector<double> truth(patches.count(), 0);
    constexpr int runs = 4;
    for (int k = 0; k < runs; ++k) {
        SolveSettings settings;
        settings.first_shot = FirstShot::exact;
        settings.bundles = 16384;
        settings.seed = 1'000'000 + static_cast<std::uint64_t>(k);
        const Solution solution = solve(scene, patches, settings);
        for (std::size_t patch = 0; patch < truth.size(); ++patch)
            truth[patch] += solution.radiosity[patch] / double(runs);
    }
    return truth;
}

// The exact answer of a convex room, and what the theory says of bidirectional lines in it.
void solve_exactly(Room& room) {
    ErrorModel model;
    model.factors = exact_factors(room.scene, room.patches);
    const Eigen::VectorXd exact = exact_radiosity(model.factors, room.patches);
    room.truth.assign(exact.data(), exact.data() + exact.size());
    model.area = Eigen::Map<const Eigen::VectorXd>(room.patches.area.data(),
                                                   static_cast<Eigen::Index>(room.patches.count()));
    model.emission = emission_of(room.patches);
    model.reflectance = reflectance_of(room.patches);
    const double radius = line_sphere(room.scene).radius;
    model.exits = model.area / (2 * pi * radius * radius);  // of one line
    const PredictedError theory = error_theory(model);
    room.theory_full = theory.quadratic_full;
    room.theory_variation = theory.variation;
    room.theory_freedom = theory.freedom;
}

}  // namespace

const Room& Rooms::room(const std::string& name) {
    auto [place, fresh] = rooms_.try_emplace(name);
    Room& room = place->second;
    if (fresh) {
        room.scene = load_scene(folder_ + "/" + name + ".json");
        room.patches = make_patches(room.scene);
        if (room.scene.objects.size() > 1 && name.starts_with("paper_scene2"))
            room.truth = long_runs(room.scene, room.patches);
        else
            solve_exactly(room);
    }
    return room;
}

const Prediction& Rooms::predicted(const std::string& name, const Variant& variant) {
    room(name);
    Room& room = rooms_.at(name);
    auto [place, fresh] = room.predicted.try_emplace(variant.name);
    if (fresh) {
        SolveSettings settings;
        settings.direction = variant.direction;
        settings.first_shot = variant.first_shot;
        place->second = predict_error(room.scene, room.patches, settings);
    }
    return place->second;
}

const Errors& Rooms::errors(const std::string& name, const Variant& variant, std::uint64_t lines,
                            int count, bool counted) {
    const bool shot = variant.first_shot == FirstShot::exact;
    const std::string key = name + variant.name + (shot ? " shot " : " ") + std::to_string(lines);
    auto [place, fresh] = errors_.try_emplace(key);
    if (fresh || (counted && place->second.counted.empty()))
        place->second = run_errors(room(name), variant, lines, count, counted);
    return place->second;
}

namespace {

double quadratic_error(const Patches& patches, const std::vector<float>& radiosity,
                       const std::vector<double>& truth) {
    double sum = 0, area = 0;
    for (std::size_t patch = 0; patch < patches.count(); ++patch) {
        const double difference = radiosity[patch] - truth[patch];
        sum += patches.area[patch] * difference * difference;
        area += patches.area[patch];
    }
    return sum / area;
}

// A run of lines that are followed as solve() does it and counted at once: radiosities of both.
struct Twofold {
    std::vector<float> followed;
    std::vector<double> counted;  // [Sbert93]
};

Twofold follow_and_count(const Room& room, const SolveSettings& settings) {
    const Patches& patches = room.patches;
    const Plan plan = make_plan(room.scene, patches, settings);
    const ProgressCallback nobody;
    Listener listener(nobody, 0);
    Banks banks(patches.count(), patches.bands, plan.threads, plan.bank_bytes);
    const RayScene rays(room.scene, plan.threads);
    const Run run{room.scene, patches, settings, plan, &rays, banks, listener};
    Group group;
    first_shot(run, group);
    DirectLight& direct = group.direct;
    settle(run, direct);
    TransferState state = dark_state(patches, plan.watts_per_quantum);
    state.emission = emission_of(patches, direct);
    state.emission.quanta = emission_quanta(plan, state);
    banks.join(plan.threads);
    CountedLines counted(room.scene, patches);
    PassResult pass;
    trace_in_order({rays, room.scene, patches, plan.sphere, settings.seed, plan.lines, false, 1},
                   [&](const IntersectionLists& lists, const std::vector<glm::dvec3>& directions,
                       std::uint64_t) {
                       exchange_in_order(lists, state, banks.of(0), patches, settings.direction, {},
                                         pass.counts);
                       counted.count(lists, directions);
                       return true;
                   });
    Twofold result;
    end_pass(run, direct, state, pass);
    Estimate estimate(patches);
    estimate.add(run, direct, pass);
    result.followed = estimate.solution(plan).radiosity;
    const std::vector<double> emission(patches.emission.begin(), patches.emission.end());
    result.counted = counted.irradiance(emission, 0);
    for (std::size_t patch = 0; patch < patches.count(); ++patch)
        result.counted[patch] =
            emission[patch] + patches.reflectance[patch] * result.counted[patch];
    return result;
}

}  // namespace

Errors run_errors(const Room& room, const Variant& variant, std::uint64_t lines, int count,
                  bool counted) {
    Errors errors;
    errors.truth.resize(static_cast<std::size_t>(count));
    errors.counted.resize(counted ? errors.truth.size() : 0);
    SolveSettings settings;
    settings.method = variant.method;
    settings.direction = variant.direction;
    settings.first_shot = variant.first_shot;
    settings.directions = variant.directions;
    settings.lines_per_patch = variant.lines_per_patch;
    settings.lines = lines;
    settings.threads = 1;
    parallel_for(0, errors.truth.size(), 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t k = begin; k < end; ++k) {
            SolveSettings own = settings;
            own.seed = 1 + k;
            if (counted) {
                const Twofold run = follow_and_count(room, own);
                errors.truth[k] = quadratic_error(room.patches, run.followed, room.truth);
                errors.counted[k] = quadratic_error(room.patches, run.followed, run.counted);
            } else {
                errors.truth[k] = quadratic_error(
                    room.patches, solve(room.scene, room.patches, own).radiosity, room.truth);
            }
        }
    });
    return errors;
}

double Spread::standard_error() const {
    return deviation / std::sqrt(static_cast<double>(count));
}

Spread spread_of(const std::vector<double>& values) {
    Spread spread;
    spread.count = static_cast<int>(values.size());
    for (double value : values)
        spread.mean += value / static_cast<double>(values.size());
    double squares = 0;
    for (double value : values)
        squares += (value - spread.mean) * (value - spread.mean);
    spread.deviation = std::sqrt(squares / static_cast<double>(values.size() - 1));
    return spread;
}

}  // namespace parallux::paper
