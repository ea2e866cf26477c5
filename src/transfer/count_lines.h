#pragma once

#include "parallux/transfer.h"

namespace parallux {

/// What the lines of a tile come to beside what patches receive: their counts, what escapes, and
/// what the sky sends in.
void count_lines(const TilePairs& pairs, const TransferState& state, bool both_ways,
                 const SkyQuanta* sky, WorkerTotals& totals);

}  // namespace parallux
