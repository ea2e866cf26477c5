#include "parallux/transfer.h"

namespace parallux {

TransferState dark_state(const Patches& patches, double watts_per_quantum) {
    TransferState state;
    state.bands = patches.bands;
    state.watts_per_quantum = watts_per_quantum;
    state.sent.assign(patches.count() * patches.bands, 0);
    for (auto* totals : {&state.sky, &state.emitted, &state.lost, &state.absorbed, &state.escaped})
        totals->assign(patches.bands, 0);
    return state;
}

}  // namespace parallux
