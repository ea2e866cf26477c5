#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transfer/merge.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <span>
#include <utility>

#include "parallel.h"
#include "transfer/for_bands.h"
#include "transfer/merge.h"
#include "transfer/some_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace parallux {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Bands first … first + n - 1 of one patch after the other. `translucent`: what arrives on one side
// may leave from the other, as scatter.h says.
template <std::uint32_t bands, bool translucent>
struct Merger {
    static constexpr hn::CappedTag<std::int64_t, bands == 1 ? 2 : 4> integers{};
    using Integers = decltype(integers);
    static constexpr hn::Rebind<double, Integers> doubles{};
    static constexpr hn::Rebind<float, Integers> floats{};
    static constexpr hn::Rebind<std::int32_t, Integers> narrow{};
    static constexpr std::uint32_t step = hn::MaxLanes(Integers());
    static constexpr std::uint32_t chunks = (bands + step - 1) / step;
    using VI = hn::Vec<Integers>;
    using VD = hn::Vec<decltype(doubles)>;
    using VN = hn::Vec<decltype(narrow)>;

    // By value: a copy that nobody else can see stays in registers.
    const MergeJob job;
    VI absorbed[chunks], emitted[chunks];
    double area = 0, share = 0;

    explicit Merger(const MergeJob& the_job) : job(the_job) {
        for (std::uint32_t chunk = 0; chunk < chunks; ++chunk)
            absorbed[chunk] = emitted[chunk] = hn::Zero(integers);
    }

    // In [0, 1): even over patches, over bands, and over the merges.
    HWY_INLINE static VD dither(std::uint32_t start) {
        const hn::RebindToUnsigned<decltype(narrow)> bits;
        const auto even =
            hn::Add(hn::Set(bits, start), hn::Mul(hn::Iota(bits, 0), hn::Set(bits, dither_band)));
        return hn::Mul(hn::PromoteTo(doubles, hn::BitCast(narrow, hn::ShiftRight<1>(even))),
                       hn::Set(doubles, 0x1p-31));
    }

    template <std::size_t n>
    HWY_INLINE VD loaded(const float* values) const {
        return hn::PromoteTo(doubles, load_some<n>(floats, values));
    }

    // A share of quanta, rounded to whole ones.
    HWY_INLINE static VI share_of(VD part, VI quanta) {
        return hn::ConvertTo(integers, hn::Round(hn::Mul(part, hn::ConvertTo(doubles, quanta))));
    }

    HWY_INLINE VI received_at(std::size_t lane) const {
        VI sum = hn::Load(integers, job.banks[0] + lane);
        for (std::size_t bank = 1; bank < job.bank_count; ++bank)
            sum = hn::Add(sum, hn::Load(integers, job.banks[bank] + lane));
        return sum;
    }

    template <std::size_t n>
    HWY_INLINE VD exitance(std::size_t patch, std::size_t k, VD reflectance) const {
        VD sum = hn::Zero(doubles);
        if (job.own)
            sum = hn::PromoteTo(doubles, load_some<n>(floats, job.own + k));
        if (job.direct)
            sum = hn::Add(
                sum,
                hn::Mul(reflectance, hn::PromoteTo(doubles, load_some<n>(floats, job.direct + k))));
        if constexpr (translucent) {
            if (const std::uint32_t side = job.other[patch]; job.direct && side != none) {
                const std::size_t q = side * std::size_t(bands) + k % bands;
                sum = hn::Add(sum,
                              hn::Mul(loaded<n>(job.transmittance + q), loaded<n>(job.direct + q)));
            }
        }
        return sum;
    }

    template <std::size_t n>
    HWY_INLINE void merge_bands(std::size_t patch, std::uint32_t first, std::int64_t exits) {
        const std::size_t k = patch * bands + first, lane = patch * lanes(bands) + first;
        const auto start = static_cast<std::uint32_t>(patch) * dither_patch + first * dither_band;

        // What was sent leaves unshot.
        const VD reflectance = hn::PromoteTo(doubles, load_some<n>(floats, job.reflectance + k));
        const VD own = exitance<n>(patch, k, reflectance);
        const VN carried = hn::Load(narrow, job.carried + lane);
        const VN emission = hn::DemoteTo(
            narrow, hn::Floor(hn::Add(hn::Mul(own, hn::Set(doubles, job.emission_before)),
                                      dither(start + job.dither_before))));
        const VI left = hn::Set(integers, exits);
        const VI sent =
            hn::Add(load_some<n>(integers, job.sent + k),
                    product(integers, hn::PromoteTo(integers, hn::Sub(carried, emission)), left));
        store_some<n>(integers, sent, job.sent + k);

        // What came is absorbed or becomes unshot.
        const VI received = received_at(lane);
        VI leaving = share_of(reflectance, received);
        VI &absorbed_here = absorbed[first / step], &emitted_here = emitted[first / step];
        absorbed_here = hn::Add(absorbed_here, hn::Sub(received, leaving));
        if constexpr (translucent) {
            absorbed_here =
                hn::Sub(absorbed_here, share_of(loaded<n>(job.transmittance + k), received));
            if (const std::uint32_t side = job.other[patch]; side != none)
                leaving = hn::Add(
                    leaving,
                    share_of(loaded<n>(job.transmittance + side * std::size_t(bands) + first),
                             received_at(side * std::size_t(lanes(bands)) + first)));
        }
        emitted_here =
            hn::Add(emitted_here, product(integers, hn::PromoteTo(integers, emission), left));

        // Every exit takes its share.
        const VD most = hn::Set(doubles, most_carried);
        const VD unshot =
            hn::Mul(hn::ConvertTo(doubles, hn::Sub(leaving, sent)), hn::Set(doubles, share));
        const VD next =
            hn::Floor(hn::Add(hn::Add(hn::Mul(own, hn::Set(doubles, job.emission_after)), unshot),
                              dither(start + job.dither_after)));
        hn::Store(hn::DemoteTo(narrow, hn::Min(hn::Max(next, hn::Neg(most)), most)), narrow,
                  job.carried + lane);
    }

