#pragma once

#include <chrono>
#include <string>

#include "cli/options.h"

namespace parallux {

/// "1.83 %".
std::string percent(double share);

/// Tells on standard error how far a solve is: a bar on a terminal, a line every 10 % elsewhere, or
/// JSON lines; and after a round of a run to a stated error how long it will take, unless it is to
/// be quiet, also where it tells nothing else. Called by solve(); answers false once the user has
/// interrupted.
class ProgressReport {
public:
    ProgressReport(ProgressMode mode, bool quiet);
    ~ProgressReport();
    ProgressReport(const ProgressReport&) = delete;
    ProgressReport& operator=(const ProgressReport&) = delete;

    bool operator()(const Progress& progress);

    /// Leaves the bar's line, so that the next text begins its own.
    void end();

private:
    enum class Form { off, bar, lines, json };

    bool due(const Progress& progress);
    void draw_bar(const Progress& progress);
    void tell(const Forecast& forecast);

    bool quiet_;
    Form form_ = Form::off;
    std::string stage_;
    int told_ = -1;      // tenths of the stage that a line has told
    bool open_ = false;  // a bar stands on the terminal's line
    std::chrono::steady_clock::time_point last_{};
};

}  // namespace parallux
