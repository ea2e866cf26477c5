#pragma once

#include "materials/walk.h"
#include "solve/run.h"

namespace parallux {

/// Takes the quanta of walks into the run's banks and a worker's totals.
QuantaSink bank_sink(const Run& run, unsigned worker);

}  // namespace parallux