    template <std::uint32_t first>
    HWY_INLINE void merge_from(std::size_t patch, std::int64_t exits) {
        constexpr std::uint32_t n = std::min(step, bands - first);
        merge_bands<n>(patch, first, exits);
        if constexpr (first + n < bands)
            merge_from<first + n>(patch, exits);
    }

    HWY_INLINE void merge_patch(std::size_t patch) {
        // E[exits a bundle] · cell / area = |cos θ|: every direction gets its due.
        if (job.area[patch] != area) {
            area = job.area[patch];
            share = std::min(1.0, job.cell / area) / job.batch;
        }
        const std::size_t lane = patch * lanes(bands) + bands;
        // As vectors of one: the compiler would make a long loop of these few.
        const hn::CappedTag<std::int64_t, 1> one;
        auto left = hn::LoadU(one, job.banks[0] + lane);
        for (std::size_t bank = 1; bank < job.bank_count; ++bank)
            left = hn::Add(left, hn::LoadU(one, job.banks[bank] + lane));
        const auto exits = static_cast<std::uint32_t>(hn::GetLane(left));
        const std::uint32_t seen = static_cast<std::uint32_t>(job.carried[lane]);
        merge_from<0>(patch, exits - seen);
        job.carried[lane] = static_cast<std::int32_t>(exits);
    }

    void add_to(MergeTotals& totals) const {
        std::int64_t sums[2][chunks * step];
        for (std::uint32_t chunk = 0; chunk < chunks; ++chunk) {
            hn::StoreU(absorbed[chunk], integers, &sums[0][chunk * step]);
            hn::StoreU(emitted[chunk], integers, &sums[1][chunk * step]);
        }
        for (std::uint32_t band = 0; band < bands; ++band) {
            totals.absorbed[band] += sums[0][band];
            totals.emitted[band] += sums[1][band];
        }
    }
};

template <bool translucent>
void merge_all(const MergeJob& job, std::size_t begin, std::size_t end, MergeTotals& totals) {
    for_bands(job.bands, [&](auto bands) HWY_ATTR {
        Merger<bands(), translucent> merger(job);
        for (std::size_t patch = begin; patch < end; ++patch)
            merger.merge_patch(patch);
        merger.add_to(totals);
    });
}

void merge_patches(const MergeJob& job, std::size_t begin, std::size_t end, MergeTotals& totals) {
    if (job.transmittance)
        merge_all<true>(job, begin, end, totals);
    else
        merge_all<false>(job, begin, end, totals);
}

}  // namespace HWY_NAMESPACE
}  // namespace parallux
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace parallux {

namespace {

HWY_EXPORT(merge_patches);

const float* or_null(std::span<const float> values) {
    return values.empty() ? nullptr : values.data();
}

}  // namespace

void merge(TransferState& state, const Patches& patches, const std::vector<Bank>& banks,
           std::vector<WorkerTotals>& totals, const Share& next, unsigned threads) {
    state.carried.resize(patches.count() * lanes(state.bands), 0);
    std::vector<const std::int64_t*> received;
    for (const Bank& bank : banks)
        received.push_back(bank.received.data());
    MergeJob job;
    job.bands = state.bands;
    job.area = patches.area.data();
    job.reflectance = patches.reflectance.data();
    job.transmittance = or_null(patches.transmittance);
    job.other = patches.other.data();
    job.own = or_null(state.emission.own);
    job.direct = or_null(state.emission.direct);
    job.banks = received.data();
    job.bank_count = received.size();
    job.sent = state.sent.data();
    job.carried = state.carried.data();
    job.cell = next.cell;
    job.batch = next.batch;
    job.emission_before = state.emission.quanta;
    job.emission_after = next.emission;
    job.dither_before = state.dither;
    job.dither_after = state.dither + dither_merge;

    constexpr std::size_t patches_a_piece = 1024;
    std::vector<MergeTotals> sums(thread_count(threads));
    parallel_for(threads, patches.count(), patches_a_piece,
                 [&](std::size_t begin, std::size_t end, unsigned worker) {
                     HWY_DYNAMIC_DISPATCH(merge_patches)(job, begin, end, sums[worker]);
                 });

    state.dither = job.dither_after;
    state.emission.quanta = next.emission;
    for (std::uint32_t band = 0; band < state.bands; ++band) {
        for (WorkerTotals& worker : totals)
            state.lost[band] += std::exchange(worker.lost[band], 0);
        state.absorbed[band] = state.lost[band];
        for (const MergeTotals& sum : sums) {
            state.absorbed[band] += sum.absorbed[band];
            state.emitted[band] += sum.emitted[band];
        }
        for (WorkerTotals& worker : totals) {
            state.escaped[band] += std::exchange(worker.escaped[band], 0);
            state.sky[band] += std::exchange(worker.sky[band], 0);
        }
    }
}

}  // namespace parallux
#endif
