#include <doctest/doctest.h>

#include <cmath>
#include <tuple>
#include <vector>

#include "parallux/transfer.h"
#include "random.h"
#include "support/hand_made.h"
#include "transfer/banks.h"
#include "transfer/partition.h"

using namespace parallux;
using namespace parallux::test;

namespace {

// Six patches of a room; the list meets 0 (its front), 1 from behind, 2, an inert back, 3.
IntersectionLists a_line() {
    IntersectionLists lists;
    lists.hits = {{0.1f, 0, none, 0}, {0.2f, 1, 1, none}, {0.3f, 2, none, 2}, {0.4f, 3, none, 3}};
    lists.start = {0, 4};
    return lists;
}

}  // namespace

TEST_CASE("a list is followed in pairs that face each other") {
    // 0 and 1 face each other; 2 sends into an inert back; 3 leaves the scene. Fails when a back is
    // looked through (planted: `to == none` goes on to the next hit) or a pair is missed.
    Scene scene = room(grey(0.5), 1);
    Patches patches = make_patches(scene);
    for (Direction direction : {Direction::bidirectional, Direction::oriented}) {
        TransferState state = dark_state(patches, 1);
        // Behind what is carried stand numbers that must play no part.
        state.carried = {10, 5, 200, 6, 3000, 7, 40000, 8, 0, 9, 0, 9};
        Banks banks(6, 1, 1, 1 << 20);
        SkyQuanta sky;
        sky.along[0] = 7;
        sky.against[0] = 9;
        exchange(a_line(), state, direction, {&sky, 1}, banks.of(0), false, banks.totals(0));
        bool both = direction == Direction::bidirectional;
        CHECK(banks.of(0).received[2] == 10);
        CHECK(banks.of(0).received[0] == (both ? 200 : 0));
        CHECK(banks.of(0).received[4] == 0);
        CHECK(banks.of(0).received[6] == (both ? 9 : 0));
        CHECK(banks.of(0).received[1] == 1);
        CHECK(banks.of(0).received[3] == (both ? 1 : 0));
        CHECK(banks.of(0).received[5] == 1);
        CHECK(banks.of(0).received[7] == 1);
        CHECK(banks.totals(0).escaped[0] == 43000);
        CHECK(banks.totals(0).counts.met_backs == 1);
        CHECK(banks.totals(0).counts.transfers == 1);
        CHECK(banks.totals(0).counts.odd == 0);
    }
}

TEST_CASE("energy is neither made nor lost, to the last quantum, on any number of banks") {
    // Random lists, shares and reflectances. Fails when what was sent is not what was taken off
    // (planted: the exits of all batches taken for those of the last).
    Scene scene = room(grey(0.37), 4);
    scene.bands = 3;
    Patches patches = make_patches(scene);
    TransferState state = dark_state(patches, 1);
    Random random(5, 5);
    std::vector<float> emission;
    for (std::size_t k = 0; k < patches.reflectance.size(); ++k)
        emission.push_back(float(random.uniform() * 1e9));
    state.emission.own = emission;
    TransferState other = state;
    Banks banks(patches.count(), 3, 3, 1 << 30), one(patches.count(), 3, 3, 1);
    REQUIRE(banks.banks().size() == 3);
    REQUIRE(one.banks().size() == 1);
    REQUIRE(one.shared());
    // What is unshot from the start came from outside.
    std::int64_t put_in = 0;
    for (std::size_t k = 0; k < patches.reflectance.size(); ++k) {
        std::int64_t quanta = std::int64_t(random.uniform() * 1e15);
        put_in += quanta;
        banks.receive(1, k, quanta);
        one.receive(0, k, quanta);
    }
    merge(state, patches, banks.banks(), banks.all_totals(), {0.01, 4, 1}, 1);
    merge(other, patches, one.banks(), one.all_totals(), {0.01, 4, 1}, 2);
    for (int batch = 0; batch < 5; ++batch) {
        for (unsigned worker = 0; worker < 3; ++worker) {
            IntersectionLists lists;
            for (int line = 0; line < 300; ++line) {
                for (std::uint32_t k = 0; k < 4; ++k) {
                    auto patch = std::uint32_t(random.uniform() * double(patches.count()));
                    lists.hits.push_back({float(k), 0, k % 2 ? patch : none, k % 2 ? none : patch});
                }
                lists.start.push_back(std::uint32_t(lists.hits.size()));
            }
            for (auto* target : {&banks, &one})
                exchange(lists, target == &banks ? state : other, Direction::bidirectional, {},
                         target->of(worker), target->shared(), target->totals(worker));
        }
        Share next{0.01, 4u + batch, batch < 3 ? 1.0 : 0.0};
        merge(state, patches, banks.banks(), banks.all_totals(), next, 2);
        merge(other, patches, one.banks(), one.all_totals(), next, 1);
    }
    std::int64_t left = 0, gone = 0, emitted = 0;
    for (std::size_t k = 0; k < state.sent.size(); ++k)
        left += std::llrint(double(patches.reflectance[k]) *
                            double(banks.received(k / 3, std::uint32_t(k % 3)))) -
                state.sent[k];
    for (std::uint32_t band = 0; band < 3; ++band) {
        gone += state.absorbed[band] + state.escaped[band];
        emitted += state.emitted[band];
    }
    CHECK(put_in + emitted == left + gone);
    CHECK(emitted > 0);
    CHECK(state.sent == other.sent);
    CHECK(state.carried == other.carried);
    for (std::size_t patch = 0; patch < patches.count(); ++patch)
        for (std::uint32_t lane = 0; lane < 4; ++lane)
            CHECK(banks.received(patch, lane) == one.received(patch, lane));
}

