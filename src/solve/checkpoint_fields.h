#pragma once

#include <algorithm>
#include <memory>

#include "output/fields.h"
#include "solve/checkpoint.h"

// All that a checkpoint keeps of a run, in its order, for reading and writing alike. Its rows have
// the sizes that the run's stage gives them: sound() says whether they have.

namespace parallux {

template <class Archive>
void fields_of(Archive& a, DirectLight& d) {
    a(d.own), a(d.arrived), a(d.shot), a(d.emitted), a(d.absorbed), a(d.escaped), a(d.unshot);
    a(d.irradiance), a(d.exitance), a(d.rays), a(d.shots), a(d.settled), a(d.done);
}

template <class Archive>
void fields_of(Archive& a, TransferState& s) {
    a(s.bands), a(s.watts_per_quantum), a(s.emission.quanta), a(s.dither), a(s.sent), a(s.carried);
    a(s.sky), a(s.emitted), a(s.lost), a(s.absorbed), a(s.escaped);
}

template <class Archive>
void fields_of(Archive& a, PassResult& p, const Patches& patches, const Regions& regions,
               unsigned threads) {
    bool followed = p.leftover != nullptr;
    a(followed);
    if (followed && !p.leftover)
        p.leftover = std::make_unique<Leftover>(patches, regions, std::vector<double>(), threads);
    if (followed)
        p.leftover->fields(a);
    fields_of(a, p.balance);
    fields_of(a, p.counts);
    a(p.irradiance), a(p.crossings), a(p.bundles), a(p.batch), a(p.done), a(p.whole);
    a(p.warnings);
}

template <class Archive>
void fields_of(Archive& a, std::vector<SmallPatch>& small) {
    std::vector<std::uint32_t> patches = numbers_of(small);
    std::vector<double> irradiance;
    for (const SmallPatch& one : small)
        irradiance.insert(irradiance.end(), one.irradiance.begin(), one.irradiance.end());
    a(patches), a(irradiance);
    irradiance.resize(patches.size() * max_bands);
    small.resize(patches.size());
    for (std::size_t k = 0; k < small.size(); ++k) {
        small[k].patch = patches[k];
        std::copy_n(&irradiance[k * max_bands], max_bands, small[k].irradiance.begin());
    }
}

template <class Archive>
void fields_of(Archive& a, const RunState& run, const Patches& patches, const Regions& regions) {
    a(run.plan.trial.known), a(run.plan.trial.variance), a(run.plan.trial.lit_area);
    run.rounds.fields(a);
    run.estimate.fields(a);
    fields_of(a, run.seconds);
    run.banks.fields(a);
    Group& group = run.group;
    auto stage = static_cast<std::uint32_t>(group.stage);
    a(stage), a(group.done);
    group.stage = Stage(stage);
    fields_of(a, group.direct);
    fields_of(a, group.state);
    fields_of(a, group.pass, patches, regions, run.plan.threads);
    fields_of(a, group.small);
}

/// True where a stage finds all that it will reach for, whatever the bytes were.
bool sound(const RunState& run, const Patches& patches);

}  // namespace parallux
