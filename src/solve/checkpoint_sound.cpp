#include <algorithm>
#include <cmath>

#include "solve/checkpoint_fields.h"

namespace parallux {

namespace {

// Rows that are there or not.
template <class Row>
bool all_or_none(const Row& row, std::size_t size) {
    return row.empty() || row.size() == size;
}

// quantum() makes all power of a run 2^60 quanta at most: sums and differences of a few such rows
// are 64 bit numbers.
constexpr double most_quanta = 0x1p61;

template <class Row>
double quanta_in(const Row& row) {
    double sum = 0;
    for (const std::int64_t value : row)
        sum += std::fabs(static_cast<double>(value));
    return sum;
}

// Of what arrives at patches, W/m² a band.
double quanta_in(const std::vector<float>& row, const Patches& patches, double watts_per_quantum) {
    double sum = 0;
    for (std::size_t k = 0; k < row.size(); ++k)
        sum += std::fabs(row[k]) * patches.area[k / patches.bands] / watts_per_quantum;
    return sum;
}

// Without the counts of lines, which lie behind the bands.
double quanta_in(const Bank& bank, std::uint32_t bands) {
    double sum = 0;
    for (std::size_t k = 0; k < bank.received.size(); ++k)
        if (k % lanes(bands) < bands)
            sum += std::fabs(static_cast<double>(bank.received.data()[k]));
    return sum;
}

template <class Row>
double largest_in(const Row& row) {
    double largest = 0;
    for (const std::int64_t value : row)
        largest = std::max(largest, std::fabs(static_cast<double>(value)));
    return largest;
}

bool few_quanta(const RunState& run, const Patches& patches) {
    const DirectLight& direct = run.group.direct;
    const TransferState& state = run.group.state;
    // One of the state's is a whole number of the plan's.
    const double unit = state.bands ? state.watts_per_quantum / run.plan.watts_per_quantum : 1;
    if (!(unit >= 1 && unit <= most_quanta) || unit != std::floor(unit))
        return false;
    double most = 0;
    for (const auto* totals : {&direct.emitted, &direct.absorbed, &direct.escaped, &direct.unshot})
        most = std::max(most, quanta_in(*totals));
    most = std::max(most, quanta_in(direct.shot));
    for (const auto* row : {&direct.irradiance, &direct.exitance})
        most = std::max(most, quanta_in(*row, patches, run.plan.watts_per_quantum));
    for (const auto* totals :
         {&state.sent, &state.sky, &state.emitted, &state.lost, &state.absorbed, &state.escaped})
        most = std::max(most, unit * quanta_in(*totals));
    // Gathers have quanta of their own, whose sums are taken apart from all these.
    const bool gathers = run.group.stage > Stage::pass;
    for (const Bank& bank : run.banks.banks())
        most = std::max(
            most, gathers ? largest_in(bank.received) : unit * quanta_in(bank, patches.bands));
    for (const WorkerTotals& totals : run.banks.all_totals())
        for (const auto* row : {&totals.sky, &totals.escaped, &totals.lost})
            most = std::max(most, gathers ? largest_in(*row) : unit * quanta_in(*row));
    return most <= most_quanta;
}

bool sound(const DirectLight& direct, const Group& group, const Patches& patches) {
    const std::size_t values = patches.reflectance.size();
    // Totals are there from the first shots on.
    const bool begun = group.stage != Stage::trial && !direct.emitted.empty();
    for (const auto* totals : {&direct.emitted, &direct.absorbed, &direct.escaped, &direct.unshot})
        if (totals->size() != (begun ? patches.bands : 0))
            return false;
    if (group.stage > Stage::sources && !begun)
        return false;
    return all_or_none(direct.shot, values) && all_or_none(direct.irradiance, values) &&
           all_or_none(direct.exitance, values);
}

bool sound(const TransferState& state, const Group& group, const Patches& patches) {
    if (group.stage < Stage::pass)
        return state.bands == 0;
    const std::size_t values = patches.reflectance.size();
    const std::size_t carried = patches.count() * lanes(patches.bands);
    for (const auto* totals :
         {&state.sky, &state.emitted, &state.lost, &state.absorbed, &state.escaped})
        if (totals->size() != patches.bands)
            return false;
    const bool passing = group.stage == Stage::pass;
    return state.bands == patches.bands && state.watts_per_quantum > 0 &&
           state.sent.size() == (passing ? values : 0) &&
           (passing ? state.carried.size() == carried : all_or_none(state.carried, carried));
}

bool sound(const PassResult& pass, const Group& group, const Plan& plan, const Patches& patches) {
    if (group.stage < Stage::pass)
        return !pass.leftover && pass.batch == 0 && pass.bundles == 0;
    if (group.stage == Stage::pass)
        return pass.leftover && pass.leftover->sound() && pass.bundles <= plan.passing() &&
               pass.batch >= 1 &&
               (pass.bundles == plan.passing() || pass.batch <= plan.passing() - pass.bundles);
    const Balance& e = pass.balance;
    for (const auto* totals : {&e.emitted, &e.absorbed, &e.escaped, &e.unshot, &e.residual})
        if (totals->size() != patches.bands)
            return false;
    return pass.irradiance.size() == patches.reflectance.size() &&
           pass.crossings.size() == patches.count();
}

}  // namespace

bool sound(const RunState& run, const Patches& patches) {
    const Group& group = run.group;
    if (group.stage > Stage::local_rays || !run.rounds.sound() || !run.estimate.sound() ||
        !run.banks.sound())
        return false;
    // In rising order, each once.
    for (std::size_t k = 0; k < group.small.size(); ++k)
        if (group.small[k].patch >= patches.count() ||
            (k > 0 && group.small[k].patch <= group.small[k - 1].patch))
            return false;
    return sound(group.direct, group, patches) && sound(group.state, group, patches) &&
           sound(group.pass, group, run.plan, patches) && few_quanta(run, patches);
}

}  // namespace parallux