namespace {

// Lists of up to four hits between `spread` patches and inert backs.
IntersectionLists random_lists(const Patches& patches, int lines, Random& random, double spread) {
    IntersectionLists lists;
    const double first = random.uniform() * (double(patches.count()) - spread);
    for (int line = 0; line < lines; ++line) {
        for (int k = 0; k < line % 5; ++k) {
            auto side = [&] {
                auto patch = std::uint32_t(first + random.uniform() * 1.3 * spread);
                return patch < first + spread ? patch : none;
            };
            std::uint32_t toward = side(), away = side();
            lists.hits.push_back({float(k), 0, toward, away});
        }
        lists.start.push_back(std::uint32_t(lists.hits.size()));
    }
    return lists;
}

// A state in which every exit carries something at random.
TransferState carrying_state(const Patches& patches, Random& random) {
    TransferState state = dark_state(patches, 1);
    state.carried.resize(patches.count() * lanes(patches.bands));
    for (std::int32_t& carried : state.carried)
        carried = std::int32_t((random.uniform() - 0.1) * most_carried);
    return state;
}

SkyQuanta some_sky() {
    SkyQuanta sky;
    for (std::uint32_t band = 0; band < max_bands; ++band) {
        sky.along[band] = 1000 + band;
        sky.against[band] = 2000 + band;
    }
    return sky;
}

void check_same(Banks& a, Banks& b) {
    for (std::size_t patch = 0; patch < a.patches(); ++patch)
        for (std::uint32_t lane = 0; lane <= a.bands(); ++lane)
            REQUIRE(a.received(patch, lane) == b.received(patch, lane));
}

void check_same(const WorkerTotals& a, const WorkerTotals& b) {
    CHECK(a.escaped == b.escaped);
    CHECK(a.sky == b.sky);
    CHECK(a.counts.lines == b.counts.lines);
    CHECK(a.counts.hits == b.counts.hits);
    CHECK(a.counts.odd == b.counts.odd);
    CHECK(a.counts.transfers == b.counts.transfers);
    CHECK(a.counts.nonempty == b.counts.nonempty);
}

}  // namespace

