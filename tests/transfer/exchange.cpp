#include <doctest/doctest.h>

#include <cmath>

#include "parallux/transfer.h"
#include "random.h"
#include "support/hand_made.h"
#include "transfer/delta_banks.h"

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
        state.quanta = {10, 1, 200, 1, 3000, 1, 40000, 1, 0, 1, 0, 1};
        DeltaBanks banks(6, 1, 1, 1 << 20);
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
    // (planted: share rounded a second time in merge).
    Scene scene = room(grey(0.37), 4);
    scene.bands = 3;
    Patches patches = make_patches(scene);
    TransferState state = dark_state(patches, 1);
    Random random(5, 5);
    std::int64_t put_in = 0;
    for (std::int64_t& unshot : state.unshot)
        put_in += unshot = std::int64_t(random.uniform() * 1e15);
    for (std::int64_t& emission : state.emission)
        emission = std::int64_t(random.uniform() * 1e12);
    DeltaBanks banks(patches.count(), 3, 3, 1 << 30), one(patches.count(), 3, 3, 1);
    REQUIRE(banks.banks().size() == 3);
    REQUIRE(one.banks().size() == 1);
    REQUIRE(one.shared());
    TransferState other = state;
    for (int batch = 0; batch < 5; ++batch) {
        share_unshot(state, patches, 0.01, 4, 1);
        share_unshot(other, patches, 0.01, 4, 2);
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
        merge(state, patches, banks.banks(), banks.all_totals(), 2);
        merge(other, patches, one.banks(), one.all_totals(), 1);
    }
    std::int64_t left = 0, gone = 0, emitted = 0;
    for (std::int64_t unshot : state.unshot)
        left += unshot;
    for (std::uint32_t band = 0; band < 3; ++band) {
        gone += state.absorbed[band] + state.escaped[band];
        emitted += state.emitted[band];
    }
    CHECK(put_in + emitted == left + gone);
    CHECK(emitted > 0);
    CHECK(state.unshot == other.unshot);
    CHECK(state.received == other.received);
    CHECK(state.exits == other.exits);
}

TEST_CASE("pairs bring what lists bring, in both directions, with any bands and banks") {
    // Fails when an exit is counted at the wrong end (planted: oriented exits added to the
    // receiver), when a band is left out of the lanes, or when the sky of an end is forgotten.
    for (std::uint32_t bands : {1u, 2u, 3u, 4u, 7u, 8u})
        for (Direction direction : {Direction::bidirectional, Direction::oriented})
            for (std::uint64_t allowed : {1ull, 1ull << 30}) {
                Scene scene = room(grey(0.37), 4);
                scene.bands = bands;
                Patches patches = make_patches(scene);
                TransferState state = dark_state(patches, 1);
                Random random(bands, 9);
                for (std::int64_t& unshot : state.unshot)
                    unshot = std::int64_t(random.uniform() * 1e15);
                share_unshot(state, patches, 0.01, 1, 1);
                IntersectionLists lists;
                for (int line = 0; line < 500; ++line) {
                    for (int k = 0; k < line % 5; ++k) {
                        auto side = [&] {
                            auto patch = std::uint32_t(random.uniform() * 1.3 * patches.count());
                            return patch < patches.count() ? patch : none;
                        };
                        std::uint32_t toward = side(), away = side();
                        lists.hits.push_back({float(k), 0, toward, away});
                    }
                    lists.start.push_back(std::uint32_t(lists.hits.size()));
                }
                SkyQuanta sky;
                for (std::uint32_t band = 0; band < bands; ++band) {
                    sky.along[band] = 1000 + band;
                    sky.against[band] = 2000 + band;
                }
                DeltaBanks by_lists(patches.count(), bands, 2, allowed);
                DeltaBanks by_pairs(patches.count(), bands, 2, allowed);
                exchange(lists, state, direction, {&sky, 1}, by_lists.of(1), by_lists.shared(),
                         by_lists.totals(1));
                TilePairs pairs;
                append_pairs(lists, pairs);
                exchange_pairs(pairs, state, direction, &sky, by_pairs.of(1), by_pairs.shared(),
                               by_pairs.totals(1));
                CHECK(by_lists.of(1).received == by_pairs.of(1).received);
                CHECK(by_lists.totals(1).escaped == by_pairs.totals(1).escaped);
                CHECK(by_lists.totals(1).sky == by_pairs.totals(1).sky);
                const LineCounts &a = by_lists.totals(1).counts, &b = by_pairs.totals(1).counts;
                CHECK(a.lines == b.lines);
                CHECK(a.hits == b.hits);
                CHECK(a.odd == b.odd);
                CHECK(a.transfers == b.transfers);
                CHECK(a.nonempty == b.nonempty);
                if (direction == Direction::bidirectional)
                    CHECK(a.met_backs == b.met_backs);
            }
}

TEST_CASE("the linear share is the cell over the area, and never more than all") {
    Scene scene = room(grey(0.5), 2);
    Patches patches = make_patches(scene);
    TransferState state = dark_state(patches, 1);
    state.unshot.assign(patches.count(), 1'000'000);
    state.emission.assign(patches.count(), 5);
    share_unshot(state, patches, 0.025, 1, 1);
    CHECK(state.quanta[0] == 100'005);
    share_unshot(state, patches, 0.025, 10, 1);
    CHECK(state.quanta[0] == 10'005);
    share_unshot(state, patches, 25, 1, 1);
    CHECK(state.quanta[0] == 1'000'005);
}

TEST_CASE("banks never take more than they may") {
    CHECK(DeltaBanks::count(1000, 3, 64, 32'000 * 5) == 5);
    CHECK(DeltaBanks::count(1000, 3, 64, 1) == 1);
    CHECK(DeltaBanks::count(1000, 3, 4, std::uint64_t(1) << 40) == 4);
}
