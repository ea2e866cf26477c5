#pragma once

#include <chrono>
#include <cstring>
#include <functional>
#include <utility>

#include "lines/ray_scene.h"
#include "parallux/solve.h"
#include "solve/plan.h"
#include "transfer/banks.h"

namespace parallux {

class Watch {
public:
    /// Since it began, or since the last lap.
    double lap() {
        double passed = seconds();
        start_ = std::chrono::steady_clock::now();
        return passed;
    }
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Asks the caller whether to go on, and minds the time limit. It is asked where the run's state is
/// whole, between batches, and has it kept.
class Listener {
public:
    Listener(const ProgressCallback& callback, double time_limit)
        : callback_(callback), time_limit_(time_limit) {}

    /// What follows is a part of the bundles, which has its own first shot: from … to of all.
    void begin_part(double from, double to) {
        from_ = from;
        to_ = to;
        lines_before_ = lines_;
    }

    /// To be called whenever the run is asked; `last`: it is told to stop. Not after that.
    void keep_by(std::function<void(bool last)> keep) { keep_ = std::move(keep); }

    /// `done`: share of the stage, `lines` or rays so far in it. Once false, always false.
    bool go_on(const char* stage, double done, std::uint64_t lines) {
        if (std::strcmp(stage, "first shot") != 0) {
            done = from_ + (to_ - from_) * done;
        } else if (from_ > 0) {
            stage = stage_;
            done = from_;
        }
        lines_ = lines = lines_before_ + lines;
        // A stage begins where the one before it was last heard of.
        if (stage != stage_) {
            stage_ = stage;
            stage_watch_ = last_;
        }
        last_ = Watch();
        const bool was_stopped = stopped_;
        if (callback_ && !callback_({stage, done, lines, stage_watch_.seconds(), nullptr}))
            stopped_ = true;
        if (to_stop_ || (time_limit_ > 0 && total_.seconds() > time_limit_))
            stopped_ = true;
        if (keep_ && !was_stopped)
            keep_(stopped_);
        return !stopped_;
    }

    /// A round is over, and what it tells of those to come is known. To be stopped here counts when
    /// it is asked next.
    void tell(Forecast forecast) {
        forecast.seconds_so_far = total_.seconds();
        if (callback_ && !callback_({stage_, to_, lines_, stage_watch_.seconds(), &forecast}))
            to_stop_ = true;
    }

    bool stopped() const { return stopped_; }

private:
    const ProgressCallback& callback_;
    double time_limit_;
    const char* stage_ = "bundles";  // a run may be taken up within a later group's first shot
    Watch total_, stage_watch_, last_;
    double from_ = 0, to_ = 1;
    std::uint64_t lines_ = 0, lines_before_ = 0;
    bool stopped_ = false, to_stop_ = false;
    std::function<void(bool last)> keep_;
};

class ExactShot;
class Walks;
struct Regions;

/// What all stages of one solve work on.
struct Run {
    const Scene& scene;
    const Patches& patches;
    const SolveSettings& settings;
    const Plan& plan;
    const RayScene* rays;  ///< null where the method needs none
    Banks& banks;
    Listener& listener;
    const ExactShot* exact = nullptr;  ///< null unless first shots are exact
    const Regions* regions = nullptr;  ///< of passes in batches
    const Walks* walks = nullptr;      ///< null where everything is diffuse
};

}  // namespace parallux
