#pragma once

#include "throughput/engine.h"

namespace parallux::throughput {

/// What the machine has to give: as many processes as threads solve the same at once, each on one
/// thread and a processor of its own. A run on many threads can at best do as much. Seconds are
/// such that the rates of all processes add up.
class ApartEngine : public Engine {
public:
    explicit ApartEngine(const Case& of) : case_(of) {}
    const char* name() const override { return "bundle-apart"; }
    Measured run(unsigned threads) override;

private:
    const Case& case_;
};

}  // namespace parallux::throughput
