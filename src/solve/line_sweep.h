#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "solve/run.h"
#include "solve/ways.h"
#include "transfer/partition.h"

namespace parallux {

/// Sends line bundles, or independent lines, through the scene and lets the patches that face each
/// other on them exchange what the state's exits carry, into the run's banks. Keeps references to
/// run and state; what exits carry may change between two calls.
class LineSweep {
public:
    /// `sky`: quanta that a line brings from the sky per W/m² of π L; 0: a dark sky.
    LineSweep(const Run& run, const TransferState& state, Direction direction, double sky);
    ~LineSweep();

    /// Projects bundles first … first + count - 1 of some lattice and follows their tiles.
    void bundles(const BundleSettings& lattice, std::uint64_t first, std::uint32_t count);
    /// Traces independent lines first … first + count - 1 and follows them.
    void lines(std::uint64_t first, std::uint64_t count);

    /// From now on lines are shown to those as well.
    void keep(Ways& ways) { ways_ = &ways; }
    void darken_sky() { sky_ = 0; }
    /// From now on what is exchanged is what is seen: the same but where something mirrors.
    void gather() { gathers_ = true; }

private:
    struct Buffers;

    void one_by_one(const BundleSettings& lattice, std::uint64_t first, std::uint32_t count);
    void whole_bundles(const BundleSettings& lattice, std::uint64_t first, std::uint32_t count);
    void side_by_side(const BundleSettings& lattice, std::uint64_t first, std::uint32_t count);
    template <class Follow>
    void each_tile(std::size_t tiles, Follow&& follow);
    void follow_tile(const Projection& projection, std::size_t tile, unsigned worker);
    void repeated(const BundleSettings& lattice, std::uint64_t first, std::uint32_t count);
    void exchange_tile(const glm::dvec3& direction, unsigned worker);

    const Run& run_;
    const TransferState& state_;
    Direction direction_;
    double sky_;
    bool gathers_ = false;
    Ways* ways_ = nullptr;
    std::vector<Buffers> buffers_;
    Projector projector_;
    std::optional<Partition> partition_;  // where the workers share a bank
    std::vector<Projection> projections_;
};

}  // namespace parallux
