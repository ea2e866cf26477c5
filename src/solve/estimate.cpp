#include "solve/estimate.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>

#include "parallel.h"
#include "random.h"
#include "solve/plan_lines.h"

namespace parallux {

namespace {

std::uint64_t hash_of(const Solution& solution) {
    std::uint64_t hash = mix64(solution.bands);
    for (const auto* values : {&solution.radiosity, &solution.irradiance})
        for (float value : *values)
            hash = mix64(hash ^ std::bit_cast<std::uint32_t>(value)) + 0x9e3779b97f4a7c15ull;
    return hash;
}

void add(const Balance& part, Balance& total) {
    total.watts_per_quantum = part.watts_per_quantum;
    for (auto values : {&Balance::emitted, &Balance::absorbed, &Balance::escaped, &Balance::unshot,
                        &Balance::residual}) {
        (total.*values).resize((part.*values).size(), 0);
        for (std::size_t band = 0; band < (part.*values).size(); ++band)
            // Made-up checkpoints may have sums beyond all bounds, which wrap.
            (total.*values)[band] =
                static_cast<std::int64_t>(static_cast<std::uint64_t>((total.*values)[band]) +
                                          static_cast<std::uint64_t>((part.*values)[band]));
    }
}

// 1 or -1 by each bit of a byte.
constexpr auto signs_of_byte = [] {
    std::array<std::array<double, 8>, 256> signs{};
    for (std::size_t byte = 0; byte < 256; ++byte)
        for (std::size_t bit = 0; bit < 8; ++bit)
            signs[byte][bit] = byte >> bit & 1 ? 1 : -1;
    return signs;
}();

}  // namespace

std::uint64_t group_seed(std::uint64_t seed, std::uint32_t group) {
    return group == 0 ? seed : mix64(mix64(seed) + group * 0x9e3779b97f4a7c15ull);
}

void Estimate::add(const Run& run, const DirectLight& direct, PassResult& pass) {
    std::vector<float> irradiance = std::move(pass.irradiance);
    const unsigned threads = run.plan.threads;
    if (!direct.irradiance.empty())
        parallel_for(threads, irradiance.size(), 1 << 14,
                     [&](std::size_t begin, std::size_t end, unsigned) {
                         for (std::size_t k = begin; k < end; ++k)
                             irradiance[k] += direct.irradiance[k];
                     });
    if (run.plan.groups > 1 || groups_ > 0)
        sketch(irradiance, static_cast<double>(pass.counts.lines), threads);
    if (groups_ == 0) {
        irradiance_ = std::move(irradiance);
        total_.crossings = std::move(pass.crossings);
    } else {
        // B. P. Welford's way to mean and spread, with weights; one more than the lines, so that
        // a patch that none leaves has a mean too.
        spread_.resize(irradiance_.size(), 0);
        if (patches_.translucent())
            spread_scattered(irradiance, pass.crossings, threads);
        parallel_for(
            threads, patches_.count(), 4096, [&](std::size_t begin, std::size_t end, unsigned) {
                for (std::size_t patch = begin; patch < end; ++patch) {
                    const double weight = static_cast<double>(pass.crossings[patch]) + 1;
                    const double before = static_cast<double>(total_.crossings[patch]) + groups_;
                    const double share = weight / (before + weight);
                    for (std::size_t k = patch * patches_.bands; k < (patch + 1) * patches_.bands;
                         ++k) {
                        const double step = static_cast<double>(irradiance[k]) - irradiance_[k];
                        irradiance_[k] = static_cast<float>(irradiance_[k] + step * share);
                        if (!patches_.translucent())
                            spread_[k] =
                                static_cast<float>(spread_[k] + step * step * share * before);
                    }
                    total_.crossings[patch] += pass.crossings[patch];
                }
            });
    }
    ++groups_;
    parallux::add(pass.balance, total_.energy);
    total_.counts += pass.counts;
    total_.bundles += pass.bundles;
    total_.first_shot_rays += run.plan.first_shot_rays;
    total_.shots = direct.shots;
    if (groups_ == 1)
        total_.warnings = pass.warnings;
    if (is_closed(run.scene))
        total_.leaks += pass.counts.odd;
    total_.partial = total_.partial || !pass.whole || direct.done < 1;
}

// Where light goes through, what leaves a side errs as what both receive, and those are known
// together alone: the spread is that of ρ_p H_p + τ_q H_q.
void Estimate::spread_scattered(const std::vector<float>& irradiance,
                                const std::vector<std::uint64_t>& crossings, unsigned threads) {
    auto step = [&](std::size_t k) { return static_cast<double>(irradiance[k]) - irradiance_[k]; };
    parallel_for(
        threads, irradiance.size(), 4096, [&](std::size_t begin, std::size_t end, unsigned) {
            for (std::size_t k = begin; k < end; ++k) {
                const std::size_t patch = k / patches_.bands;
                const double weight = static_cast<double>(crossings[patch]) + 1;
                const double before = static_cast<double>(total_.crossings[patch]) + groups_;
                const double both = scattered(patches_, k, step);
                spread_[k] = static_cast<float>(spread_[k] +
                                                both * both * weight / (before + weight) * before);
            }
        });
}

bool Estimate::sound() const {
    const std::size_t values = groups_ > 0 ? patches_.reflectance.size() : 0;
    const std::size_t counts = groups_ > 0 ? patches_.count() : 0;
    const Balance& e = total_.energy;
    for (const auto* totals : {&e.emitted, &e.absorbed, &e.escaped, &e.unshot, &e.residual})
        if (totals->size() != (groups_ > 0 ? patches_.bands : 0))
            return false;
    return irradiance_.size() == values && total_.crossings.size() == counts &&
           spread_.size() == (groups_ > 1 ? values : 0) &&
           (sketches_.size() == groups_ || (groups_ <= 1 && sketches_.empty()));
}

void Estimate::sketch(const std::vector<float>& irradiance, double lines, unsigned threads) {
    // Sums of fixed chunks, added up in their order: the same bits on any number of threads.
    constexpr std::size_t chunk = 1 << 12;
    using Sums = std::array<double, sketch_size>;
    std::vector<Sums> parts((irradiance.size() + chunk - 1) / chunk);
    auto add_value = [&](std::size_t k, Sums& sums) {
        if (patches_.emission[k] > 0)
            return;
        // Bounds keep their last bit where nothing comes through.
        const double root = std::sqrt(patches_.area[k / patches_.bands]);
        const double value =
            patches_.translucent()
                ? root * scattered(patches_, k, [&](std::size_t at) { return irradiance[at]; })
                : root * patches_.reflectance[k] * irradiance[k];
        const std::uint64_t signs = mix64(k);
        for (std::size_t row = 0; row < sketch_size; row += 8) {
            const std::array<double, 8>& eight = signs_of_byte[signs >> row & 255];
            for (std::size_t one = 0; one < 8; ++one)
                sums[row + one] += value * eight[one];
        }
    };
    parallel_for(threads, parts.size(), 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t part = begin; part < end; ++part) {
            parts[part].fill(0);
            const std::size_t last = std::min(irradiance.size(), (part + 1) * chunk);
            for (std::size_t k = part * chunk; k < last; ++k)
                add_value(k, parts[part]);
        }
    });
    sketches_.push_back({lines, {}});
    for (const Sums& sums : parts)
        for (std::size_t row = 0; row < sketch_size; ++row)
            sketches_.back().sums[row] += sums[row];
}

