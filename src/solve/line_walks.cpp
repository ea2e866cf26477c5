#include "solve/line_walks.h"

#include <bit>
#include <cmath>

#include <glm/geometric.hpp>

#include "lines/tile_bounds.h"
#include "solve/pass.h"
#include "solve/quanta_sink.h"

namespace parallux {

namespace {

void add(PatchList& list, std::uint32_t patch) {
    list.ids[list.count++] = patch;
}

}  // namespace

LineWalks::LineWalks(const Run& run, const TransferState& state, bool gathers, double sky,
                     unsigned worker)
    : run_(run),
      state_(state),
      gathers_(gathers),
      sky_(sky),
      worker_(worker),
      bands_(run.patches.bands),
      totals_(run.banks.totals(worker)),
      sink_(bank_sink(run, worker)),
      random_(0, 0) {
    watched_ = {[this](std::uint32_t patch, const Quanta& quanta) {
                    for (std::uint32_t band = 0; band < bands_; ++band)
                        until_ -= std::fabs(static_cast<double>(quanta[band]));
                    if (landed_ == none && until_ < 0)
                        landed_ = patch;
                    if (!pretends_)
                        sink_.land(patch, quanta);
                },
                [this](const Quanta& quanta) {
                    if (!pretends_)
                        sink_.escape(quanta);
                },
                [this](const Quanta& quanta) {
                    if (!pretends_)
                        sink_.lose(quanta);
                }};
}

Quanta LineWalks::quanta_of(std::uint32_t patch) const {
    Quanta quanta{};
    std::copy_n(carried(patch), bands_, quanta.begin());
    return quanta;
}

void LineWalks::follow(const Projection& projection, std::size_t tile,
                       const IntersectionLists& lists, const glm::dvec3& centre, TilePairs* kept) {
    const Bundle& bundle = projection.bundle;
    const TileBounds bounds = tile_bounds(projection, tile);
    const std::uint64_t key =
        mix64(run_.settings.seed ^ std::bit_cast<std::uint64_t>(bundle.direction.x)) ^
        std::bit_cast<std::uint64_t>(bundle.offset_x);
    along_ = bundle.direction;
    radius_ = projection.radius;
    kept_ = kept;
    outside_ = {};
    if (sky_ > 0)
        outside_ = sky_quanta(run_.scene, sky_, along_);
    if (kept_) {
        kept_->clear();
        kept_->reserve(2 * lists.hits.size());
    }
    totals_.counts.lines += lists.lines();
    totals_.counts.hits += lists.hits.size();
    for (std::size_t line = 0; line < lists.lines(); ++line) {
        const std::uint32_t begin = lists.start[line], count = lists.start[line + 1] - begin;
        if (count == 0)
            continue;
        ++totals_.counts.nonempty;
        totals_.counts.odd += count % 2;
        const auto columns = static_cast<std::size_t>(bounds.columns());
        const std::int32_t column = bounds.left + static_cast<std::int32_t>(line % columns);
        const std::int32_t row = bounds.top + static_cast<std::int32_t>(line / columns);
        random_ =
            Random(key, stream::walks + (std::uint64_t(static_cast<std::uint32_t>(row)) << 20 ^
                                         static_cast<std::uint32_t>(column)));
        follow_line(&lists.hits[begin], count,
                    centre + bundle.spacing * ((column - bundle.offset_x) * bundle.x +
                                               (row - bundle.offset_y) * bundle.y));
    }
}

void LineWalks::follow_line(const Hit* hits, std::size_t count, const glm::dvec3& base) {
    auto end = [&](const Hit& hit, std::uint32_t patch) {
        return End{patch, hit.surface, base + radius_ * double(hit.depth) * along_};
    };
    const Hit &first = hits[0], &last = hits[count - 1];
    enter_scene(first.toward, base - 2 * radius_ * along_, along_, outside_.along);
    enter_scene(last.away, base + 2 * radius_ * along_, -along_, outside_.against);
    leave_scene(end(first, first.toward), -along_, outside_.along);
    leave_scene(end(last, last.away), along_, outside_.against);
    for (std::size_t k = 0; k + 1 < count; ++k) {
        const End from = end(hits[k], hits[k].away), to = end(hits[k + 1], hits[k + 1].toward);
        if (from.patch != none && to.patch != none)
            ++totals_.counts.transfers;
        exchange(from, to, along_);
    }
}

void LineWalks::exchange(const End& from, const End& to, const glm::dvec3& direction) {
    for (const bool back : {false, true}) {
        const End &a = back ? to : from, &b = back ? from : to;
        if (a.patch == none)
            continue;
        run_.banks.leave(worker_, a.patch);
        if (gathers_)
            collect(a, b.patch, back ? -direction : direction);
        else
            send(a, b.patch, back ? -direction : direction);
    }
    if (!kept_ || from.patch == none || to.patch == none)
        return;
    // A pair that exchanges both ways by the line itself.
    if (share(from.patch) == 0 && share(to.patch) == 0) {
        add(kept_->from, from.patch);
        add(kept_->to, to.patch);
    }
}

void LineWalks::leave_scene(const End& from, const glm::dvec3&, const std::int64_t* sky) {
    if (from.patch == none)
        return;
    run_.banks.leave(worker_, from.patch);
    if (!gathers_) {
        sink_.escape(quanta_of(from.patch));
        if (kept_)
            add(kept_->last, from.patch);
        return;
    }
    for (std::uint32_t band = 0; band < bands_; ++band)
        run_.banks.receive(worker_, from.patch * std::size_t(bands_) + band,
                           std::llrint((1 - share(from.patch)) * static_cast<double>(sky[band])));
}

void LineWalks::enter_scene(std::uint32_t patch, const glm::dvec3& base,
                            const glm::dvec3& direction, const std::int64_t* sky) {
    if (gathers_ || sky_ <= 0 || patch == none)
        return;
    Quanta quanta{};
    for (std::uint32_t band = 0; band < bands_; ++band)
        totals_.sky[band] += quanta[band] = sky[band];
    if (share(patch) == 0)
        sink_.land(patch, quanta);
    else
        carry(Walk(*run_.walks, base, direction), quanta, bands_, random_, sink_);
}

// Depths are of corners moved onto the lattice of lines: a walk begins on the surface itself, so
// that what shares its place is met or left out as it is by lines.
Walk LineWalks::leave(const End& from, const glm::dvec3& direction) const {
    const Surface& surface = run_.scene.surfaces[from.surface];
    const glm::dvec3 normal = surface_normal(run_.scene, surface);
    const double above = glm::dot(from.point - run_.scene.positions[surface.corner[0]], normal);
    return {*run_.walks, from.point - above * normal, direction, from.surface};
}

void LineWalks::send(const End& from, std::uint32_t to, const glm::dvec3& direction) {
    const Quanta quanta = quanta_of(from.patch);
    if (to == none) {
        sink_.escape(quanta);
        ++totals_.counts.met_backs;
        if (kept_)
            add(kept_->into_backs, from.patch);
    } else if (share(to) == 0) {
        sink_.land(to, quanta);
        // The other way it is a walk.
        if (kept_ && share(from.patch) > 0 && random_.uniform() < 0.5) {
            add(kept_->from, from.patch);
            add(kept_->to, to);
        }
    } else {
        const Walk walk = leave(from, direction);
        // What mirrors or is glass all over has no power of others to send.
        if (!kept_ || share(from.patch) == 1)
            return carry(walk, quanta, bands_, random_, sink_);
        // See where a walk goes of what has nothing to send as well.
        double sum = 0;
        for (std::int64_t value : quanta)
            sum += std::fabs(static_cast<double>(value));
        pretends_ = sum == 0;
        Quanta shown = quanta;
        if (pretends_)
            std::fill_n(shown.begin(), bands_, std::int64_t(1) << 20);
        landed_ = none;
        until_ = random_.uniform() * (pretends_ ? double(bands_) * 0x1p20 : sum);
        carry(walk, shown, bands_, random_, watched_);
        keep_walk(from.patch);
    }
}

// Walks from both ends are kept: each is half a pair.
void LineWalks::keep_walk(std::uint32_t from) {
    if (landed_ == none) {
        add(kept_->into_backs, from);
    } else if (random_.uniform() < 0.5) {
        add(kept_->from, from);
        add(kept_->to, landed_);
    }
}

void LineWalks::collect(const End& from, std::uint32_t to, const glm::dvec3& direction) {
    const double diffuse = 1 - share(from.patch);
    if (diffuse <= 0 || to == none)
        return;
    std::array<double, max_bands> seen{};
    auto see = [&](std::uint32_t patch, const Weights& weights) {
        for (std::uint32_t band = 0; band < bands_; ++band)
            seen[band] += weights[band] * carried(patch)[band];
    };
    Weights weights;
    weights.fill(diffuse);
    if (share(to) == 0) {
        see(to, weights);
    } else {
        follow_sight(
            leave(from, direction), weights, bands_, random_,
            [&](const Walk& walk, const Weights& at) { see(walk.patch(), at); },
            [&](const glm::dvec3& out, const Weights& at) {
                if (sky_ <= 0)
                    return;
                const SkyQuanta sky = sky_quanta(run_.scene, sky_, out);
                for (std::uint32_t band = 0; band < bands_; ++band)
                    seen[band] += at[band] * static_cast<double>(sky.against[band]);
            });
    }
    for (std::uint32_t band = 0; band < bands_; ++band)
        run_.banks.receive(worker_, from.patch * std::size_t(bands_) + band,
                           std::llrint(seen[band]));
}

}  // namespace parallux