TEST_CASE("pairs bring what lists bring, in both directions, with any bands") {
    // Fails when an exit is counted at the wrong end (planted: oriented exits added to the
    // receiver), when a band is left out of the lanes, or when the sky of an end is forgotten.
    for (std::uint32_t bands : {1u, 2u, 3u, 4u, 7u, 8u})
        for (Direction direction : {Direction::bidirectional, Direction::oriented})
            for (unsigned workers : {1u, 2u}) {
                Scene scene = room(grey(0.37), 4);
                scene.bands = bands;
                Patches patches = make_patches(scene);
                Random random(bands, 9);
                TransferState state = carrying_state(patches, random);
                IntersectionLists lists =
                    random_lists(patches, 500, random, double(patches.count()));
                SkyQuanta sky = some_sky();
                // One bank for two workers: the lists' additions are atomic then.
                Banks by_lists(patches.count(), bands, workers, 1);
                Banks by_pairs(patches.count(), bands, 1, 1);
                exchange(lists, state, direction, {&sky, 1}, by_lists.of(0), by_lists.shared(),
                         by_lists.totals(0));
                TilePairs pairs;
                append_pairs(lists, pairs);
                exchange_pairs(pairs, state, direction, &sky, by_pairs.of(0), by_pairs.totals(0));
                check_same(by_lists, by_pairs);
                check_same(by_lists.totals(0), by_pairs.totals(0));
                if (direction == Direction::bidirectional)
                    CHECK(by_lists.totals(0).counts.met_backs ==
                          by_pairs.totals(0).counts.met_backs);
            }
}

TEST_CASE("a partition brings what banks bring, in both directions, with any bands and workers") {
    // 98 304 patches lie in four ranges, the tiles of 3000 lines fill several chunks. Fails when
    // the last chunk of a bucket is read to its end, when a run of halves goes to the bucket of its
    // first although they differ, when a marked half is counted as an exit, or when the sky of the
    // round's first tile is taken for all (each planted).
    for (std::uint32_t bands : {1u, 3u, 8u})
        for (Direction direction : {Direction::bidirectional, Direction::oriented})
            for (bool lit : {false, true}) {
                Scene scene = room(grey(0.37), 128);
                scene.bands = bands;
                Patches patches = make_patches(scene);
                Random random(bands, 10);
                TransferState state = carrying_state(patches, random);
                Banks own(patches.count(), bands, 1, 1), one(patches.count(), bands, 3, 1);
                REQUIRE(one.shared());
                Partition partition(patches.count(), bands, 3);
                for (unsigned tile = 0; tile < 9; ++tile) {
                    SkyQuanta sky = some_sky();
                    sky.along[0] += tile;
                    TilePairs pairs;
                    // Neighbours in one range, or patches from all of them.
                    const double spread = tile % 2 ? 500 : double(patches.count());
                    append_pairs(random_lists(patches, 3000, random, spread), pairs);
                    exchange_pairs(pairs, state, direction, lit ? &sky : nullptr, own.of(0),
                                   own.totals(0));
                    // All of the first round by one worker; the workers take turns in the second.
                    unsigned worker = tile < 4 ? 1 : tile % 3;
                    partition.put(worker, pairs, state, direction, lit ? &sky : nullptr,
                                  one.totals(0));
                    if (tile == 3 || tile == 8)
                        partition.apply(state, one.of(0), 2);
                }
                check_same(own, one);
                check_same(own.totals(0), one.totals(0));
                CHECK(own.totals(0).counts.met_backs == one.totals(0).counts.met_backs);
            }
}

TEST_CASE("the linear share is the cell over the area, and never more than all") {
    // Of 1 000 000 quanta unshot. The dither adds less than one quantum. Fails when the share is
    // not divided among the batch (planted).
    Scene scene = room(grey(0.5), 2);
    Patches patches = make_patches(scene);
    std::vector<float> emission(patches.count(), 5);
    for (auto [cell, batch, carried] :
         {std::tuple{0.025, 1u, 100'005}, {0.025, 10u, 10'005}, {25.0, 1u, 1'000'005}}) {
        TransferState state = dark_state(patches, 1);
        state.emission.own = emission;
        Banks banks(patches.count(), 1, 1, 1);
        for (std::size_t k = 0; k < patches.count(); ++k)
            banks.receive(0, k, 2'000'000);
        merge(state, patches, banks.banks(), banks.all_totals(), {cell, batch, 1}, 1);
        CHECK(state.carried[0] >= carried);
        CHECK(state.carried[0] <= carried + 1);
    }
}

TEST_CASE("banks never take more than they may") {
    CHECK(Banks::count(1000, 3, 64, 32'000 * 64) == 64);
    CHECK(Banks::count(1000, 3, 64, 32'000 * 64 - 1) == 1);
    CHECK(Banks::count(1000, 3, 64, 1) == 1);
    CHECK(Banks::count(1000, 3, 4, std::uint64_t(1) << 40) == 4);
}