// (tr C)² / tr C² of the covariance C of a group's errors, each by the root of its lines: the
// errors of two groups have a product of variance tr C². What the sketch adds makes it less, never
// more.
double Estimate::freedom() const {
    double lines = 0;
    std::array<double, sketch_size> mean{};
    for (const Sketch& sketch : sketches_) {
        lines += sketch.lines;
        for (std::size_t row = 0; row < sketch_size; ++row)
            mean[row] += sketch.lines * sketch.sums[row];
    }
    double own = 0, sum = 0, squares = 0, pairs = 0;
    for (std::size_t a = 0; a < sketches_.size(); ++a)
        for (std::size_t b = 0; b <= a; ++b) {
            double product = 0;
            for (std::size_t row = 0; row < sketch_size; ++row)
                product += (sketches_[a].sums[row] - mean[row] / lines) *
                           (sketches_[b].sums[row] - mean[row] / lines);
            product *= std::sqrt(sketches_[a].lines * sketches_[b].lines) / lines;
            if (a == b) {
                own += product / (static_cast<double>(sketches_.size()) - 1);
                continue;
            }
            sum += product;
            squares += product * product;
            ++pairs;
        }
    const double variance = pairs > 1 ? (squares - sum * sum / pairs) / (pairs - 1) : own * own;
    return variance > 0 ? std::max(1.0, own * own / variance) : 1;
}

// Standard error of the mean radiosity: the groups' own spread.
double Estimate::deviation(std::size_t k) const {
    const double weight = static_cast<double>(total_.crossings[k / patches_.bands]) + groups_;
    const double spread = std::sqrt(spread_[k] / (weight * (groups_ - 1)));
    return patches_.translucent() ? spread : patches_.reflectance[k] * spread;
}

double Estimate::relative_rms() const {
    double error = 0, power = 0;
    for (std::size_t k = 0; k < irradiance_.size(); ++k) {
        if (patches_.emission[k] > 0)
            continue;
        const double area = patches_.area[k / patches_.bands];
        error += area * std::pow(deviation(k), 2);
        power +=
            area *
            std::pow(scattered(patches_, k, [&](std::size_t at) { return irradiance_[at]; }), 2);
    }
    return power > 0 ? std::sqrt(error / power) : 0;
}

Foresight Estimate::foresight() const {
    Foresight known;
    if (groups_ < 2)
        return known;
    known.relative_rms = relative_rms();
    known.alike = freedom();
    for (const Sketch& sketch : sketches_)
        known.lines.push_back(sketch.lines);
    return known;
}

Solution Estimate::solution(const Plan& plan) {
    std::vector<float> stderror;
    Foresight known;
    if (groups_ > 1) {
        known = foresight();
        stderror.resize(irradiance_.size());
        for (std::size_t k = 0; k < irradiance_.size(); ++k)
            stderror[k] = static_cast<float>(deviation(k));
    }
    spread_ = std::vector<float>();
    Solution solution = std::move(total_);
    solution.stderror = std::move(stderror);
    if (groups_ > 1) {
        solution.relative_rms = known.relative_rms;
        solution.relative_rms_bound = known.bound();
    }
    solution.bands = patches_.bands;
    solution.irradiance = std::move(irradiance_);
    solution.radiosity.resize(solution.irradiance.size());
    auto for_all = [&](auto&& set) {
        parallel_for(plan.threads, solution.radiosity.size(), 1 << 14,
                     [&](std::size_t begin, std::size_t end, unsigned) {
                         for (std::size_t k = begin; k < end; ++k)
                             set(k);
                     });
    };
    // A patch may send more than it has and then send a debt: few lines may bring less than
    // nothing. Nothing is nearer to the truth.
    for_all(
        [&](std::size_t k) { solution.irradiance[k] = std::max(0.0f, solution.irradiance[k]); });
    for_all([&](std::size_t k) {
        solution.radiosity[k] =
            static_cast<float>(patches_.emission[k] + scattered(patches_, k, [&](std::size_t at) {
                                   return solution.irradiance[at];
                               }));
    });
    solution.hash = hash_of(solution);
    // The groups' quanta together stand for one run.
    solution.energy.watts_per_quantum /= groups_;
    if (solution.leaks > 0)
        solution.warnings.push_back(std::to_string(solution.leaks) +
                                    " lines met a closed scene an odd number of times");
    if (plan.too_few)
        solution.warnings.push_back("the error is unknown: that takes " +
                                    std::to_string(bundles_for_error) + " bundles or more");
    solution.groups = groups_;
    solution.line_spacing = plan.spacing;
    solution.batch = plan.batch;
    solution.threads = plan.threads;
    return solution;
}

}  // namespace parallux
